"""Values that the command line puts in place of those of the case file."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from typing import Any

from .problem import path_text, value_text


def apply_overrides(data: dict[str, Any], overrides: Sequence[str]) -> list[str]:
    """Apply overrides ``key.path=value`` to the tables of a case, in place.

    Parameters
    ----------
    data
        Tables of the case; sections that are absent are created.
    overrides
        Each value is read as TOML, and as a plain string where it is not TOML.

    Returns
    -------
    list of str
        One line for each override that could not be applied.
    """
    problems = []
    for override in overrides:
        if problem := _apply(data, override):
            problems.append(f"--set {override}: {problem}")
    return problems


def _apply(data: dict[str, Any], override: str) -> str | None:
    path, equals, text = override.partition("=")
    keys = [key.strip() for key in path.split(".")]
    if not equals or not all(keys):
        return "not of the form key.path=value, such as material.shear=159.0"
    table = data
    for i, key in enumerate(keys[:-1]):
        inner = table.setdefault(key, {})
        if not isinstance(inner, dict):
            where = path_text(tuple(keys[: i + 1]))
            return f"{where} is not a section but {value_text(inner)}; nothing can be set in it"
        table = inner
    table[keys[-1]] = _value(text.strip())
    return None


def _value(text: str) -> object:
    try:
        table = tomllib.loads(f"value = {text}")
    except tomllib.TOMLDecodeError:
        return text
    # a text of several lines may hold further keys: then it is no value
    return table["value"] if len(table) == 1 else text
