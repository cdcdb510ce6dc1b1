"""Curves on a deformed sheet: its boundary and lines that were straight along the fibres."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from .fields import FieldGrid

Array = NDArray[np.float64]


def boundary_loops(triangles: NDArray[np.integer]) -> list[NDArray[np.integer]]:
    """Return the boundary as closed chains of nodes, the first node repeated at the end.

    A sheet with holes has a chain for each of them.
    """
    edges = np.sort(np.concatenate([triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])]))
    unique, counts = np.unique(edges, axis=0, return_counts=True)
    neighbours: dict[int, list[int]] = {}
    for a, b in unique[counts == 1].tolist():
        neighbours.setdefault(a, []).append(b)
        neighbours.setdefault(b, []).append(a)
    loops = []
    for start, ahead in neighbours.items():
        while ahead:
            loop = [start]
            while neighbours[loop[-1]]:
                following = neighbours[loop[-1]].pop()
                neighbours[following].remove(loop[-1])
                loop.append(following)
            loops.append(np.array(loop))
    return loops


def material_lines(
    grid: FieldGrid, displacement: Array, direction: Array, spacing: float
) -> list[Array]:
    """Return the deformed curves of reference lines along a direction.

    The lines are `spacing` apart, one of them through the centre of the sheet's bounding box.
    Displacements being linear on each triangle, a curve is a polyline with a vertex at every edge
    it crosses, its ends exactly on the boundary. A line that a hole or a notch interrupts gives
    several curves.

    Parameters
    ----------
    grid
        Reference configuration.
    displacement
        Nodal displacements in m, shape (n, 2).
    direction
        Direction of the lines in the reference configuration, shape (2,).
    spacing
        Distance between neighbouring lines in m.

    Returns
    -------
    list of arrays
        Deformed points of each curve in m, shape (k, 2).
    """
    along = np.asarray(direction, float) / np.linalg.norm(direction)
    across = np.array([-along[1], along[0]])
    points = grid.points
    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    height = (points - centre) @ across
    deformed = points + displacement
    first, last = np.ceil(height.min() / spacing), np.floor(height.max() / spacing)
    return [
        curve
        for offset in spacing * np.arange(first, last + 1)
        for curve in _cut(grid.cells, height - offset, points @ along, deformed)
    ]


def _cut(
    triangles: NDArray[np.integer], height: Array, position: Array, deformed: Array
) -> Iterator[Array]:
    """Yield the deformed curves of the line of zero height, ordered by position along it."""
    above = height >= 0  # a node on the line counts as above, so a triangle is cut twice or never
    cut = triangles[above[triangles].any(axis=1) & ~above[triangles].all(axis=1)]
    # The line crosses the two edges that meet in the node which is alone on its side.
    alone = np.argmax(above[cut] == (above[cut].sum(axis=1) == 1)[:, None], axis=1)
    a, b, c = (cut[np.arange(len(cut)), (alone + i) % 3] for i in range(3))
    nodes = np.column_stack([position, deformed])
    ends = []
    for other in (b, c):
        weight = (height[a] / (height[a] - height[other]))[:, None]
        ends.append((1 - weight) * nodes[a] + weight * nodes[other])
    start, end = np.where((ends[0][:, 0] < ends[1][:, 0])[:, None], ends, ends[::-1])

    tolerance = 1e-9 * np.ptp(position)
    order = np.argsort(start[:, 0])
    order = order[(end - start)[order, 0] > tolerance]
    start, end = start[order], end[order]
    gaps = np.flatnonzero(start[1:, 0] - end[:-1, 0] > tolerance) + 1
    for pieces in np.split(np.arange(len(order)), gaps):
        if len(pieces):
            yield np.concatenate([start[pieces[:1], 1:], end[pieces, 1:]])
