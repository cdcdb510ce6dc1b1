"""The sweep on the terminal: its points, why some failed, and sensitivity indices."""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING

import numpy as np
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from .labels import output_label
from .sensitivity import NAMES

if TYPE_CHECKING:
    from .sensitivity import Indices
    from .sweep import SweepResult

#: Columns of a table that goes to a file or a pipe, and the fewest in which nothing is cut.
_WIDTH = 100

#: Points that are shown one by one, and reasons of failure.
_MOST_POINTS, _MOST_REASONS = 25, 5


def print_sweep(result: SweepResult, console: Console | None = None) -> None:
    """Print the points, or the range of the responses where these are many, and the indices."""
    console = console or Console()
    if not console.is_terminal or console.width < _WIDTH:
        console = Console(file=console.file, width=_WIDTH)
    console.print(Text(result.plan.study.title or result.plan.study.name, style="bold"))
    few = len(result.points) <= _MOST_POINTS
    console.print(_points(result) if few else _ranges(result))
    if result.indices:
        console.print(Text(_meaning(result.plan.study.design)))
    for found in result.indices:
        console.print(_indices(found, result.plan.study.design))
    for line in (*result.notes, *failures(result)):
        console.print(Text(line, style="yellow"))


def failures(result: SweepResult) -> list[str]:
    """How many points failed, and why; the most frequent reasons first."""
    reasons = Counter(point.status for point in result.points if not point.done)
    if not reasons:
        return []
    lines = [f"{reasons.total()} of {len(result.points)} points have no result:"]
    lines += [f"  {n} {reason}" for reason, n in reasons.most_common(_MOST_REASONS)]
    if (more := len(reasons) - _MOST_REASONS) > 0:
        lines.append(f"  and for {more} other reasons, see the column status")
    return lines


def _points(result: SweepResult) -> Table:
    study = result.plan.study
    heads = [output_label(name).replace(" (", "\n(") for name in study.responses]
    table = _table([vary.key for vary in study.vary], [*heads, "steps", "CPU\n(s)"], "status")
    for point in result.points:
        numbers = [point.value(name) for name in (*study.responses, "steps")]
        cells = [_number(value) for value in (*point.point.values, *numbers)]
        seconds = "–" if math.isnan(point.cpu_seconds) else f"{point.cpu_seconds:.1f}"
        table.add_row(*cells, seconds, Text(point.status.partition(":")[0]))
    return table


def _ranges(result: SweepResult) -> Table:
    table = _table(["response"], ["points", "lowest", "median", "mean", "highest"])
    for name in result.plan.study.responses:
        found = np.array([point.value(name) for point in result.points])
        found = found[np.isfinite(found)]
        numbers = [f(found) for f in (np.min, np.median, np.mean, np.max)] if len(found) else []
        cells = [_number(float(number)) for number in numbers]
        table.add_row(Text(output_label(name)), str(len(found)), *cells)
    return table


def _meaning(design: str) -> str:
    if design == "morris":
        return (
            "Elementary effects, changes over the whole range of a key: their mean mu, mean "
            "magnitude mu* and spread sigma"
        )
    return "Parts of the variance: due to a key alone, S1, and with its interactions, ST"


def _indices(found: Indices, design: str) -> Table:
    unit = output_label(found.response) if design == "morris" else found.response
    names = [name for name in NAMES[design] if not name.endswith("_conf")]
    table = _table([unit], [name.replace("mu_star", "mu*") for name in names])
    main = "mu_star" if design == "morris" else "ST"
    for i in np.argsort(-found.values[main]):
        cells = []
        for name in names:
            half = found.values.get(f"{name}_conf")
            cells.append(
                f"{found.values[name][i]:.4g}" + (f" ± {half[i]:.2g}" if half is not None else "")
            )
        table.add_row(Text(found.keys[i]), *cells)
    return table


def _table(left: list[str], right: list[str], last: str = "") -> Table:
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for name in left:
        table.add_column(Text(name))
    for name in right:
        table.add_column(Text(name), justify="right", no_wrap=True)
    if last:
        table.add_column(last)
    return table


def _number(value: object) -> Text:
    if isinstance(value, float):
        return Text("–" if math.isnan(value) else f"{value:.6g}")
    return Text(str(value))
