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

    load: float
    x: Array
    converged: bool
    iterations: int
    reason: str


@dataclass(frozen=True)
class Linearisation:
    """A state, the tangent of the path there, and its inertia.

    `x` is the state given, corrected once more.
    `expected_negative_pivots` is what a stable state has; more of them, or zero pivots, mean
    that the energy is not at a minimum under the constraints.
    """

    x: Array
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


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """All that the rest of a path depends on.

    Attributes
    ----------
    points
        The last one or two accepted states, the last one last.
    number, iterations
        Number of the last accepted step, and the iterations it took.
    step_size
        Size of the next step; None for the initial one of the settings.
    """

    points: tuple[PathPoint, ...]
    number: int = 0
    iterations: int = 0
    step_size: float | None = None


def start_at(x: Array) -> Checkpoint:
    """The beginning of a path at a state that is in equilibrium at load 0."""
    return Checkpoint((PathPoint(0.0, x),))


@dataclass(frozen=True, eq=False)
class Step:
    """An accepted state; step 0 is the start. From `checkpoint` the path can be taken up again."""

    number: int
    load: float
    x: Array
    iterations: int
    linearisation: Linearisation
    is_stop: bool
    checkpoint: Checkpoint


Rejected = Callable[[float, float, str], None]


def follow(
    problem: Equilibrium,
    start: Checkpoint,
    settings: StepSettings,
    predictor: PredictorName = "tangent",
    on_rejected: Rejected | None = None,
) -> Iterator[Step]:
    """Yield the states of a path as they are accepted, the last one of `start` first.

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
    size = StepSize(settings, start.step_size)
    *earlier, here = start.points
    number, iterations = start.number, start.iterations
    linearisation = problem.linearise(here.x, here.load)
    while True:
        here = PathPoint(here.load, linearisation.x, linearisation.rate)
        points = (*earlier[-1:], here)
        yield Step(
            number,
            here.load,
            here.x,
            iterations,
            linearisation,
            here.load in settings.stops,
            Checkpoint(points, number, iterations, size.value),
        )
        if size.finished(here.load):
            return
        correction, linearisation = _advance(
            problem, points, size, predictor, linearisation.stable, on_rejected
        )
        earlier, here = [here], PathPoint(correction.load, correction.x)
        number, iterations = number + 1, correction.iterations
        size.accepted(iterations)


def _advance(
    problem: Equilibrium,
    points: tuple[PathPoint, ...],
    size: StepSize,
    predictor: PredictorName,
    stable: bool,
    on_rejected: Rejected | None,
) -> tuple[Correction, Linearisation]:
    """The next state that is accepted, after as many cut-backs as it takes."""
    last = points[-1].load
    while True:
        load = size.next_load(last)
        correction = problem.correct(predict(predictor, points, load), load)
        if correction.converged:
            linearisation = problem.linearise(correction.x, load)
            lost = stable and not linearisation.stable
            if not (lost and size.rejected(load - last, size.settings.critical_step)):
                return correction, linearisation
        elif not size.rejected(load - last):
            raise PathError(_give_up(last, load, correction.reason))
        if on_rejected is not None:
            reason = "the state found is unstable" if correction.converged else correction.reason
            on_rejected(load, load - last, reason)


def _give_up(last: float, load: float, reason: str) -> str:
    return (
        f"No equilibrium was found beyond load factor {last:.6g}: the smallest step, to "
        f"{load:.6g}, failed because {reason}. Every state up to {last:.6g} is saved. "
        "Try a smaller continuation.min_step, a larger continuation.max_iterations, "
        "or a finer mesh."
    )
