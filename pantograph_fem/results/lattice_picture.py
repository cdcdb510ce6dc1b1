"""A deformed lattice: its coloured links and, where there is room for them, its pivots."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from numpy.typing import NDArray

from .deformed_figure import MM, Colouring, add_lines
from .fields import FieldGrid

Array = NDArray[np.float64]

#: Width of a link over its length, and its limits in points.
SLENDERNESS, THINNEST, THICKEST = 0.28, 0.6, 2.4
#: Length in points from which links have dots at their ends.
ROOM_FOR_PIVOTS = 5.0


def paint_links(
    axes: Axes, grid: FieldGrid, displacement: Array, colouring: Colouring, scale: float
) -> ScalarMappable:
    """Draw the links of a lattice, each in the colour of the mean of the values at its ends.

    The bounding box of the reference is behind in grey. See `deformed_figure.Painter`.
    """
    deformed, links = grid.points + displacement, grid.cells
    vectors = grid.points[links[:, 1]] - grid.points[links[:, 0]]
    length = scale * float(np.median(np.linalg.norm(vectors, axis=1)))
    width = float(np.clip(SLENDERNESS * length, THINNEST, THICKEST))
    pivots = length >= ROOM_FOR_PIVOTS

    (left, bottom), (right, top) = grid.points.min(axis=0), grid.points.max(axis=0)
    corners = [(left, bottom), (right, bottom), (right, top), (left, top), (left, bottom)]
    add_lines(axes, [np.array(corners)], color="0.7", linewidth=0.7, behind=True)
    segments = MM * deformed[links]
    # Light colours, of which white is one, are seen against the page by their darker edges.
    edges = LineCollection(segments, colors="0.5", linewidths=width + min(0.5, 0.5 * width))
    coloured = LineCollection(segments, cmap=colouring.cmap, norm=colouring.norm, linewidths=width)
    coloured.set_array(colouring.values[links].mean(axis=1))
    for zorder, collection in ((1.0, edges), (1.1, coloured)):
        collection.set_capstyle("round")
        collection.set_zorder(zorder)
        axes.add_collection(collection)
    if pivots:
        axes.plot(*(MM * deformed.T), "o", color="0.1", markersize=0.7 * width, markeredgewidth=0)
    return coloured
