"""The comparison as a table on the terminal."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.measure import Measurement
from rich.table import Table
from rich.text import Text

from .comparison import Comparison, Extrapolated, Number
from .outcome import DONE, Outcome
from .quantities import unit

#: Columns of a table that goes to a file or a pipe.
_WIDTH = 100


def print_table(comparison: Comparison, console: Console | None = None) -> None:
    """Print runs down and quantities across, in as many tables as the terminal needs.

    A cell gives the value, the relative difference to the reference, and the observed order of
    convergence p.
    """
    console = console or Console()
    if not console.is_terminal:
        console = Console(file=console.file, width=_WIDTH)
    console.print(Text(_title(comparison), style="bold"))
    left = list(comparison.quantities)
    while left:
        count = next(
            (n for n in range(len(left), 1, -1) if _fits(comparison, left[:n], console)), 1
        )
        console.print(_table(comparison, left[:count]))
        left = left[count:]


def _fits(comparison: Comparison, quantities: Sequence[str], console: Console) -> bool:
    table = _table(comparison, quantities)
    # as wide as it likes: rich would cut cells before it said that they do not fit
    options = console.options.update(max_width=10_000)
    return Measurement.get(console, options, table).maximum <= console.width


def _title(comparison: Comparison) -> str:
    parts = [comparison.study.title or "Comparison"]
    if not math.isnan(comparison.load):
        parts.append(f"at load factor {comparison.load:.6g}")
    if (number := comparison.reference) is not None:
        label = comparison.outcomes[number].entry.label
        parts.append(f"differences to {label}")
    if comparison.study.expected_order is not None:
        parts.append(f"expected order p = {comparison.study.expected_order:g}")
    return ", ".join(parts)


def _table(comparison: Comparison, quantities: Sequence[str]) -> Table:
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    table.add_column("run", no_wrap=True)
    has_parameter = any(run.entry.parameter is not None for run in comparison.outcomes)
    if has_parameter:
        table.add_column(Text(comparison.study.parameter), justify="right", no_wrap=True)
    table.add_column("status", no_wrap=True)
    for quantity in quantities:
        head = f"{quantity}\n({unit(quantity)})" if unit(quantity) else quantity
        table.add_column(Text(head), justify="right", no_wrap=True)
    for i, run in enumerate(comparison.outcomes):
        parameter = run.entry.parameter
        cells = [Text(run.entry.label)]
        if has_parameter:
            cells.append(Text("" if parameter is None else f"{parameter:g}"))
        cells.append(_status(run, comparison.load))
        cells += [_cell(comparison.numbers.get((i, quantity))) for quantity in quantities]
        table.add_row(*cells)
    if any(quantity in comparison.limits for quantity in quantities):
        cells = [Text("extrapolated", style="italic"), *[Text("")] * (1 + has_parameter)]
        cells += [_cell(comparison.limits.get(quantity)) for quantity in quantities]
        table.add_row(*cells)
    return table


def _status(run: Outcome, load: float) -> Text:
    stable = run.history["stable"]
    reached = run.history["load"] <= (1.0 if math.isnan(load) else load + 1e-9)
    lines = [DONE if run.done else f"stopped at {run.history['load'][-1]:.4g}"]
    if not stable[reached].all():
        lines.append("unstable")
    return Text("\n".join(lines), style="" if len(lines) == 1 and run.done else "yellow")


def _cell(number: Number | Extrapolated | None) -> Text:
    if number is None:
        return Text("–")
    value = number.value if isinstance(number, Number) else number.limit
    lines = [f"{value:.6g}"]
    if not math.isnan(number.relative_difference):
        lines.append(relative_text(number.relative_difference))
    if not math.isnan(number.order):
        lines.append(f"p = {number.order:.2f}")
    return Text("\n".join(lines))


def relative_text(relative: float) -> str:
    """Write a relative difference: in per cent from 0.1 % on, below in scientific notation."""
    if not 1e-3 <= abs(relative) < 100:
        return f"{relative:+.1e}" if relative else "0"
    return f"{100 * relative:+.3g} %" if abs(relative) < 1 else f"{100 * relative:+.0f} %"
