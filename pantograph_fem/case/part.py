"""What the sections of a case have in common: strictness, numbers and points."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import BaseModel, BeforeValidator, ConfigDict

from .problem import Problem, not_allowed, problem_error


class Part(BaseModel):
    """A section of a case: immutable, without unknown keys, without silent conversions."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


def finite_numbers(value: object) -> tuple[float, ...] | None:
    """Numbers of a list, or None when it is not a list of finite numbers."""
    if not isinstance(value, list | tuple):
        return None
    if any(isinstance(v, bool) or not isinstance(v, int | float) for v in value):
        return None
    try:
        numbers = tuple(float(v) for v in value)
    except OverflowError:  # an int beyond the largest float
        return None
    return numbers if all(math.isfinite(v) for v in numbers) else None


def _point(value: object) -> tuple[float, ...]:
    numbers = finite_numbers(value)
    if numbers is None or len(numbers) != 2:
        rule = "be a pair [x, y] of finite numbers"
        raise problem_error(Problem(not_allowed(value, rule)))
    return numbers


#: A point or a vector of the plane, m; a list of two numbers in the file.
Point = Annotated[tuple[float, float], BeforeValidator(_point)]
