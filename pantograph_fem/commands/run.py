"""``pantograph run``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import CaseFile, Overrides, Quiet
from .solver import solver


def run(
    case_file: CaseFile,
    output: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Where results go.", show_default="results/<name>"),
    ] = None,
    overrides: Overrides = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on from the last state of an interrupted run.")
    ] = False,
    quiet: Quiet = False,
) -> None:
    """Simulate a case; also under mpirun."""
    from ..case import load_case

    case = load_case(case_file, overrides or ())
    result = solver()(case, output, resume=resume, quiet=quiet)
    if result.rows and not quiet:
        typer.echo(f"Done: {result.rows[-1].step} steps; results are in {result.directory}")
