"""The figure ``residuals.png``: by how many standard errors the model misses each value."""

from __future__ import annotations

from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.figure import Figure

from .fit_figure import _drive, _drive_label
from .identify import Identification
from .quantities import quantities_of


def draw_residuals(found: Identification, path: Path) -> None:
    """Draw residuals against the displacement, and their distribution beside the normal one."""
    kinds = quantities_of(found.experiment.case)
    observed = found.observations
    names = np.array([kinds[found.experiment.columns[c]].name for c in observed.column])
    x = _drive(found, observed.loads[observed.load])
    figure = Figure(figsize=(7.6, 3.4))
    figure.set_layout_engine("constrained", w_pad=0.1, h_pad=0.1)
    axes, side = figure.subplots(1, 2, width_ratios=[3, 1], sharey=True)
    groups = list(dict.fromkeys(names.tolist()))
    width = 0.03 * float(x.max())
    for i, name in enumerate(groups):
        mine = names == name
        shift = width * (i - 0.5 * (len(groups) - 1)) / max(len(groups), 1)
        axes.plot(
            x[mine] + shift, found.fit.residuals[mine], "o", markersize=4, alpha=0.7, label=name
        )
    for height, dash in ((0.0, "-"), (-2.0, ":"), (2.0, ":")):
        axes.axhline(height, color="0.6", linewidth=0.8, linestyle=dash, zorder=0)
    axes.set(xlabel=_drive_label(found), ylabel="(model - data) / standard error")
    axes.set_xlim(left=0.0)
    axes.legend(frameon=False, fontsize="small")
    reach = max(3.5, 1.05 * float(np.abs(found.fit.residuals).max()))
    bins = np.linspace(-reach, reach, 2 * max(4, int(0.5 * np.sqrt(len(x)))) + 1)
    side.hist(found.fit.residuals, bins=bins, orientation="horizontal", density=True, color="0.75")
    places = np.linspace(-reach, reach, 201)
    side.plot(np.exp(-0.5 * places**2) / np.sqrt(2 * np.pi), places, color="0.2", linewidth=1.0)
    side.set(xlabel="density")
    for panel in (axes, side):
        panel.spines[["top", "right"]].set_visible(False)
    figure.suptitle(fill(found.study.title, 80), fontsize="medium", parse_math=False)
    figure.savefig(path, dpi=200)
