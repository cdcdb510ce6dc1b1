"""The figure ``fit.png``: data with error bars and what the model gives, after Figs. 12 and 13."""

from __future__ import annotations

from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .identify import Identification
from .quantities import POSITION, quantities_of

#: Loads at which curves have points, besides those of the data.
_POINTS = 24
#: Panels side by side.
_ACROSS = 3


def draw_fit(found: Identification, path: Path) -> None:
    """Draw a panel per kind of quantity; markers have a figure of their own.

    Error bars are two standard errors each way.
    """
    kinds = quantities_of(found.experiment.case)
    columns = [found.experiment.columns[c] for c in np.unique(found.observations.column)]
    groups: dict[str, list[str]] = {}
    for column in columns:
        groups.setdefault(kinds[column].label, []).append(column)
    if len(groups) > 1:
        groups.pop(POSITION.label, None)
    loads = found.observations.loads
    even = np.linspace(0.0, loads[-1], _POINTS + 1)[1:]
    fine = np.unique(np.concatenate([loads, even[np.abs(even[:, None] - loads).min(1) > 1e-6]]))
    curves = found.paths.curve(found.fit.q, fine.tolist())

    rows = -(-len(groups) // _ACROSS)
    across = min(len(groups), _ACROSS)
    figure = Figure(figsize=(0.4 + 3.9 * across, 0.4 + 3.3 * rows))
    figure.set_layout_engine("constrained", w_pad=0.1, h_pad=0.1)
    panels = np.ravel(figure.subplots(rows, across, squeeze=False))
    for axes in panels[len(groups) :]:
        axes.set_visible(False)
    for axes, (label, names) in zip(panels, groups.items(), strict=False):
        for i, name in enumerate(names):
            number = found.experiment.columns.index(name)
            factor = kinds[name].factor
            x = _drive(found, fine)
            axes.plot(x, factor * curves[:, number], color=f"C{i % 10}", linewidth=1.2)
            _draw_data(axes, found, number, factor, f"C{i % 10}", name)
        axes.set(xlabel=_drive_label(found), ylabel=label)
        axes.set_xlim(left=0.0)
        axes.spines[["top", "right"]].set_visible(False)
        if len(names) <= 12:
            axes.legend(frameon=False, fontsize="small")
    figure.suptitle(fill(found.study.title, 45 * across), fontsize="medium", parse_math=False)
    figure.savefig(path, dpi=200)


def _draw_data(
    axes: Axes, found: Identification, number: int, factor: float, colour: str, name: str
) -> None:
    observed = found.observations
    mine = observed.column == number
    axes.errorbar(
        _drive(found, observed.loads[observed.load[mine]]),
        factor * observed.values[mine],
        yerr=2 * factor * observed.errors[mine],
        fmt="o",
        color=colour,
        markersize=4,
        capsize=2.5,
        linewidth=1.0,
        label=name,
    )


def _drive(found: Identification, loads: np.ndarray) -> np.ndarray:
    """Displacement of the grips, mm, or the load fraction where they do not move apart."""
    return loads * (1e3 * found.experiment.distance or 1.0)


def _drive_label(found: Identification) -> str:
    return "grip displacement (mm)" if found.experiment.distance else "load fraction"
