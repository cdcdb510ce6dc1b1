"""From pydantic's errors to sentences that the author of a case file can act on.

There is one line per problem, ``<key path>: <value> is not allowed; it must <rule>``.
"""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from types import UnionType
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from ..errors import CaseError
from .problem import PROBLEM, Problem, not_allowed, one_of, path_text

_NOUNS: dict[object, str] = {
    float: "a number",
    int: "a whole number",
    str: "a string",
    bool: "true or false",
}

#: Errors of the bounds themselves, for which the noun goes without saying.
_BOUNDS = {"greater_than", "greater_than_equal", "less_than", "less_than_equal"}


def case_error(source: str, problems: Sequence[str]) -> CaseError:
    """All problems of a case in one error; `source` says where the case comes from."""
    return CaseError(f"{source} is wrong:\n" + "\n".join(f"  {problem}" for problem in problems))


def explain(error: ValidationError, model: type[BaseModel]) -> list[str]:
    """One line for each problem that validating a `model` found."""
    return [f"{path_text(p.keys)}: {p.text}" for p in problems_of(error, model)]


def problems_of(error: ValidationError, model: type[BaseModel]) -> list[Problem]:
    """Each problem that validating a `model` found."""
    problems = []
    for item in error.errors(include_url=False):
        kind, loc, value = item["type"], item["loc"], item["input"]
        if kind == PROBLEM:
            problems += [Problem(p.text, loc + p.keys) for p in item["ctx"]["problems"]]
        elif kind == "extra_forbidden":
            problems.append(Problem(_unknown_key(model, loc), loc))
        elif kind == "missing":
            problems.append(Problem(f"missing; {_requirement(model, loc)}", loc))
        elif kind == "default_factory_not_called":
            pass  # it follows from another error in the section
        else:
            rule = _rule(_field(model, loc), kind) or item["msg"]
            problems.append(Problem(not_allowed(value, rule), loc))
    return problems


def _unknown_key(model: type[BaseModel], loc: tuple[int | str, ...]) -> str:
    section = _section(_field(model, loc[:-1])) or model
    allowed = sorted(section.model_fields)
    close = difflib.get_close_matches(str(loc[-1]), allowed, n=1)
    hint = f'did you mean "{close[0]}"? Allowed' if close else "allowed"
    return f"unknown key; {hint} here: {', '.join(allowed)}"


def _requirement(model: type[BaseModel], loc: tuple[int | str, ...]) -> str:
    field = _field(model, loc)
    if _section(field):
        return f"the section [{path_text(loc)}] is required"
    return f"it is required and must {_rule(field, 'missing')}"


def _field(model: type[BaseModel], loc: tuple[int | str, ...]) -> FieldInfo | None:
    """Field at a path of keys; None for the case itself and inside lists."""
    field, section = None, model
    for i, key in enumerate(loc):
        field = section.model_fields.get(str(key))
        inner = _section(field)
        if inner is None:
            return field if i == len(loc) - 1 else None
        section = inner
    return field


def _section(field: FieldInfo | None) -> type[BaseModel] | None:
    annotation = field.annotation if field else None
    if isinstance(annotation, UnionType):  # a section that may be absent
        annotation = next(iter(set(get_args(annotation)) - {type(None)}), None)
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return None


def _rule(field: FieldInfo | None, error_type: str) -> str:
    """Complete "it must ..." with what the field allows; empty when that is not known."""
    if field is None:
        return ""
    if section := _section(field):
        return f"be a section with the keys {', '.join(sorted(section.model_fields))}"
    if get_origin(field.annotation) is Literal:
        return f"be {one_of(get_args(field.annotation))}"
    bounds = _bounds(field.metadata)
    if error_type in _BOUNDS:
        return f"be {bounds}"
    types = (field.annotation, *get_args(field.annotation))
    noun = next((_NOUNS[t] for t in types if t in _NOUNS), "")
    if error_type == "finite_number":
        noun = noun.replace("a number", "a finite number")
    comma = "," if bounds[:1].isdigit() else ""
    return f"be {noun}{comma} {bounds}".rstrip() if noun else ""


def _bounds(metadata: Sequence[Any]) -> str:
    """Word the bounds of a number, such as "greater than 0 and at most 1"."""
    limits = {
        name: getattr(item, name)
        for item in metadata
        for name in ("gt", "ge", "lt", "le")
        if hasattr(item, name)
    }
    if "ge" in limits and "le" in limits:
        return f"from {limits['ge']} to {limits['le']}"
    words = {
        "gt": "greater than {}",
        "ge": "{} or greater",
        "lt": "less than {}",
        "le": "at most {}",
    }
    return " and ".join(words[name].format(limit) for name, limit in limits.items())
