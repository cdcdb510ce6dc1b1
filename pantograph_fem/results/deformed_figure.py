"""A deformed sheet or lattice coloured by a field, as in Figs. 7 to 10: frame, scale and title.

What is drawn inside the frame is a painter's: `sheet_picture` or `lattice_picture`.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap
from typing import Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Colormap, Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .colours import QUANTITIES, colour_scale, node_weights
from .fields import FieldGrid, FieldSeries

Array = NDArray[np.float64]

MM = 1e3  # m to mm
LONGEST_SIDE = 6.0  # inches, of what is drawn
LETTERS_PER_INCH = 11  # of a title
DPI = 200


@dataclass(frozen=True, eq=False)
class Colouring:
    """A field and its colours.

    Attributes
    ----------
    values
        The field at the nodes, shape (n,).
    cmap, norm
        What makes a colour of a value.
    """

    values: Array
    cmap: Colormap
    norm: Normalize


class Painter(Protocol):
    """What draws a deformed structure."""

    def __call__(
        self, axes: Axes, grid: FieldGrid, displacement: Array, colouring: Colouring, scale: float
    ) -> ScalarMappable:
        """Draw a structure in mm and return what the colour bar explains.

        Parameters
        ----------
        axes
            Where to draw.
        grid
            Reference configuration.
        displacement
            Nodal displacements in m, shape (n, 2).
        colouring
            Field to colour by.
        scale
            Printer's points on the page for a metre of the structure.
        """


def draw_deformed(
    series: FieldSeries, index: int, quantity: str, path: Path, painter: Painter, title: str = ""
) -> None:
    """Draw a state: the deformed structure coloured by a field.

    Parameters
    ----------
    series
        States of a run.
    index
        Which of them.
    quantity
        Name of the field, one of `QUANTITIES`.
    path
        The PNG file to write.
    painter
        What draws the structure.
    title
        Written above, with the load.
    """
    grid, fields = series.grid, series.fields(index)
    displacement, values = fields["displacement"], fields[quantity]

    extent = np.ptp(np.concatenate([grid.points, grid.points + displacement]), axis=0)
    width, height = LONGEST_SIDE * extent / extent.max()
    figure = Figure(figsize=(max(width, 1.5) + 1.9, height + 1.2))
    figure.set_layout_engine("constrained", w_pad=0.1, h_pad=0.1)
    axes = figure.add_subplot(aspect="equal", xlabel="x (mm)", ylabel="y (mm)")
    axes.spines[["top", "right"]].set_visible(False)

    scale = colour_scale(values, node_weights(grid), QUANTITIES[quantity])
    colouring = Colouring(values, scale.colours, Normalize(scale.lowest, scale.highest))
    coloured = painter(axes, grid, displacement, colouring, 72 * LONGEST_SIDE / extent.max())
    axes.autoscale_view()

    bar = figure.colorbar(coloured, ax=axes, extend=scale.exceeded, shrink=0.7, aspect=25)
    bar.set_label(QUANTITIES[quantity].label)
    load = f"load {100 * series.loads[index]:.4g} %"
    heading = wrap(title, int(LETTERS_PER_INCH * figure.get_figwidth()))
    figure.suptitle("\n".join([*heading, load]), fontsize="medium", parse_math=False)
    figure.savefig(path, dpi=DPI)


def add_lines(
    axes: Axes, lines: list[Array], color: str, linewidth: float, behind: bool = False
) -> None:
    """Draw curves, each of shape (k, 2) in m, over or behind everything else."""
    collection = LineCollection([MM * line for line in lines], colors=color, linewidths=linewidth)
    collection.set_capstyle("round")
    collection.set_zorder(0 if behind else 2)
    axes.add_collection(collection)
