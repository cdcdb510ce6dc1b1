"""Load continuation: follow an equilibrium path from stop to stop.

It knows the problem by :class:`Equilibrium` alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..errors import PathError
from .predictor import PathPoint, PredictorName, predict
from .step_size import StepSettings, StepSize

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Correction:
    """Outcome of a corrector: the state where it converged, why not where it did not."""

    x: Array
    converged: bool
    iterations: int
    reason: str


@dataclass(frozen=True)
class Linearisation:
    """Tangent of the path at a state, and its inertia.

    `expected_negative_pivots` is what a stable state has; more of them, or zero pivots, mean
    that the energy is not at a minimum under the constraints.
    """

    rate: Array
    negative_pivots: int
    expected_negative_pivots: int
    zero_pivots: int

    @property
    def stable(self) -> bool:
        """Whether the state is a strict minimum of the energy."""
        return self.zero_pivots == 0 and self.negative_pivots == self.expected_negative_pivots


class Equilibrium(Protocol):
    """What continuation needs of a problem."""

    def correct(self, guess: Array, load: float) -> Correction:
        """Find the equilibrium near `guess`."""

    def linearise(self, x: Array, load: float) -> Linearisation:
        """Derivative of the path and inertia at an equilibrium."""


@dataclass(frozen=True)
class Step:
    """An accepted state; step 0 is the start."""

    number: int
    load: float
    x: Array
    iterations: int
    linearisation: Linearisation
    is_stop: bool


Rejected = Callable[[float, float, str], None]


def follow(
    problem: Equilibrium,
    start: Array,
    settings: StepSettings,
    predictor: PredictorName = "tangent",
    on_rejected: Rejected | None = None,
) -> Iterator[Step]:
    """Yield the states of a path as they are accepted, the start (load 0) first.

    A step that fails leaves no trace: the next try sets out from the last accepted state.
    `on_rejected` is told the load, the step and the reason.

    A long step may pass from a stable branch to an unstable one that is none of its
    continuation. So the first unstable state is accepted only after a step of at most
    `settings.critical_step`: then the path itself has lost stability.

    Raises
    ------
    PathError
        Where the smallest step fails too.
    """
    size = StepSize(settings)
    stops = set(settings.stops)
    at_start = problem.linearise(start, 0.0)
    yield Step(0, 0.0, start, 0, at_start, is_stop=False)
    points = [PathPoint(0.0, start, at_start.rate)]
    number = 0
    stable = at_start.stable
    while not size.finished(points[-1].load):
        last = points[-1].load
        load = size.next_load(last)
        correction = problem.correct(predict(predictor, points, load), load)
        if not correction.converged:
            if on_rejected is not None:
                on_rejected(load, load - last, correction.reason)
            if not size.rejected(load - last):
                raise PathError(_give_up(last, load, correction.reason))
            continue
        linearisation = problem.linearise(correction.x, load)
        if (
            stable
            and not linearisation.stable
            and size.rejected(load - last, settings.critical_step)
        ):
            if on_rejected is not None:
                on_rejected(load, load - last, "the state found is unstable")
            continue
        size.accepted(correction.iterations)
        stable = linearisation.stable
        number += 1
        points = [points[-1], PathPoint(load, correction.x, linearisation.rate)]
        yield Step(number, load, correction.x, correction.iterations, linearisation, load in stops)


def _give_up(last: float, load: float, reason: str) -> str:
    return (
        f"No equilibrium was found beyond load factor {last:.6g}: the smallest step, to "
        f"{load:.6g}, failed because {reason}. Every state up to {last:.6g} is saved. "
        "Try a smaller continuation.min_step, a larger continuation.max_iterations, "
        "or a finer mesh."
    )
