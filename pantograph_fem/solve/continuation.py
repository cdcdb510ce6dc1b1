"""Load continuation: follow an equilibrium path from stop to stop.

It knows the problem by :class:`Equilibrium` alone, and where critical points are looked for by
:class:`ModalEquilibrium`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass

from ..errors import PathError
from .critical import CriticalPoint, JumpError
from .equilibrium import (
    Array,
    Correction,
    Equilibrium,
    Linearisation,
    ModalEquilibrium,
)
from .instability import Change, OnInstability, critical_point, leave
from .predictor import PathPoint, PredictorName, predict
from .step_size import StepSettings, StepSize

__all__ = [
    "Array",
    "Checkpoint",
    "Correction",
    "Equilibrium",
    "Linearisation",
    "Step",
    "follow",
    "start_at",
]


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
    """An accepted state; step 0 is the start.

    From `checkpoint` the path can be taken up again. That of a critical state, which has
    `critical`, is the one of the state before it.
    """

    number: int
    load: float
    x: Array
    iterations: int
    linearisation: Linearisation
    is_stop: bool
    checkpoint: Checkpoint
    critical: CriticalPoint | None = None


Rejected = Callable[[float, float, str], None]


def follow(
    problem: Equilibrium,
    start: Checkpoint,
    settings: StepSettings,
    predictor: PredictorName = "tangent",
    on_rejected: Rejected | None = None,
    watch: ModalEquilibrium | None = None,
    on_instability: OnInstability = "follow",
) -> Iterator[Step]:
    """Yield the states of a path as they are accepted, the last one of `start` first.

    A step that fails leaves no trace: the next try sets out from the last accepted state.
    `on_rejected` is told the load, the step and the reason.

    A long step may pass from a stable branch to an unstable one that is none of its
    continuation. So the first unstable state is accepted only after a step of at most
    `settings.critical_step`: then the path itself has lost stability.

    With `watch`, the same problem, the critical point is then located, and is a step of its own.
    There `on_instability` says whether to "follow" the path, to "stop", or to "branch": to go on,
    at a bifurcation, along the stable path that branches off.

    Raises
    ------
    PathError
        Where the smallest step fails too, or no stable branch is found.
    """
    size = StepSize(settings, start.step_size)
    *earlier, here = start.points
    number, iterations = start.number, start.iterations
    linearisation = problem.linearise(here.x, here.load)
    while True:
        here = PathPoint(here.load, linearisation.x, linearisation.rate)
        points = (*earlier[-1:], here)
        checkpoint = Checkpoint(points, number, iterations, size.value)
        yield Step(
            number,
            here.load,
            here.x,
            iterations,
            linearisation,
            here.load in settings.stops,
            checkpoint,
        )
        if size.finished(here.load):
            return
        correction, new = _advance(
            problem, points, size, predictor, linearisation.stable, on_rejected
        )
        earlier = [here]
        if watch is not None and new.stable != linearisation.stable:
            change = Change(here.load, linearisation, correction.load, new)
            between = _between(watch, predictor, points, correction)
            point = None
            with suppress(JumpError):  # it was as small a step as there is
                point = critical_point(watch, change, between)
            if point is not None:
                number += 1
                yield critical_step(number, point, checkpoint)
                if change.lost and on_instability == "stop":
                    return
                if change.lost and on_instability == "branch" and point.kind == "bifurcation":
                    branch = leave(watch, point, size.next_stop(point.load))
                    correction, new = branch.correction, branch.linearisation
                    earlier = []
                    size.restart(correction.load - point.load)
        linearisation = new
        here = PathPoint(correction.load, linearisation.x)
        number, iterations = number + 1, correction.iterations
        size.accepted(iterations)


def critical_step(number: int, point: CriticalPoint, checkpoint: Checkpoint) -> Step:
    """A critical point as a step."""
    return Step(
        number,
        point.load,
        point.x,
        point.iterations,
        point.linearisation,
        False,
        checkpoint,
        point,
    )


def _between(
    problem: Equilibrium,
    predictor: PredictorName,
    points: tuple[PathPoint, ...],
    end: Correction,
) -> Callable[[float], Correction]:
    """States at fractions of the load step from the last of `points` to `end`."""
    first = points[-1].load

    def state_at(way: float) -> Correction:
        load = first + way * (end.load - first)
        return problem.correct(predict(predictor, points, load), load)

    return state_at


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
        'or a finer mesh; where the path turns back, continuation.method = "arc_length".'
    )
