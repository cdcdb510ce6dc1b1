"""The axis of a beam or chain: its nodes in order, its abscissa, and how its states are drawn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from .fields import FieldGrid, FieldSeries

Array = NDArray[np.float64]

#: Number of cells up to which the nodes of a chain are marked.
FEW = 60
LONGEST_LEGEND = 10


@dataclass(frozen=True, eq=False)
class Axis:
    """A straight reference axis along x.

    Attributes
    ----------
    nodes
        Numbers of the nodes from left to right, shape (n,).
    cells
        Numbers of the lines from left to right, shape (m,).
    nodal_abscissa, cell_abscissa
        S in m of the nodes, shape (n,), and of the middles of the lines, shape (m,), in order.
    """

    nodes: NDArray[np.intp]
    cells: NDArray[np.intp]
    nodal_abscissa: Array
    cell_abscissa: Array

    @classmethod
    def of(cls, grid: FieldGrid) -> Axis:
        """Return the axis of a grid of lines."""
        x = grid.points[:, 0] - grid.points[:, 0].min()
        middles = x[grid.cells].mean(axis=1)
        nodes, cells = np.argsort(x), np.argsort(middles)
        return cls(nodes, cells, x[nodes], middles[cells])

    @property
    def length(self) -> float:
        """Reference length in m."""
        return float(self.nodal_abscissa[-1])

    @property
    def marker(self) -> str:
        """Marker of nodes or links, none if they are many."""
        return "." if len(self.cells) <= FEW else ""


def state_colours(number: int) -> Array:
    """Return colours of so many states in the order of their loads, shape (number, 4)."""
    # Without the lightest, which would not be seen on the page.
    return colormaps["viridis_r"](np.linspace(0.15, 1.0, number) if number > 1 else [1.0])


def panels_beside_legend(figure: Figure, number: int) -> tuple[list[Axes], Axes]:
    """Return panels on top of one another over the same abscissa, and a place for their legend."""
    grid = figure.add_gridspec(number, 2, width_ratios=[6.0, 1.4])
    panels: list[Axes] = []
    for row in range(number):
        panels.append(figure.add_subplot(grid[row, 0], sharex=panels[0] if panels else None))
        panels[-1].tick_params(labelbottom=row == number - 1)
        panels[-1].spines[["top", "right"]].set_visible(False)
    beside = figure.add_subplot(grid[:, 1])
    beside.set_axis_off()
    return panels, beside


def add_legend(
    beside: Axes, series: FieldSeries, indices: Sequence[int], others: Sequence[Line2D] = ()
) -> None:
    """Name the states by their loads; of many states, only some."""
    handles = [
        Line2D([], [], color=colour, linewidth=1.5, label=f"load {100 * series.loads[index]:.4g} %")
        for index, colour in zip(indices, state_colours(len(indices)), strict=True)
    ]
    if len(handles) > LONGEST_LEGEND:
        shown = np.linspace(0, len(handles) - 1, LONGEST_LEGEND).round().astype(int)
        handles = [handles[i] for i in shown]
    beside.legend(
        handles=[*others, *handles],
        loc="upper left",
        borderaxespad=0.0,
        frameon=False,
        fontsize="small",
    )
