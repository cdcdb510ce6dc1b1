"""The deformed sheet with its material lines, coloured by a field, as in Figs. 7 to 10."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .fields import FieldGrid, FieldSeries
from .material_lines import boundary_loops, material_lines

Array = NDArray[np.float64]

MM = 1e3  # m to mm
LONGEST_SIDE = 6.0  # inches, of the drawn sheet
LETTERS_PER_INCH = 11  # of a title
DPI = 200


@dataclass(frozen=True)
class Quantity:
    """How a field is named and coloured; `clipped` ends the colours at the 99th percentile."""

    label: str
    colours: str
    clipped: bool = False


QUANTITIES = {
    "shear_angle": Quantity("shear angle (rad)", "viridis"),
    "energy_density": Quantity("energy density (J/m²)", "magma", clipped=True),
}


@dataclass(frozen=True)
class ColourScale:
    """Colours of a field: the map, the values at its ends, and the ends that values exceed."""

    colours: Colormap
    lowest: float
    highest: float
    exceeded: str


def draw_deformed(
    series: FieldSeries,
    index: int,
    quantity: str,
    path: Path,
    line_spacing: float,
    fibre_angle: float,
    title: str = "",
) -> None:
    """Draw a state: the deformed sheet coloured by a field, with its material lines.

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
    line_spacing
        Reference distance between neighbouring material lines of a family, in m.
    fibre_angle
        Angle from x to the first family, in degrees; the second is at +90.
    title
        Written above, with the load.
    """
    grid, fields = series.grid, series.fields(index)
    displacement, values = fields["displacement"], fields[quantity]
    deformed = grid.points + displacement

    outlines = np.concatenate([grid.points, deformed])
    extent = np.ptp(outlines, axis=0)
    width, height = LONGEST_SIDE * extent / extent.max()
    figure = Figure(figsize=(max(width, 1.5) + 1.9, height + 1.2))
    figure.set_layout_engine("constrained", w_pad=0.1, h_pad=0.1)
    axes = figure.add_subplot(aspect="equal", xlabel="x (mm)", ylabel="y (mm)")
    axes.spines[["top", "right"]].set_visible(False)

    boundary = boundary_loops(grid.triangles)
    scale = colour_scale(values, node_areas(grid), QUANTITIES[quantity])
    surface = axes.tripcolor(
        *(MM * deformed.T),
        grid.triangles,
        values,
        shading="gouraud",
        cmap=scale.colours,
        norm=Normalize(scale.lowest, scale.highest),
    )
    _add_lines(
        axes, [grid.points[loop] for loop in boundary], color="0.7", linewidth=0.7, behind=True
    )
    for angle in np.radians([fibre_angle, fibre_angle + 90.0]):
        direction = np.array([np.cos(angle), np.sin(angle)])
        lines = material_lines(grid, displacement, direction, line_spacing)
        _add_lines(axes, lines, color="0.1", linewidth=0.4)
    _add_lines(axes, [deformed[loop] for loop in boundary], color="0.1", linewidth=0.9)
    axes.autoscale_view()

    bar = figure.colorbar(surface, ax=axes, extend=scale.exceeded, shrink=0.7, aspect=25)
    bar.set_label(QUANTITIES[quantity].label)
    load = f"load {100 * series.loads[index]:.4g} %"
    heading = wrap(title, int(LETTERS_PER_INCH * figure.get_figwidth()))
    figure.suptitle("\n".join([*heading, load]), fontsize="medium", parse_math=False)
    figure.savefig(path, dpi=DPI)


def colour_scale(values: Array, areas: Array, quantity: Quantity) -> ColourScale:
    """Choose colours: diverging about 0 where the sign changes, else light at 0 to dark.

    Parameters
    ----------
    values
        The field at the nodes, shape (n,).
    areas
        Reference area that each node stands for, shape (n,); percentiles are percentiles of area,
        for refined corners have more nodes than the rest.
    quantity
        What the field is.
    """
    lowest, highest = float(values.min()), float(values.max())
    size = max(-lowest, highest)
    if size < 1e-12:  # rad or J/m²: rounding
        return ColourScale(_shades(quantity.colours), 0.0, 1.0, "neither")
    # A few per cent of the other sign, at a corner or from rounding, are no change of sign.
    if min(-lowest, highest) > 0.05 * size:
        return ColourScale(colormaps["RdBu_r"], -size, size, "neither")
    if -lowest > highest:
        return ColourScale(
            _shades(quantity.colours).reversed(), lowest, max(highest, 0.0), "neither"
        )
    # An energy confined to less than the last per cent is shown to its peak.
    clip = (quantity.clipped and area_percentile(values, areas, 99.0)) or highest
    return ColourScale(
        _shades(quantity.colours), min(lowest, 0.0), clip, "max" if clip < highest else "neither"
    )


def area_percentile(values: Array, areas: Array, percent: float) -> float:
    """Return the value that is not exceeded on so many per cent of the area."""
    order = np.argsort(values)
    share = np.cumsum(areas[order]) / areas.sum()
    index = min(int(np.searchsorted(share, percent / 100.0)), len(values) - 1)
    return float(values[order[index]])


def node_areas(grid: FieldGrid) -> Array:
    """Return the reference area of each node: a third of the triangles around it, shape (n,)."""
    a, b, c = (grid.points[grid.triangles[:, i]] for i in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    areas = np.abs(ux * vy - uy * vx) / 6.0
    shares = np.zeros(len(grid.points))
    np.add.at(shares, grid.triangles, areas[:, None])
    return shares


def _shades(name: str) -> Colormap:
    # Without the darkest third, on which the material lines would not be seen.
    shades = colormaps[name](np.linspace(1.0, 0.3, 256))
    return LinearSegmentedColormap.from_list(f"{name}_shades", shades)


def _add_lines(
    axes: Axes, lines: list[Array], color: str, linewidth: float, behind: bool = False
) -> None:
    collection = LineCollection([MM * line for line in lines], colors=color, linewidths=linewidth)
    collection.set_capstyle("round")
    collection.set_zorder(0 if behind else 2)
    axes.add_collection(collection)
