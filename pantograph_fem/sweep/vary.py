"""Section ``[[vary]]`` of a sweep: a key of the case and the values that it takes."""

from __future__ import annotations

import math
import re
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from ..case.part import Part
from ..case.problem import Problem, not_allowed, problem_error
from ..compare.study import Text

#: What a key may take: a number, a text, true or false, or a list of these.
Value = float | int | bool | str | list[Any]


def _is_value(value: object) -> bool:
    if isinstance(value, list):
        return all(_is_value(item) for item in value)
    if isinstance(value, float):
        return math.isfinite(value)
    return isinstance(value, int | str)


def _values(value: object) -> tuple[Any, ...] | None:
    if value is None:
        return None
    items = list(value) if isinstance(value, list | tuple) else []
    different = all(item not in items[:i] for i, item in enumerate(items))
    if not items or not different or not all(_is_value(item) for item in items):
        rule = "be a list of different numbers, strings, booleans or lists of these"
        raise problem_error(Problem(not_allowed(value, rule)))
    return tuple(items)


class Vary(Part):
    """A key that is varied: over `values`, or between `low` and `high`.

    Attributes
    ----------
    key
        Key of the case, as ``material.bending``; ``grips.top.translation[1]`` is an entry of a
        list that the case has, counted from 0.
    values
        What it takes: one after the other in a grid, with equal probability in other designs.
    low, high
        Ends of its range, in the unit of the key.
    scale
        Whether it is uniform between them itself, or its logarithm.
    count
        Number of values of the range in a grid, both ends included.
    label
        What it is called in figures; the key with its unit by default.
    """

    key: Text
    values: Annotated[tuple[Any, ...] | None, BeforeValidator(_values)] = None
    low: float | None = None
    high: float | None = None
    scale: Literal["linear", "log"] = "linear"
    count: int | None = Field(default=None, ge=2)
    label: Text | None = None

    @model_validator(mode="after")
    def _plain_key(self) -> Vary:
        if not re.fullmatch(r"[\w-]+(\.[\w-]+)*(\[\d+\])?", self.key, flags=re.ASCII):
            rule = "be a key of the case, as material.bending or grips.top.translation[1]"
            raise problem_error(Problem(not_allowed(self.key, rule), ("key",)))
        return self

    @model_validator(mode="after")
    def _values_or_range(self) -> Vary:
        of_range = ("low", "high", "count", "scale")
        given = [name for name in of_range if name in self.model_fields_set]
        if self.values is not None:
            if given:
                text = "not allowed beside values; give either values, or low and high"
                raise problem_error(*(Problem(text, (name,)) for name in given))
            return self
        if self.low is None or self.high is None:
            raise problem_error(Problem("values, or low and high, are missing; give either"))
        if self.low >= self.high:
            rule = f"be greater than low ({self.low})"
            raise problem_error(Problem(not_allowed(self.high, rule), ("high",)))
        if self.scale == "log" and self.low <= 0:
            rule = 'be greater than 0 where scale = "log"'
            raise problem_error(Problem(not_allowed(self.low, rule), ("low",)))
        return self

    @property
    def entry(self) -> tuple[str, int | None]:
        """Key of the section, and the place in its list; None for the whole."""
        found = re.fullmatch(r"(.+)\[(\d+)\]", self.key)
        return (found[1], int(found[2])) if found else (self.key, None)

    @property
    def is_numeric(self) -> bool:
        """Whether it takes numbers alone."""
        values = self.values or ()
        return all(isinstance(v, int | float) and not isinstance(v, bool) for v in values)

    def at(self, u: float) -> Value:
        """The value at a place u of the unit interval, distributed as asked for."""
        if self.values is not None:
            return self.values[min(int(u * len(self.values)), len(self.values) - 1)]
        assert self.low is not None
        assert self.high is not None
        if self.scale == "log":
            value = self.low * (self.high / self.low) ** float(u)
        else:
            value = self.low + (self.high - self.low) * float(u)
        return min(max(value, self.low), self.high)  # rounding leaves no range
