"""Studies from TOML files."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ..case.messages import case_error, explain
from ..case.tables import tables_of
from ..errors import CaseError
from .study import Mark, Study, StudyRun


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
    runs = tables_of(tables.pop("runs", None), "runs", StudyRun, problems)
    marks = tables_of(tables.pop("marks", []), "marks", Mark, problems, optional=True)
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
