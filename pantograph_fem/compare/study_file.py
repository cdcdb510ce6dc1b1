"""Studies from TOML files."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError

from ..case.messages import case_error, explain
from ..case.part import Part
from ..case.problem import not_allowed, value_text
from ..errors import CaseError
from .study import Mark, Study, StudyRun

P = TypeVar("P", bound=Part)


def load_study(path: Path, data: Mapping[str, Any]) -> Study:
    """Check the tables of a study file.

    Parameters
    ----------
    path
        The file; its stem is the default name.
    data
        What `read_toml` found in it.

    Raises
    ------
    CaseError
        When they describe no study; the message lists every problem.
    """
    tables = {"name": path.stem, "title": path.stem, **data}
    problems: list[str] = []
    # Item by item, as the keys that are allowed are those of the item and not of the study.
    runs = _items(tables.pop("runs", None), "runs", StudyRun, problems)
    marks = _items(tables.pop("marks", []), "marks", Mark, problems)
    try:
        study = Study.model_validate({**tables, "runs": runs, "marks": marks})
    except ValidationError as error:
        raise case_error(str(path), problems + explain(error, Study)) from None
    if problems:
        raise case_error(str(path), problems)
    return study


def read_toml(path: Path) -> dict[str, Any]:
    """Tables of a TOML file.

    Raises
    ------
    CaseError
        When it cannot be read or is not TOML.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise CaseError(f"{path} cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise case_error(str(path), [f"not UTF-8 text, at byte {error.start}"]) from None
    except tomllib.TOMLDecodeError as error:
        raise case_error(str(path), [f"not TOML: {error}"]) from None


def _items(value: object, key: str, model: type[P], problems: list[str]) -> tuple[P, ...]:
    """Validate each table of a list; what is wrong is added to the problems."""
    if not isinstance(value, list) or (key == "runs" and not value):
        needed = "at least one table" if key == "runs" else "tables"
        shown = "missing" if value is None else f"{value_text(value)} is not allowed"
        problems.append(f"{key}: {shown}; it must be {needed} [[{key}]]")
        return ()
    items = []
    for i, table in enumerate(value):
        if not isinstance(table, dict):
            rule = f"be a table with the keys {', '.join(sorted(model.model_fields))}"
            problems.append(f"{key}[{i}]: {not_allowed(table, rule)}")
            continue
        try:
            items.append(model.model_validate(table))
        except ValidationError as error:
            problems += [f"{key}[{i}].{line}" for line in explain(error, model)]
    return tuple(items)
