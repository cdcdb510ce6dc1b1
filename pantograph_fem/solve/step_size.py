"""Load steps that grow after easy solves, shrink after hard ones and hit the stops exactly."""

from __future__ import annotations

import math
from dataclasses import dataclass

#: A load closer to a stop than this is the stop: rounding of the sums of steps.
_ROUNDING = 1e-12


@dataclass(frozen=True)
class StepSettings:
    """Rules for the step size, all in load factor.

    Attributes
    ----------
    stops
        Increasing loads at which a state must be found; the last ends the path.
    initial_step, min_step, max_step
        First, smallest and largest step.
    growth, cutback
        Largest growth after an accepted step; shrinkage after a rejected one.
    target_iterations
        Newton iterations after which the step size is kept.
    critical_step
        Step within which a loss of stability is pinned down before it is believed.
    """

    stops: tuple[float, ...] = (1.0,)
    initial_step: float = 0.02
    min_step: float = 1e-5
    max_step: float = 0.25
    growth: float = 2.0
    cutback: float = 0.5
    target_iterations: int = 4
    critical_step: float = 1e-3


class StepSize:
    """The current step size of a path."""

    def __init__(self, settings: StepSettings, value: float | None = None) -> None:
        self.settings = settings
        self.value = settings.initial_step if value is None else value

    def next_load(self, load: float) -> float:
        """Where to go from `load`: equal steps, none above the step size, up to the next stop."""
        stop = self.next_stop(load)
        steps = math.ceil((stop - load) / self.value - _ROUNDING)
        return stop if steps <= 1 else load + (stop - load) / steps

    def next_stop(self, load: float) -> float:
        """The first stop beyond `load`."""
        return next(s for s in self.settings.stops if s > load + _ROUNDING)

    def restart(self, value: float) -> None:
        """Go on with steps of about this size, as on another path."""
        self.value = min(max(value, self.settings.min_step), self.settings.max_step)

    def finished(self, load: float) -> bool:
        """Whether `load` is the last stop."""
        return load >= self.settings.stops[-1] - _ROUNDING

    def accepted(self, iterations: int) -> None:
        """Adapt to a step that was accepted after so many iterations."""
        s = self.settings
        factor = s.target_iterations / max(iterations, 1)
        self.value *= min(max(factor, s.cutback), s.growth)
        self.value = min(max(self.value, s.min_step), s.max_step)

    def rejected(self, tried: float, smallest: float = 0.0) -> bool:
        """Cut back after a step of size `tried` failed; False when it was the smallest.

        That is `smallest`, if it is larger than the smallest step of the settings.
        """
        if tried <= max(smallest, self.settings.min_step) * (1 + _ROUNDING):
            return False
        self.value = max(tried * self.settings.cutback, self.settings.min_step)
        return True
