"""Sweeps from TOML files."""

from __future__ import annotations

from pathlib import Path

from pydantic import ValidationError

from ..case.messages import case_error, explain
from ..case.tables import tables_of
from ..compare.study_file import read_toml
from .study import SweepStudy
from .vary import Vary


def load_sweep(path: Path) -> SweepStudy:
    """Read the file of a sweep.

    Raises
    ------
    CaseError
        When it cannot be read or describes no sweep; the message lists every problem.
    """
    tables = {"title": path.stem, **read_toml(path), "name": path.stem}
    problems: list[str] = []
    vary = tables_of(tables.pop("vary", None), "vary", Vary, problems)
    if problems:
        # the keys of the file itself, judged without the rules that join them to those varied
        try:
            SweepStudy.model_validate({**tables, "vary": (), "samples": None, "design": "grid"})
        except ValidationError as error:
            problems += explain(error, SweepStudy)
        raise case_error(str(path), problems)
    try:
        return SweepStudy.model_validate({**tables, "vary": vary})
    except ValidationError as error:
        raise case_error(str(path), explain(error, SweepStudy)) from None
