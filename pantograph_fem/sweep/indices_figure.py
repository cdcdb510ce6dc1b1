"""The figure ``indices.png``: elementary effects, or parts of the variance."""

from __future__ import annotations

from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..compare.quantities import unit

if TYPE_CHECKING:
    from .sensitivity import Indices
    from .sweep import SweepResult


def draw_indices(result: SweepResult, path: Path) -> bool:
    """Draw a panel per response, and say whether there was anything to draw.

    Of Morris's effects the spread σ over the mean magnitude μ*: far right matters, high up
    interacts or is nonlinear. Of Sobol's indices bars of the first and the total order. Thin lines
    are 95 % intervals.
    """
    if not result.indices:
        path.unlink(missing_ok=True)
        return False
    morris = result.plan.study.design == "morris"
    count = len(result.indices)
    figure = Figure(figsize=(max(3.8 * count, 4.2), 3.5))
    figure.set_layout_engine("constrained", w_pad=0.08, h_pad=0.08)
    for axes, found in zip(
        figure.subplots(1, count, squeeze=False)[0], result.indices, strict=True
    ):
        (_draw_morris if morris else _draw_sobol)(axes, found)
        axes.set_title(found.response, fontsize="medium", parse_math=False)
        axes.spines[["top", "right"]].set_visible(False)
    if not morris:
        figure.legend(
            *axes.get_legend_handles_labels(),
            loc="outside lower center",
            ncols=2,
            frameon=False,
            fontsize="small",
        )
    if result.plan.study.title:
        title = fill(result.plan.study.title, 24 * count + 30)
        figure.suptitle(title, fontsize="medium", parse_math=False)
    figure.savefig(path, dpi=200)
    return True


def _draw_morris(axes: Axes, found: Indices) -> None:
    mean, spread = found.values["mu_star"], found.values["sigma"]
    high = 1.15 * max(float((mean + found.values["mu_star_conf"]).max()), float(spread.max()))
    axes.plot([0.0, high], [0.0, high], ":", color="0.6", linewidth=1.0)
    axes.annotate("σ = μ*", (0.86 * high, 0.86 * high), color="0.5", fontsize="small", ha="right")
    for i, key in enumerate(found.keys):
        axes.errorbar(
            mean[i],
            spread[i],
            xerr=found.values["mu_star_conf"][i],
            fmt="o",
            color=f"C{i}",
            markersize=5,
            elinewidth=1.0,
            label=key,
        )
    of = f" ({unit(found.response)})" if unit(found.response) else ""
    axes.set(xlim=(0.0, high), ylim=(-0.03 * high, high))
    axes.set(xlabel=f"mean magnitude of effects μ*{of}", ylabel=f"their spread σ{of}")
    axes.legend(frameon=False, fontsize="small", loc="upper left")


def _draw_sobol(axes: Axes, found: Indices) -> None:
    places = np.arange(len(found.keys))
    for name, shift, colour, label in (
        ("S1", -0.2, "C0", "first order"),
        ("ST", 0.2, "C1", "total order"),
    ):
        axes.bar(
            places + shift,
            found.values[name],
            0.36,
            yerr=found.values[f"{name}_conf"],
            color=colour,
            error_kw={"elinewidth": 1.0, "ecolor": "0.3"},
            label=label,
        )
    axes.set_xticks(places, [key.rpartition(".")[2] for key in found.keys], rotation=30, ha="right")
    axes.set_ylabel("part of the variance")
    axes.axhline(0.0, color="0.3", linewidth=0.8)
