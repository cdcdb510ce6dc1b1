"""Section ``[continuation]``: how the load is raised from 0 to 1."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from .part import Part, finite_numbers
from .problem import Problem, not_allowed, problem_error

#: Loads closer than this cannot be told apart once steps have been added up.
_SMALLEST_STEP = 1e-9


def _stops(value: object) -> tuple[float, ...]:
    """Check the stops and append the full load."""
    stops = finite_numbers(value)
    full = _with_full_load(stops or ())
    if (
        stops is None
        or any(not 0 < stop <= 1 for stop in stops)
        or any(a + _SMALLEST_STEP > b for a, b in pairwise(full))
    ):
        rule = (
            "be a list of increasing load fractions, each greater than 0 and at most 1, "
            f"at least {_SMALLEST_STEP:g} apart"
        )
        raise problem_error(Problem(not_allowed(value, rule)))
    return full


def _with_full_load(stops: tuple[float, ...]) -> tuple[float, ...]:
    return stops if stops[-1:] == (1.0,) else (*stops, 1.0)


def _default_initial_step(fields: dict[str, Any]) -> float:
    """Follow a smaller `max_step`, which is then the only key to set for smaller steps."""
    return min(0.02, float(fields.get("max_step", 0.02)))


class Continuation(Part):
    """Load steps and Newton iterations; loads and steps are fractions of the full load.

    Attributes
    ----------
    stops
        Increasing loads at which a state must be saved; the last is 1.
    max_step, min_step, initial_step
        Largest, smallest and first step; the first is 0.02, or `max_step` if less, by default.
    growth, cutback
        Largest growth of the step after an accepted one; its shrinkage after a rejected one.
    target_iterations
        Newton iterations (tangents factorised) after which the step size is kept.
    critical_step
        Step within which a loss of stability is pinned down before it is believed.
    max_iterations
        Newton iterations after which a step is rejected.
    tolerance
        Largest remaining error of a Newton solve, relative to the typical size of each unknown.
    predictor
        First guess of a step: along the tangent, along the last secant, or the last state.
    method
        Steps in load, or in length along the path, which pass points where the load turns back.
    max_steps
        Steps after which a path that is followed along its arc is given up.
    on_instability
        Where a path loses stability: go on, end there, or go on along the stable path that
        branches off.
    """

    stops: Annotated[tuple[float, ...], BeforeValidator(_stops)] = (1.0,)
    max_step: float = Field(default=0.25, gt=0, le=1)
    min_step: float = Field(default=1e-5, ge=_SMALLEST_STEP, le=1)
    initial_step: float = Field(default_factory=_default_initial_step, gt=0, le=1)
    growth: float = Field(default=2.0, gt=1)
    cutback: float = Field(default=0.5, gt=0, lt=1)
    target_iterations: int = Field(default=4, ge=1)
    critical_step: float = Field(default=1e-3, gt=0, le=1)
    max_iterations: int = Field(default=15, ge=1)
    tolerance: float = Field(default=1e-8, ge=1e-13, le=1e-3)
    predictor: Literal["tangent", "secant", "none"] = "tangent"
    method: Literal["load", "arc_length"] = "load"
    max_steps: int = Field(default=1000, ge=1)
    on_instability: Literal["follow", "stop", "branch"] = "follow"

    @model_validator(mode="after")
    def _ordered_steps(self) -> Continuation:
        if not self.min_step <= self.initial_step <= self.max_step:
            rule = (
                f"be at least continuation.min_step ({self.min_step}) "
                f"and at most continuation.max_step ({self.max_step})"
            )
            problem = Problem(not_allowed(self.initial_step, rule), ("initial_step",))
            raise problem_error(problem)
        return self
