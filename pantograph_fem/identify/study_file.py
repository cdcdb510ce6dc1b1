"""Studies of ``pantograph identify`` from TOML files."""

from __future__ import annotations

from pathlib import Path

from pydantic import ValidationError

from ..case.messages import case_error, explain
from ..case.tables import tables_of
from ..compare.study_file import read_toml
from .study import DataFile, IdentifyStudy


def load_identify_study(path: Path) -> IdentifyStudy:
    """Read a study file.

    Raises
    ------
    CaseError
        When it cannot be read or describes no study; the message lists every problem.
    """
    tables = {"name": path.stem, "title": path.stem, **read_toml(path)}
    problems: list[str] = []
    data = _data(tables.pop("data", None), problems)
    try:
        study = IdentifyStudy.model_validate({**tables, "data": data})
    except ValidationError as error:
        problems += explain(error, IdentifyStudy)
    if problems:
        raise case_error(str(path), problems)
    return study


def _data(value: object, problems: list[str]) -> tuple[DataFile, ...]:
    files = tables_of(value, "data", DataFile, problems)
    names = [file.file for file in files]
    if len(set(names)) < len(names):
        problems.append("data: a file is named twice; each must have one table, with its columns")
    return files
