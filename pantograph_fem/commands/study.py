"""``pantograph study``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import CaseError
from .options import CaseFile, Overrides, Quiet
from .processes import processes


def study(
    case_file: CaseFile,
    schemes: Annotated[
        list[str] | None,
        typer.Option("--scheme", metavar="SCHEME", help="A scheme; may be repeated."),
    ] = None,
    degrees: Annotated[
        list[int] | None,
        typer.Option("--degree", metavar="DEGREE", help="A degree; may be repeated."),
    ] = None,
    meshes: Annotated[
        list[str] | None,
        typer.Option(
            "--mesh",
            metavar="SIZE/CORNER",
            help="Element sizes inside and at the corners, m; may be repeated.",
            show_default="multiples of those of the case",
        ),
    ] = None,
    knobs: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            metavar="KEY.PATH=V1,V2,...",
            help="Values that a key takes, alone, in the case as it is; may be repeated.",
        ),
    ] = None,
    repeat: Annotated[
        int, typer.Option(metavar="N", help="Times each run is measured; the median counts.")
    ] = 1,
    reference: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR", help="Results to take errors against.", show_default="a finer run"
        ),
    ] = None,
    no_reference: Annotated[
        bool,
        typer.Option("--no-reference", help="Take errors against the limit of each series alone."),
    ] = False,
    output: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Where the study and its runs go.",
            show_default="results/study_<name>",
        ),
    ] = None,
    overrides: Overrides = None,
    rerun: Annotated[
        bool, typer.Option("--rerun", help="Measure runs again whose results are there.")
    ] = False,
    quiet: Quiet = False,
) -> None:
    """Show what accuracy costs: one case with several schemes, degrees and meshes.

    Every combination is run in a process of its own, one at a time. A run that stops on its way is
    kept, without an error.
    """
    from ..study import study as run_study
    from ..study import write
    from ..study.advice import advice
    from ..study.plan import Wanted
    from ..study.table import print_study

    if processes() > 1:
        raise CaseError("`pantograph study` starts processes of its own; leave mpirun out")
    wanted = Wanted(
        schemes=schemes or (),
        degrees=degrees or (),
        meshes=meshes or (),
        knobs=knobs or (),
        overrides=overrides or (),
        reference=reference,
        with_reference=not no_reference,
    )
    result = run_study(
        case_file,
        output,
        wanted,
        repeat=repeat,
        rerun=rerun,
        tell=(lambda text: None) if quiet else typer.echo,
    )
    write(result)
    print_study(result)
    typer.echo("\n".join(advice(result)))
    if not quiet:
        typer.echo(f"Table and figures are in {result.plan.directory}")
    if failure := result.failure():
        raise failure
