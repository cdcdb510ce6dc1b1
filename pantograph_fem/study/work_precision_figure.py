"""The figure ``work_precision.png``: errors against time and against the number of dofs."""

from __future__ import annotations

import math
from itertools import cycle
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from .limits import QUANTITIES

if TYPE_CHECKING:
    from .study import StudyResult

_MARKERS = "osD^v<>P"
_DASHES = ("-", "--", "-.", ":")


def draw_work_precision(result: StudyResult, path: Path) -> bool:
    """Draw errors at full load, and say whether there was anything to draw.

    A line per scheme (dash) and degree (colour and marker). Below the grey level errors are not
    told apart from that of the reference. The machine and the versions stand below.
    """
    names = dict.fromkeys(run.variant.series for run in (result.runs[i] for i in result.matrix))
    panels = {
        (row, column): {name: _points(result, name, q, work) for name in names}
        for row, q in enumerate(QUANTITIES)
        for column, work in enumerate(("cpu_seconds", "dofs"))
    }
    if not any(points for lines in panels.values() for points in lines.values()):
        path.unlink(missing_ok=True)
        return False
    figure = Figure(figsize=(7.6, 6.6))
    figure.set_layout_engine("constrained", w_pad=0.08, h_pad=0.08)
    grid = figure.subplots(2, 2, sharex="col", sharey="row", squeeze=False)
    styles = _styles(result, list(names))
    for (row, column), lines in panels.items():
        axes = grid[row, column]
        for name, points in lines.items():
            colour, marker, dash = styles[name]
            x, y = zip(*points, strict=True) if points else ((), ())
            axes.loglog(x, y, dash, color=colour, marker=marker, label=name)
        for line in axes.lines:
            line.set(markersize=4.5, linewidth=1.2)
        axes.grid(which="major", color="0.9", linewidth=0.7)
        axes.spines[["top", "right"]].set_visible(False)
    for i in range(2):
        _widen(grid[1, i], "x")
        _widen(grid[i, 0], "y")
    for row, quantity in enumerate(QUANTITIES):
        grid[row, 0].set_ylabel(f"relative error of {quantity}")
        for axes in grid[row]:
            _grey_out(axes, result.accuracy.uncertainty.get(quantity, math.nan))
    grid[1, 0].set_xlabel("CPU time of the whole run (s)")
    grid[1, 1].set_xlabel("degrees of freedom")
    handles = {h.get_label(): h for axes in grid.flat for h in axes.get_legend_handles_labels()[0]}
    figure.legend(
        handles=list(handles.values()),
        loc="outside upper center",
        ncols=min(3, len(handles)),
        frameon=False,
        fontsize="small",
        title=fill(result.plan.name, 90).replace("$", r"\$"),
    )
    figure.supxlabel(_small_type(result), fontsize=6, color="0.35", parse_math=False)
    figure.savefig(path, dpi=200)
    return True


def _points(result: StudyResult, name: str, quantity: str, work: str) -> list[tuple[float, float]]:
    """Work and error of the runs of a series; errors of zero have no place on the axis."""
    points = []
    for i in result.matrix:
        run, error = result.runs[i], result.accuracy.error(i, quantity)
        x = getattr(run, work)
        if run.variant.series == name and error > 0 and x is not None and x > 0:
            points.append((float(x), error))
    return points


def _styles(result: StudyResult, names: list[str]) -> dict[str, tuple[str, str, str]]:
    """Colour, marker and dash of each series."""
    variants = {result.runs[i].variant.series: result.runs[i].variant for i in result.matrix}
    degrees = sorted({variants[name].degree or 0 for name in names})
    schemes = list(dict.fromkeys(variants[name].scheme for name in names))
    marks = dict(zip(degrees, cycle(_MARKERS), strict=False))
    dashes = dict(zip(schemes, cycle(_DASHES), strict=False))
    styles = {}
    for name in names:
        degree = variants[name].degree or 0
        colour = f"C{degrees.index(degree)}"
        styles[name] = (colour, marks[degree], dashes[variants[name].scheme])
    return styles


def _widen(axes: Axes, which: str) -> None:
    """Show a decade at least, and numbers in place of powers along the axis of work."""
    axis: Any = getattr(axes, f"{which}axis")
    low, high = axis.get_view_interval()
    more = max(1.0, 10.0 * low / high) ** 0.5
    axes.set(**{f"{which}lim": (low / more, high * more)})  # of all that share it
    if which == "x":
        axis.set_major_formatter("{x:g}")
        axis.set_minor_locator(LogLocator(subs=(2.0, 5.0)))
        axis.set_minor_formatter("{x:g}")
        axis.set_tick_params(which="both", length=3.5, pad=3.5)
    else:
        axis.set_minor_formatter(NullFormatter())


def _grey_out(axes: Axes, uncertainty: float) -> None:
    if not uncertainty > 0:
        return
    bottom, top = axes.get_ylim()
    bottom = min(bottom, uncertainty / 2)
    label = "uncertainty of the reference"
    axes.axhspan(bottom, uncertainty, color="0.9", zorder=0.0, linewidth=0, label=label)
    axes.set_ylim(bottom, top)


def _small_type(result: StudyResult) -> str:
    from .table import reference_text

    lines = []
    if reference := reference_text(result):
        lines.append(f"reference: {reference}")
    lines += dict.fromkeys(run.machine for run in result.runs if run.machine)
    versions = next((run.versions for run in result.runs if run.versions), {})
    lines.append(", ".join(f"{name} {version}" for name, version in versions.items()))
    return "\n".join(fill(line, 150) for line in lines)
