"""``pantograph sweep``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import CaseError, PantographError
from .options import Overrides, Quiet
from .processes import processes


def sweep(
    study_file: Annotated[
        Path, typer.Argument(metavar="STUDY.toml", help="The file of the sweep.")
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Where the sweep and its runs go.",
            show_default="results/<name of the file>",
        ),
    ] = None,
    jobs: Annotated[
        int | None,
        typer.Option(metavar="N", help="Runs side by side.", show_default="number of cores"),
    ] = None,
    overrides: Overrides = None,
    rerun: Annotated[
        bool, typer.Option("--rerun", help="Run points again that have been run.")
    ] = False,
    quiet: Quiet = False,
) -> None:
    """Run a case at many values of its keys: grids, samples, sensitivity indices.

    Points that have been run are taken as they are, so that the same command goes on with an
    interrupted sweep. Points that fail are rows of the table, without an error.
    """
    from ..sweep import sweep as run_sweep
    from ..sweep import write
    from ..sweep.report import print_sweep

    if processes() > 1:
        raise CaseError("`pantograph sweep` starts processes of its own; leave mpirun out")
    try:
        result = run_sweep(
            study_file, output, overrides=overrides or (), jobs=jobs, rerun=rerun, quiet=quiet
        )
    except KeyboardInterrupt:
        raise PantographError(
            "Interrupted. The same command goes on with the points that are left."
        ) from None
    paths = write(result)
    print_sweep(result)
    if not quiet:
        names = ", ".join(path.name for path in paths)
        typer.echo(f"In {result.plan.directory}: {names}")
