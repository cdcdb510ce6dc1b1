"""A deformed sheet: its coloured surface, its material lines and its boundary."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from numpy.typing import NDArray

from .deformed_figure import MM, Colouring, Painter, add_lines
from .fields import FieldGrid
from .material_lines import boundary_loops, material_lines

Array = NDArray[np.float64]


def sheet_painter(line_spacing: float, fibre_angle: float) -> Painter:
    """Return what draws a sheet with its material lines.

    Parameters
    ----------
    line_spacing
        Reference distance between neighbouring material lines of a family, in m.
    fibre_angle
        Angle from x to the first family, in degrees; the second is at +90.
    """

    def paint(
        axes: Axes, grid: FieldGrid, displacement: Array, colouring: Colouring, scale: float
    ) -> ScalarMappable:
        deformed = grid.points + displacement
        boundary = boundary_loops(grid.cells)
        surface = axes.tripcolor(
            *(MM * deformed.T),
            grid.cells,
            colouring.values,
            shading="gouraud",
            cmap=colouring.cmap,
            norm=colouring.norm,
        )
        reference = [grid.points[loop] for loop in boundary]
        add_lines(axes, reference, color="0.7", linewidth=0.7, behind=True)
        for angle in np.radians([fibre_angle, fibre_angle + 90.0]):
            direction = np.array([np.cos(angle), np.sin(angle)])
            lines = material_lines(grid, displacement, direction, line_spacing)
            add_lines(axes, lines, color="0.1", linewidth=0.4)
        add_lines(axes, [deformed[loop] for loop in boundary], color="0.1", linewidth=0.9)
        return surface

    return paint
