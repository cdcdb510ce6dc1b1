"""``pantograph compare``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .options import Overrides, Quiet
from .processes import rank
from .solver import solver

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..case import Case
    from ..running import RunResult


def compare(
    what: Annotated[
        list[Path],
        typer.Argument(
            metavar="WHAT", help="Folders of results, case files, and at most one study file."
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Where runs and comparison go.",
            show_default="results/<name of the study>, or results/compare",
        ),
    ] = None,
    overrides: Overrides = None,
    rerun: Annotated[
        bool, typer.Option("--rerun", help="Run cases again whose results are there.")
    ] = False,
    quiet: Quiet = False,
) -> None:
    """Put results side by side, with differences and orders of convergence.

    Cases are run first, unless their results are there. Without a study file differences are taken
    against the first of the results.
    """
    from ..compare import compare as compare_results
    from ..compare import write
    from ..compare.table import print_table

    def runner() -> Callable[[Case, Path], RunResult]:
        solve = solver()
        return lambda case, directory: solve(case, directory, quiet=quiet)

    show = rank() == 0
    result = compare_results(
        what,
        output,
        overrides=overrides or (),
        rerun=rerun,
        runner=runner,
        tell=typer.echo if show and not quiet else lambda text: None,
    )
    if show:
        write(result.comparison, result.directory)
        print_table(result.comparison)
        for run in result.comparison.outcomes:
            if not run.done and run.entry.label not in result.stopped:
                typer.echo(f"{run.entry.label}: {run.status}")
        if not quiet:
            typer.echo(f"Tables and figures are in {result.directory}")
    if result.stopped:
        raise result.stopped_error()
