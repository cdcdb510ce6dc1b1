"""The figure ``curves.png``: force and energy of all runs against what drives them."""

from __future__ import annotations

from itertools import cycle
from pathlib import Path
from textwrap import fill
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from ..results.units import prefixed
from .comparison import Comparison
from .drive import LOAD, common_drive, drive_of
from .quantities import FORCE, values

Array = NDArray[np.float64]

_MARK_DASHES: tuple[Any, ...] = (":", "-.", (0, (1, 4)), (0, (6, 3, 1, 3)))


def draw_curves(comparison: Comparison, path: Path) -> None:
    """Draw the magnitude of the force and the energy, side by side, with one legend.

    The axis is the displacement of the grips or of the end where all runs are driven in the same
    way, else the load factor. The reference is black and dashed. A cross ends a run that was
    stopped; hollow dots are unstable states.
    """
    drives = [drive_of(run.case) for run in comparison.outcomes]
    name = common_drive(drives)
    by_load = name == LOAD.name
    x = [
        run.history["load"] * (1.0 if by_load else drive.distance)
        for run, drive in zip(comparison.outcomes, drives, strict=True)
    ]
    factor, unit = (1.0, "") if by_load else prefixed(max(float(column.max()) for column in x), "m")
    xlabel = name if by_load else f"{name} ({unit})"

    figure = Figure(figsize=(7.6, 3.4 + 0.2 * _legend_rows(comparison)))
    figure.set_layout_engine("constrained", w_pad=0.08, h_pad=0.08)
    panels = zip(
        figure.subplots(1, 2), (FORCE, "energy"), ("force", "energy"), ("N", "J"), strict=True
    )
    for axes, quantity, what, base in panels:
        curves = [values(run, quantity) for run in comparison.outcomes]
        found = [curve for curve in curves if curve is not None]
        y_factor, y_unit = prefixed(max(float(np.abs(curve).max()) for curve in found), base)
        for i, curve in enumerate(curves):
            if curve is not None:
                _draw_run(axes, comparison, i, factor * x[i], y_factor * curve)
        for mark, dash in zip(comparison.study.marks, cycle(_MARK_DASHES), strict=False):
            line = axes.axvline(factor * mark.x, color="0.45", linestyle=dash, linewidth=1.0)
            line.set_label(legend_text(mark.label))
        axes.set(xlabel=xlabel, ylabel=f"{what} ({y_unit})")
        axes.set_xlim(left=0.0)
        if min(curve.min() for curve in found) >= 0:
            axes.set_ylim(bottom=0.0)
        axes.spines[["top", "right"]].set_visible(False)
    handles = axes.get_legend_handles_labels()[0]
    if any(not run.history["stable"].all() for run in comparison.outcomes):
        hollow = Line2D([], [], color="0.3", marker="o", mfc="white", linestyle="none")
        hollow.set_label("unstable")
        handles.append(hollow)
    figure.legend(
        handles=handles,
        loc="outside lower center",
        ncols=_legend_columns(comparison),
        frameon=False,
        fontsize="small",
    )
    if comparison.study.title:
        figure.suptitle(fill(comparison.study.title, 90), fontsize="medium", parse_math=False)
    figure.savefig(path, dpi=200)


def _draw_run(axes: Axes, comparison: Comparison, number: int, x: Array, y: Array) -> None:
    run = comparison.outcomes[number]
    is_reference = number == comparison.reference
    colour = _colour(comparison, number)
    label = run.entry.label if run.done else f"{run.entry.label} (stopped)"
    dash, width = ("--", 1.4) if is_reference else ("-", 1.1)
    axes.plot(
        x,
        y,
        dash,
        color=colour,
        linewidth=width,
        label=legend_text(label),
        zorder=2.0 + is_reference,
    )
    stable = run.history["stable"]
    if not is_reference:
        axes.plot(x[stable], y[stable], "o", color=colour, markersize=3, clip_on=False)
    axes.plot(x[~stable], y[~stable], "o", color=colour, mfc="white", markersize=4)
    if not run.done:
        axes.plot(x[-1:], y[-1:], "x", color=colour, markersize=8, markeredgewidth=1.6, zorder=4.0)


def _colour(comparison: Comparison, number: int) -> object:
    """Black for the reference, dark to light along a series, and distinct colours else."""
    if number == comparison.reference:
        return "black"
    series = comparison.series
    if number in series and len(series) > 1:
        return colormaps["viridis"](0.88 * (1 - series.index(number) / (len(series) - 1)))
    others = [
        i for i in range(len(comparison.outcomes)) if i not in series and i != comparison.reference
    ]
    return f"C{others.index(number)}" if number in others else "C0"


def legend_text(label: str) -> str:
    """Label that a legend shows as it is: without mathematics, and not hidden by its first _."""
    text = label.replace("$", r"\$")
    return f" {text}" if text.startswith("_") else text


def _legend_columns(comparison: Comparison) -> int:
    texts = [run.entry.label for run in comparison.outcomes]
    texts += [mark.label for mark in comparison.study.marks]
    return max(1, min(len(texts), 100 // (max(map(len, texts)) + 8)))


def _legend_rows(comparison: Comparison) -> int:
    count = len(comparison.outcomes) + len(comparison.study.marks)
    return -(-count // _legend_columns(comparison))
