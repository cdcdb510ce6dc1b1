"""An identification on the terminal."""

from __future__ import annotations

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from .identify import Identification

#: Columns of text that goes to a file or a pipe.
_WIDTH = 100


def print_identification(found: Identification, console: Console | None = None) -> None:
    """Print estimates, correlations, χ² and what is known in words."""
    console = console or Console()
    if not console.is_terminal:
        console = Console(file=console.file, width=_WIDTH)
    freedom = len(found.observations.values) - len(found.estimates)
    console.print(Text(found.study.title, style="bold"))
    console.print(_estimates(found))
    if len(found.estimates) > 1:
        console.print(_correlation(found))
    console.print(f"chi² {found.fit.chi2:.4g} for {freedom} degrees of freedom")
    if not found.fit.converged:
        console.print(Text("The search did not end at a minimum; start nearer to it.", "yellow"))
    for sentence in found.sentences:
        console.print(Text(sentence))
    cost = found.cost
    console.print(
        f"{cost.paths} equilibrium paths, {cost.from_rest} of them from rest, in the CPU time of "
        f"{cost.worth:.2g} from rest"
    )


def _estimates(found: Identification) -> Table:
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    table.add_column("constant", no_wrap=True)
    heads = ("start", "estimate", "standard error", f"{100 * found.study.confidence:g} % interval")
    for head in heads:
        table.add_column(Text(head), justify="right", no_wrap=True)
    table.add_column("known", no_wrap=True)
    for e in found.estimates:
        low, high = e.interval
        unit = f" ({e.parameter.unit})" if e.parameter.unit else ""
        numbers = (e.parameter.start, e.value, e.standard_error)
        table.add_row(
            Text(f"{e.parameter.symbol}{unit}"),
            *(Text(f"{number:.4g}") for number in numbers),
            Text(f"{low:.4g} to {high:.4g}"),
            Text("yes" if e.known else "no", style="" if e.known else "yellow"),
        )
    return table


def _correlation(found: Identification) -> Table:
    symbols = [e.parameter.symbol for e in found.estimates]
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    table.add_column("correlation", no_wrap=True)
    for symbol in symbols:
        table.add_column(Text(symbol), justify="right", no_wrap=True)
    for symbol, row in zip(symbols, found.correlation.tolist(), strict=True):
        table.add_row(Text(symbol), *(Text(f"{r:+.3f}") for r in row))
    return table
