"""Strains of a beam or chain along its reference abscissa, panels on top of one another."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .axis import Axis, add_legend, panels_beside_legend, state_colours
from .fields import FieldSeries
from .units import power_of_ten, prefixed

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Profile:
    """How a field is drawn over S.

    Attributes
    ----------
    label
        What is drawn.
    unit
        Its unit; of a pure number, ``""``.
    rounding
        Largest value that is taken for 0.
    values
        What is drawn of the field's values, in order of S.
    prefix
        Whether the unit is that of SI and takes a prefix.
    """

    label: str
    unit: str
    rounding: float
    values: Callable[[Array], Array] = np.asarray
    prefix: bool = False


#: Panels by field, from the top; those whose field there is are drawn.
PROFILES = {
    "stretch": Profile("stretch − 1", "", 1e-9, lambda stretch: stretch - 1.0),
    "curvature": Profile("curvature", "1/m", 1e-9),
    # An angle found by atan2 jumps where the beam has turned by half a circle.
    "angle": Profile("angle", "degrees", 1e-8, lambda angle: np.degrees(np.unwrap(angle))),
    "energy_density": Profile("energy density", "J/m", 1e-12, prefix=True),
}


def draw_profiles(series: FieldSeries, indices: Sequence[int], path: Path, title: str = "") -> None:
    """Draw the fields of some states against the reference abscissa S.

    Parameters
    ----------
    series
        States of a run on a grid of lines, with fields of `PROFILES` on its nodes or its lines.
    indices
        Which of them, in the order of their loads.
    path
        The PNG file to write.
    title
        Written above.
    """
    axis = Axis.of(series.grid)
    scale, unit = prefixed(axis.length, "m")
    states = [(series.fields(index), series.cell_fields(index)) for index in indices]
    names = [name for name in PROFILES if any(name in fields for fields in states[0])]
    figure = Figure(figsize=(6.9, 0.9 + 1.7 * len(names)))
    figure.set_layout_engine("constrained", w_pad=0.1, h_pad=0.05)
    panels, beside = panels_beside_legend(figure, len(names))
    for axes, name in zip(panels, names, strict=True):
        profile = PROFILES[name]
        if name in states[0][0]:
            S, order = axis.nodal_abscissa, axis.nodes
            fields = [nodal[name] for nodal, _ in states]
        else:
            S, order = axis.cell_abscissa, axis.cells
            fields = [of_cells[name] for _, of_cells in states]
        curves = np.array([profile.values(values[order]) for values in fields])
        factor, label = _label(profile, float(np.abs(curves).max()))
        for curve, colour in zip(factor * curves, state_colours(len(curves)), strict=True):
            axes.plot(scale * S, curve, color=colour, lw=1.3, marker=axis.marker, clip_on=False)
        if np.abs(curves).max() <= profile.rounding:
            axes.set_ylim(-1.0, 1.0)
        axes.axhline(0.0, color="0.8", linewidth=0.8, zorder=0)
        axes.set_ylabel(label, fontsize="small")
    figure.align_ylabels(panels)
    panels[-1].set(xlabel=f"S ({unit})", xlim=(0.0, scale * axis.length))
    add_legend(beside, series, indices)
    figure.suptitle(fill(title, 70), fontsize="medium", parse_math=False)
    figure.savefig(path, dpi=200)


def _label(profile: Profile, size: float) -> tuple[float, str]:
    """Factor on the values, and the label with the unit or the power of ten that goes with it."""
    if size <= profile.rounding:
        factor, unit = 1.0, profile.unit
    elif profile.prefix:
        factor, unit = prefixed(size, profile.unit)
    else:
        factor, power = power_of_ten(size)
        unit = " ".join(filter(None, [power, profile.unit]))
    return factor, f"{profile.label} ({unit})" if unit else profile.label
