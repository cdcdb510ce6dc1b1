"""Sweeps from TOML files."""

from __future__ import annotations

from pathlib import Path

from pydantic import ValidationError

from ..case.messages import case_error, explain
from ..case.problem import not_allowed, value_text
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
    # Item by item, as the keys that are allowed are those of the item and not of the sweep.
    vary = _vary(tables.pop("vary", None), problems)
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


def _vary(value: object, problems: list[str]) -> tuple[Vary, ...]:
    """Validate each table ``[[vary]]``; what is wrong is added to the problems."""
    if not isinstance(value, list) or not value:
        shown = "missing" if value is None else f"{value_text(value)} is not allowed"
        problems.append(f"vary: {shown}; it must be at least one table [[vary]]")
        return ()
    items = []
    for i, table in enumerate(value):
        if not isinstance(table, dict):
            rule = f"be a table with the keys {', '.join(sorted(Vary.model_fields))}"
            problems.append(f"vary[{i}]: {not_allowed(table, rule)}")
            continue
        try:
            items.append(Vary.model_validate(table))
        except ValidationError as error:
            lines = explain(error, Vary)
            problems += [f"vary[{i}]{'' if line[:1] == ':' else '.'}{line}" for line in lines]
    return tuple(items)
