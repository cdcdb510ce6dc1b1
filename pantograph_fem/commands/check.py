"""``pantograph check``."""

from __future__ import annotations

import typer

from .options import CaseFile, Overrides


def check(case_file: CaseFile, overrides: Overrides = None) -> None:
    """Validate a case without simulating it."""
    from ..case import load_case

    case = load_case(case_file, overrides or ())
    typer.echo(f"{case_file} is valid: {case.name} ({case.kind})")
