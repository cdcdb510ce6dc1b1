"""The study as tables on the terminal."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from .accuracy import Error, error_text
from .limits import QUANTITIES, at_full_load

if TYPE_CHECKING:
    from .study import StudyResult

#: Columns of a table that goes to a file or a pipe, and the fewest in which nothing is cut.
_WIDTH = 100


def print_study(result: StudyResult, console: Console | None = None) -> None:
    """Print a table of the matrix, of the limits of its series, and of the keys that are varied."""
    console = console or Console()
    if not console.is_terminal or console.width < _WIDTH:
        console = Console(file=console.file, width=_WIDTH)
    console.print(Text(result.plan.name, style="bold"))
    console.print(Text(_against(result)))
    console.print(_matrix(result))
    if result.accuracy.limits:
        console.print(_limits(result))
    if result.varied:
        console.print(_knobs(result))


def reference_text(result: StudyResult) -> str:
    """What the reference is and how far it can be trusted; empty without one."""
    reference, uncertainty = result.accuracy.reference, result.accuracy.uncertainty
    if reference is None:
        return ""
    known = [f"{q} {error_text(uncertainty[q])}" for q in QUANTITIES if uncertainty[q] >= 0]
    text = f"{reference.variant.series}, {reference.variant.sizes.text}, {reference.dofs} dofs"
    return f"{text}; uncertainty: {', '.join(known) or 'not known'}"


def _against(result: StudyResult) -> str:
    if not (text := reference_text(result)):
        return "Errors at full load are relative to the limit of each series."
    return (
        f"Errors are relative to the reference: {text} (its difference to the next finest run). "
        "At full load, and the largest at a stop."
    )


def _matrix(result: StudyResult) -> Table:
    table = _table(
        ["scheme, degree", "mesh"],
        ["dofs", "steps", "CPU\n(s)", "solve\n(s)", *_error_heads(result)],
    )
    reference = result.accuracy.reference
    numbers = [*result.matrix]
    if (extra := len(result.runs) - 1) >= result.varied.stop:
        numbers.append(extra)
    for i in numbers:
        run = result.runs[i]
        name = "reference" if run is reference else run.variant.series.replace("degree ", "")
        table.add_row(name, run.variant.sizes.text, *_cost(result, i), *_errors(result, i))
    return table


def _limits(result: StudyResult) -> Table:
    table = _table(["extrapolated", "quantity"], ["limit", "order", "error"])
    for (series, quantity), found in result.accuracy.limits.items():
        limit, order = f"{found.limit.value:.8g}", f"{found.limit.order:.2f}"
        table.add_row(
            series.replace("degree ", ""), quantity, limit, order, error_text(found.error)
        )
    return table


def _knobs(result: StudyResult) -> Table:
    heads = ["steps", "CPU s"]
    heads += [f"{what} of\n{q}" for what in ("error", "change") for q in QUANTITIES]
    table = _table(["key", "value"], heads)
    assert result.default is not None
    previous = ""
    for i in (result.default, *result.varied):
        variant = result.runs[i].variant
        key = variant.key.replace(".", ".\n") if variant.key != previous else ""
        previous = variant.key
        name = "as in the case" if i == result.default else key
        changes = [
            error_text(change(result, i, q)) if i != result.default else "" for q in QUANTITIES
        ]
        steps, cpu = _cost(result, i)[1:3]
        table.add_row(name, variant.value, steps, cpu, *_errors(result, i, False), *changes)
    return table


def change(result: StudyResult, number: int, quantity: str) -> float:
    """Relative change at full load that a varied key makes, without sign."""
    assert result.default is not None
    before = at_full_load(result.runs[result.default], quantity)
    return abs(at_full_load(result.runs[number], quantity) / before - 1) if before else math.nan


def _table(left: Sequence[str], right: Sequence[str]) -> Table:
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for head in left:
        table.add_column(Text(head), no_wrap=True)
    for head in right:
        table.add_column(Text(head), justify="right", no_wrap=True)
    return table


def _error_heads(result: StudyResult) -> list[str]:
    what = "max" if result.accuracy.reference is not None else ""
    return [f"error of\n{quantity}, {what}".rstrip(", ") for quantity in QUANTITIES]


def _cost(result: StudyResult, number: int) -> list[str]:
    run = result.runs[number]
    counts = ["–" if count is None else str(count) for count in (run.dofs, run.steps)]
    seconds = (run.cpu_seconds, run.solve_seconds)
    return counts + ["–" if math.isnan(time) else f"{time:.3g}" for time in seconds]


def _errors(result: StudyResult, number: int, with_largest: bool = True) -> list[str | Text]:
    run, accuracy = result.runs[number], result.accuracy
    if run is accuracy.reference:
        return ["", ""]
    if not run.done:
        failed = run.status.startswith("failed: ") or run.outcome is None
        load = math.nan if run.outcome is None else float(run.outcome.history["load"][-1])
        words = run.status.split(":")[0] if failed else f"stopped at {load:.3g}"
        return [Text(words, style="yellow"), ""]
    cells: list[str | Text] = []
    for quantity in QUANTITIES:
        cell = error_text(accuracy.error(number, quantity))
        if with_largest and accuracy.reference is not None:
            cell += ", " + error_text(accuracy.errors.get((number, quantity), Error()).largest)
        cells.append(cell)
    return cells
