"""Arguments that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

CaseFile = Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case file.")]
Overrides = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY.PATH=VALUE", help="Replace a value of the case; may be repeated."
    ),
]
Quiet = Annotated[bool, typer.Option("--quiet", help="Show no progress.")]
