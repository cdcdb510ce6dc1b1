"""``pantograph identify``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import CaseError
from .options import Quiet
from .processes import processes
from .solver import solver


def identify(
    study_file: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="The study file.")],
    output: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR", help="Where results go.", show_default="results/<name of the study>"
        ),
    ] = None,
    synthetic: Annotated[
        bool,
        typer.Option(
            "--synthetic",
            help="Make data of the case, with its constants and the errors of the study, and use "
            "them in place of the study's files.",
        ),
    ] = False,
    no_profile: Annotated[
        bool, typer.Option("--no-profile", help="Leave out the profile likelihoods.")
    ] = False,
    quiet: Quiet = False,
) -> None:
    """Find the constants of a sheet from measured forces, angles, elongations and markers.

    It says how well each constant is known, and which the data do not tell.
    """
    if processes() > 1:
        raise CaseError("`pantograph identify` runs in one process; leave mpirun out")
    from ..identify.study_file import load_identify_study

    load_identify_study(study_file)  # before anything is imported that takes seconds
    solver()
    from ..identify.identify import identify as identify_constants
    from ..identify.table import print_identification
    from ..identify.write import write

    found = identify_constants(
        study_file,
        output,
        synthetic=synthetic,
        profiles=not no_profile,
        tell=(lambda text: None) if quiet else typer.echo,
    )
    write(found)
    print_identification(found)
    if not quiet:
        typer.echo(f"Results and figures are in {found.directory}")
