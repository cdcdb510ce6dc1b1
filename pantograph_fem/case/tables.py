"""Lists of tables, ``[[runs]]`` for one, whose items are checked one by one."""

from __future__ import annotations

from typing import TypeVar

from pydantic import ValidationError

from .messages import explain
from .part import Part
from .problem import not_allowed, value_text

P = TypeVar("P", bound=Part)


def tables_of(
    value: object, key: str, model: type[P], problems: list[str], *, optional: bool = False
) -> tuple[P, ...]:
    """Validate each table of a list; what is wrong is added to the problems.

    Item by item, as the keys that are allowed are those of the item and not of the file.
    An `optional` list may be empty.
    """
    if not isinstance(value, list) or not (value or optional):
        needed = "tables" if optional else "at least one table"
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
            lines = explain(error, model)
            problems += [f"{key}[{i}]{'' if line[:1] == ':' else '.'}{line}" for line in lines]
    return tuple(items)
