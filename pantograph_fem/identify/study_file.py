"""Studies of ``pantograph identify`` from TOML files."""

from __future__ import annotations

from pathlib import Path

from pydantic import ValidationError

from ..case.messages import case_error, explain
from ..case.problem import not_allowed
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
    # Item by item, as the keys that are allowed are those of the item and not of the study.
    data = _data(tables.pop("data", None), problems)
    try:
        study = IdentifyStudy.model_validate({**tables, "data": data})
    except ValidationError as error:
        problems += explain(error, IdentifyStudy)
    if problems:
        raise case_error(str(path), problems)
    return study


def _data(value: object, problems: list[str]) -> tuple[DataFile, ...]:
    if not isinstance(value, list) or not value:
        shown = "missing; it" if value is None else not_allowed(value, "").rstrip(" must")
        problems.append(f"data: {shown} must be at least one table [[data]]")
        return ()
    files = []
    for i, table in enumerate(value):
        if not isinstance(table, dict):
            rule = f"be a table with the keys {', '.join(sorted(DataFile.model_fields))}"
            problems.append(f"data[{i}]: {not_allowed(table, rule)}")
            continue
        try:
            files.append(DataFile.model_validate(table))
        except ValidationError as error:
            problems += [f"data[{i}].{line}" for line in explain(error, DataFile)]
    names = [file.file for file in files]
    if len(set(names)) < len(names):
        problems.append("data: a file is named twice; each must have one table, with its columns")
    return tuple(files)
