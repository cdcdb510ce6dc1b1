"""The figure ``states.png``: the deformed sheet over measured markers, after Fig. 14."""

from __future__ import annotations

from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from ..results.deformed_figure import MM, add_lines
from ..results.fields import FieldGrid
from ..results.material_lines import boundary_loops, material_lines
from .identify import Identification

#: States side by side, at most.
_MOST = 6
_WIDTH = 1.9  # inches, of one of them


def draw_states(found: Identification, path: Path) -> None:
    """Draw the fitted sheet with its material lines, and the markers where they were measured."""
    simulation = found.paths.simulation
    grid = simulation.grid()
    loads = found.observations.loads
    shown = np.unique(np.linspace(0, len(loads) - 1, min(_MOST, len(loads))).round().astype(int))
    states = []
    for i in shown:
        displacement = simulation.displacement(found.fit.path.states[i], float(loads[i]))
        if grid is None or displacement is None:
            return
        states.append(displacement)
    assert grid is not None
    plain = FieldGrid(grid.points, grid.cells)
    extent = np.ptp(np.concatenate([grid.points, grid.points + states[-1]]), axis=0)
    height = _WIDTH * extent[1] / extent[0]
    figure = Figure(figsize=(0.7 + _WIDTH * len(shown), height + 1.1))
    figure.set_layout_engine("constrained")
    panels = np.ravel(figure.subplots(1, len(shown), sharey=True, squeeze=False))
    measured = False
    for axes, i, displacement in zip(panels, shown.tolist(), states, strict=True):
        deformed = plain.points + displacement
        angle = found.experiment.case.sheet.fibre_angle
        for degrees in (angle, angle + 90.0):
            direction = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
            spacing = found.experiment.case.output.line_spacing
            lines = material_lines(plain, displacement, direction, spacing)
            add_lines(axes, lines, color="0.55", linewidth=0.5)
        add_lines(axes, [deformed[k] for k in boundary_loops(plain.cells)], "0.2", 0.9)
        places = MM * _measured_markers(found, i)
        measured |= bool(len(places))
        axes.plot(*places.T, "+", color="C3", markersize=6, markeredgewidth=1.2, zorder=3)
        axes.set(aspect="equal", xlabel="x (mm)", title=_title(found, float(loads[i])))
        axes.title.set_fontsize("medium")
        axes.autoscale_view()
        axes.spines[["top", "right"]].set_visible(False)
    panels[0].set_ylabel("y (mm)")
    if measured:
        marks = Line2D([], [], color="C3", marker="+", linestyle="none", label="measured markers")
        drawn = Line2D([], [], color="0.4", linewidth=1.0, label="model")
        figure.legend(handles=[marks, drawn], loc="outside lower center", ncols=2, frameon=False)
    figure.suptitle(fill(found.study.title, 20 * len(shown)), fontsize="medium", parse_math=False)
    figure.savefig(path, dpi=200)


def _title(found: Identification, load: float) -> str:
    distance = found.experiment.distance
    return f"{MM * distance * load:.1f} mm" if distance else f"load {load:.3g}"


def _measured_markers(found: Identification, state: int) -> NDArray[np.float64]:
    """Places of the markers whose two coordinates were measured in a state, shape (n, 2), m."""
    observed = found.observations
    values = {
        found.experiment.columns[observed.column[k]]: float(observed.values[k])
        for k in np.flatnonzero(observed.load == state)
    }
    places = []
    for name, measurement in found.experiment.case.measurements.items():
        columns = measurement.columns(name)
        if measurement.kind == "marker" and all(column in values for column in columns):
            places.append([values[column] for column in columns])
    return np.array(places).reshape(-1, 2)
