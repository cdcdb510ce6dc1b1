"""``pantograph stress``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import CaseError
from .options import Quiet
from .processes import processes


def stress(
    only: Annotated[
        list[str] | None,
        typer.Option(
            "--only",
            metavar="PATTERN",
            help="Hard cases by name, as d_*, and those they are compared with; may be repeated.",
        ),
    ] = None,
    output: Annotated[
        Path, typer.Option(metavar="DIR", help="Where the runs and the table go.")
    ] = Path("results/stress"),
    docs: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="A document to put the table into, between its marks."),
    ] = None,
    show: Annotated[bool, typer.Option("--list", help="List the hard cases; run none.")] = False,
    huge: Annotated[
        bool, typer.Option("--huge", help="With those that take an hour and more.")
    ] = False,
    keep: Annotated[
        bool, typer.Option("--keep", help="Judge the runs that are there; run only others.")
    ] = False,
    quiet: Quiet = False,
) -> None:
    """Run hard cases and judge them by their results; exit code 1 if one fails."""
    from ..stress import run_suite, select

    chosen = select(only or (), huge=huge)
    if show:
        width = max(len(hard.name) for hard in chosen)
        for hard in chosen:
            typer.echo(f"{hard.name:{width}}  {hard.hard}")
        return
    if processes() > 1:
        raise CaseError("`pantograph stress` starts processes of its own; leave mpirun out")
    from ..stress.report import paste, print_results, write

    tell = (lambda text: None) if quiet else typer.echo
    results = run_suite(chosen, output, keep=keep, tell=tell)
    write(results, output)
    if docs is not None:
        paste(results, docs)
    print_results(results)
    if not all(result.verdict.passed for result in results):
        raise typer.Exit(1)
