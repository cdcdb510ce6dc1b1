"""Rules for the steps of a path, as a case has them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .solve.step_size import StepSettings

if TYPE_CHECKING:
    from .case import Case


def step_settings(case: Case) -> StepSettings:
    """The section ``[continuation]`` for continuation."""
    options = case.continuation
    return StepSettings(
        stops=tuple(options.stops),
        initial_step=options.initial_step,
        min_step=options.min_step,
        max_step=options.max_step,
        growth=options.growth,
        cutback=options.cutback,
        target_iterations=options.target_iterations,
        critical_step=options.critical_step,
    )
