"""The figure benchmark.png: error of the force against CPU time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING

from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator
from series import PANTOGRAPH

from pantograph_fem.study.machine import machine

if TYPE_CHECKING:
    from compare_speed import Measured

_MARKERS = "osD^v<>PhXp*"


def draw(measured: Sequence[Measured], wanted: float, versions: str, path: Path) -> None:
    """Draw a line per series, solid for pantograph_fem, and the error that is asked for."""
    figure = Figure(figsize=(7.6, 4.8))
    figure.set_layout_engine("constrained")
    axes = figure.subplots()
    for i, series in enumerate(dict.fromkeys(m.series for m in measured)):
        points = [(m.cpu_seconds, m.force_error) for m in measured if m.series is series]
        dash = "-" if series.program == PANTOGRAPH else "--"
        style = {"color": f"C{i}", "marker": _MARKERS[i % len(_MARKERS)], "markersize": 4.5}
        axes.loglog(*zip(*points, strict=True), dash, label=series.title, **style)
    axes.axhline(wanted, color="0.6", linewidth=0.8)
    axes.set(xlabel="CPU time of the whole process (s)", ylabel="relative error of the force")
    axes.grid(which="major", color="0.9", linewidth=0.7)
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_locator(LogLocator(subs=(2.0, 5.0)))
    axes.xaxis.set_minor_formatter("{x:g}")
    axes.spines[["top", "right"]].set_visible(False)
    figure.legend(loc="outside right upper", frameon=False, fontsize="x-small")
    note = f"bias extension test, 0.0567 m; one core\n{machine()}\n{fill(versions, 110)}"
    figure.supxlabel(note, fontsize=6, color="0.35", parse_math=False)
    figure.savefig(path, dpi=200)
