"""The figure ``knobs.png``: what the values of single keys do to accuracy and time."""

from __future__ import annotations

import math
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .limits import QUANTITIES
from .table import change

if TYPE_CHECKING:
    from .study import StudyResult


def draw_knobs(result: StudyResult, path: Path) -> bool:
    """Draw a row of panels per key that is varied, and say whether there is one.

    Left the errors, and the changes against the case as it is; right the CPU time. A dotted line
    is the case as it is.
    """
    keys = list(dict.fromkeys(result.runs[i].variant.key for i in result.varied))
    if not keys:
        path.unlink(missing_ok=True)
        return False
    figure = Figure(figsize=(7.6, 0.8 + 2.5 * len(keys)))
    figure.set_layout_engine("constrained", w_pad=0.08, h_pad=0.08)
    grid = figure.subplots(len(keys), 2, squeeze=False)
    for (left, right), key in zip(grid, keys, strict=True):
        numbers = [i for i in result.varied if result.runs[i].variant.key == key]
        places = _place((left, right), [result.runs[i].variant.value for i in numbers])
        _draw_errors(left, result, numbers, places)
        assert result.default is not None
        before = result.runs[result.default].cpu_seconds
        seconds = [result.runs[i].cpu_seconds for i in numbers]
        right.plot(places, seconds, "o-", color="C2")
        right.axhline(before, color="0.4", linestyle=":", linewidth=1.0)
        right.set_ylim(0.0, 1.1 * max(*seconds, before))
        left.set_ylabel("relative error, change")
        right.set_ylabel("CPU time (s)")
        for axes in (left, right):
            for line in axes.lines:
                line.set(markersize=4.5)
            axes.set_xlabel(key, parse_math=False)
            axes.grid(which="major", color="0.9", linewidth=0.7)
            axes.spines[["top", "right"]].set_visible(False)
    handles = {h.get_label(): h for axes in grid.flat for h in axes.get_legend_handles_labels()[0]}
    figure.legend(
        handles=list(handles.values()),
        loc="outside lower center",
        ncols=2,
        frameon=False,
        fontsize="small",
    )
    figure.suptitle(fill(result.plan.name, 90), fontsize="medium", parse_math=False)
    figure.savefig(path, dpi=200)
    return True


def _draw_errors(axes: Axes, result: StudyResult, numbers: list[int], places: list[float]) -> None:
    default = result.default
    assert default is not None
    found = []
    for quantity, colour, marker in zip(QUANTITIES, ("C0", "C1"), "os", strict=True):
        errors = [result.accuracy.error(i, quantity) for i in numbers]
        changes = [change(result, i, quantity) for i in numbers]
        for numbers_of, dash, label, face in (
            (errors, "-", f"error of {quantity}", colour),
            (changes, "--", f"change of {quantity}", "white"),
        ):
            # zero has no place on the axis
            y = [number if number > 0 else math.nan for number in numbers_of]
            found += [number for number in y if number > 0]
            axes.plot(places, y, dash, color=colour, marker=marker, mfc=face, label=label)
        before = result.accuracy.error(default, quantity)
        if before > 0:
            axes.axhline(before, color=colour, linestyle=":", linewidth=1.0)
    if found:
        axes.set_yscale("log")


def _place(panels: tuple[Axes, Axes], values: list[str]) -> list[float]:
    """Places of values on the axis: their numbers, or one after the other where there are none."""
    try:
        numbers = [float(value) for value in values]
    except ValueError:
        for axes in panels:
            axes.set_xticks(range(len(values)), values)
        return [float(i) for i in range(len(values))]
    if min(numbers) > 0 and max(numbers) > 10 * min(numbers):
        for axes in panels:
            axes.set_xscale("log")
    return numbers
