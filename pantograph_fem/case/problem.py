"""Problems that a validator finds, worded for the author of the case file."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from pydantic_core import PydanticCustomError

#: Type of the pydantic errors that carry their own :class:`Problem`.
PROBLEM = "case_problem"

#: Longer values are cut in messages.
_LONGEST_VALUE = 80


class Problem(NamedTuple):
    """One thing that is wrong.

    Attributes
    ----------
    text
        What is wrong and what is allowed, without the key.
    keys
        Keys from the section or value that was validated down to the culprit.
    """

    text: str
    keys: tuple[str | int, ...] = ()


def problem_error(*problems: Problem) -> PydanticCustomError:
    """Error to raise in a pydantic validator."""
    texts = [path_text(p.keys) + ": " + p.text if p.keys else p.text for p in problems]
    return PydanticCustomError(PROBLEM, "{text}", {"text": "\n".join(texts), "problems": problems})


def not_allowed(value: object, rule: str) -> str:
    """Say that a value is not allowed; `rule` completes "it must ..."."""
    return f"{value_text(value)} is not allowed; it must {rule}"


def value_text(value: object) -> str:
    """Write a value as in TOML."""
    text = _toml(value)
    return text if len(text) <= _LONGEST_VALUE else text[: _LONGEST_VALUE - 3] + "..."


def one_of(choices: Iterable[object]) -> str:
    """Write choices, such as ``"beam", "chain" or "sheet"``."""
    *first, last = (value_text(choice) for choice in choices)
    return f"{', '.join(first)} or {last}" if first else last


def path_text(keys: tuple[str | int, ...]) -> str:
    """Write a path of keys and list positions, as in ``output.probes[0]``."""
    text = ""
    for key in keys:
        text += f"[{key}]" if isinstance(key, int) else f".{key_text(key)}"
    return text.removeprefix(".")


def key_text(key: str) -> str:
    """Write a key as in TOML: quoted unless it is plain."""
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else json.dumps(key)


def _toml(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        text = json.dumps(value, ensure_ascii=False)
        # one problem is one line, whatever the value holds
        return "".join(c if c.isprintable() else f"\\u{ord(c):04x}" for c in text)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key_text(str(k))} = {_toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_toml(v) for v in value) + "]"
    return str(value)
