"""The hard suite as a table: on the terminal, as CSV and in Markdown."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from ..errors import CaseError
from ..results.atomic import replace_text
from .work import balance

if TYPE_CHECKING:
    from .suite import Result

#: Columns of a table that goes to a file or a pipe.
_WIDTH = 150

COLUMNS = (
    *("name", "hard", "verdict", "outcome", "steps", "cutbacks", "iterations"),
    *("excess_pivots", "lowest_eigenvalue", "work_defect", "work_uncertainty"),
    *("force", "energy", "dofs", "cpu_seconds", "base", "overrides", "failures"),
)

#: In a document, between these the table of the program stands.
BEGIN, END = "<!-- table of pantograph stress -->", "<!-- end of table -->"

_HEADS = {
    "name": "case",
    "hard": "what is hard",
    "steps": "steps",
    "cutbacks": "cut-backs",
    "iterations": "iterations",
    "excess_pivots": "excess pivots",
    "lowest_eigenvalue": "lowest eigenvalue",
    "work_defect": "energy − work",
    "outcome": "outcome",
}


def row(result: Result) -> dict[str, object]:
    """A result by :data:`COLUMNS`; None for what is not known.

    `excess_pivots` is the largest on the path, `lowest_eigenvalue` that of the last state,
    `work_defect` and `work_uncertainty` those of :class:`pantograph_fem.stress.work.Balance`.
    """
    hard, found, verdict = result.hard, result.evidence, result.verdict
    values: dict[str, object] = {
        "name": hard.name,
        "hard": hard.hard,
        "verdict": "ok" if verdict.passed else "FAIL",
        "outcome": verdict.outcome,
        "cutbacks": found.summary.get("cutbacks"),
        "dofs": sum(found.summary.get("dofs", {}).values()) or None,
        "cpu_seconds": round(found.ended.cpu_seconds, 1),
        "base": hard.base,
        "overrides": " ".join(hard.overrides),
        "failures": "; ".join(verdict.failures),
    }
    if found.rows:
        work = balance(found)
        known = "lowest_eigenvalue" in found.history
        values |= {
            "steps": int(found.history["step"][-1]),
            "iterations": int(found.history["newton_iterations"].sum()),
            "excess_pivots": int(found.excess.max()),
            "lowest_eigenvalue": found.last("lowest_eigenvalue") if known else None,
            "work_defect": None if work is None else work.defect,
            "work_uncertainty": None if work is None else work.uncertainty,
            "force": found.last("force"),
            "energy": found.last("energy"),
        }
    return {name: values.get(name) for name in COLUMNS}


def write(results: Sequence[Result], directory: Path) -> None:
    """Write ``stress.csv`` and ``stress.md``."""
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(row(result) for result in results)
    directory.mkdir(parents=True, exist_ok=True)
    replace_text(directory / "stress.csv", text.getvalue())
    replace_text(directory / "stress.md", markdown(results))


def markdown(results: Sequence[Result]) -> str:
    """The table in Markdown."""
    lines = [f"| {' | '.join(_HEADS.values())} |", "|---|---|" + "---:|" * 6 + "---|"]
    lines += [f"| {' | '.join(_cells(result))} |" for result in results]
    return "\n".join(lines) + "\n"


def paste(results: Sequence[Result], document: Path) -> None:
    """Put the table into a document, between its two marks.

    Raises
    ------
    CaseError
        If it has not got them.
    """
    try:
        text = document.read_text(encoding="utf-8")
    except OSError as error:
        raise CaseError(f"--docs: {document} cannot be read: {error.strerror}") from None
    head, begin, rest = text.partition(BEGIN)
    _, end, tail = rest.partition(END)
    if not begin or not end:
        raise CaseError(f'--docs: {document} must have the lines "{BEGIN}" and "{END}"')
    replace_text(document, f"{head}{BEGIN}\n\n{markdown(results)}\n{END}{tail}")


def print_results(results: Sequence[Result], console: Console | None = None) -> None:
    """Print the table, and below it what does not hold."""
    console = console or Console()
    if not console.is_terminal:
        console = Console(file=console.file, width=_WIDTH)
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for name, head in _HEADS.items():
        words = name in ("name", "hard", "outcome")
        table.add_column(Text(head), justify="left" if words else "right", no_wrap=name == "name")
    for result in results:
        cells = _cells(result)
        if not result.verdict.passed:
            cells[-1] = f"FAIL: {result.verdict.outcome}"
        table.add_row(*cells, style="" if result.verdict.passed else "red")
    console.print(table)
    for result in results:
        for failure in result.verdict.failures:
            console.print(Text(f"FAIL {result.hard.name}: {failure}", style="red"))
    failed = sum(not result.verdict.passed for result in results)
    console.print(Text(f"{len(results)} hard cases, {failed} failed"))


def _cells(result: Result) -> list[str]:
    values = row(result)
    cells = []
    for name in _HEADS:
        value = values[name]
        if value is None:
            cells.append("–")
        else:
            cells.append(f"{value:.2g}" if isinstance(value, float) else str(value))
    if not result.verdict.passed:
        cells[-1] = f"FAIL: {cells[-1]}; {values['failures']}"
    return cells
