"""Load continuation: follow an equilibrium path from stop to stop.

It knows the problem by :class:`Equilibrium` alone, and where critical points are looked for by
:class:`ModalEquilibrium`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from .critical import CriticalPoint, JumpError
from .ending import elsewhere, linearise_first, no_way_on
from .equilibrium import (
    Array,
    Correction,
    Equilibrium,
    Linearisation,
    ModalEquilibrium,
)
from .instability import Change, OnInstability, critical_point, decide, leave
from .ladder import rescue
from .predictor import PathPoint, PredictorName, predict
from .step_size import StepSettings, StepSize
from .steps import Checkpoint, Step, accepted_step, critical_step, start_at

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
    at a bifurcation, along the stable path that branches off. Before a smallest step is given up,
    other ways to its end are tried, see :func:`pantograph_fem.solve.ladder.rescue`.

    Raises
    ------
    PathError
        Where the smallest step fails too, with a report; or no stable branch is found.
    """
    size = StepSize(settings, start.step_size)
    *earlier, here = start.points
    number, iterations = start.number, start.iterations
    linearisation = linearise_first(problem, here.x, here.load, watch)
    while True:
        here = PathPoint(here.load, linearisation.x, linearisation.rate)
        points = (*earlier[-1:], here)
        checkpoint = Checkpoint(points, number, iterations, size.value)
        yield accepted_step(checkpoint, linearisation, settings)
        if size.finished(here.load):
            return
        correction, new, point = _advance(
            problem, points, linearisation, size, predictor, on_rejected, watch
        )
        earlier = [here]
        if watch is not None and new.stable != linearisation.stable:
            change = Change(here.load, linearisation, correction.load, new)
            decision = decide(point, change, correction, on_instability, settings.stops)
            if decision is not None:
                point = decision.point
                number += 1
                yield critical_step(number, point, checkpoint, settings)
                if decision.ends or size.finished(point.load):
                    return
                if decision.leaves:
                    branch = leave(watch, point, size.next_stop(point.load))
                    correction, new = branch.correction, branch.linearisation
                    earlier = []
                    size.restart(correction.load - point.load)
        linearisation = new
        here = PathPoint(correction.load, linearisation.x)
        number, iterations = number + 1, correction.iterations
        size.accepted(iterations)


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
    before: Linearisation,
    size: StepSize,
    predictor: PredictorName,
    on_rejected: Rejected | None,
    watch: ModalEquilibrium | None,
) -> tuple[Correction, Linearisation, CriticalPoint | None]:
    """The next state that is accepted, and a critical point before it, after cut-backs."""
    last = points[-1].load
    while True:
        load = size.next_load(last)
        found = problem.correct(predict(predictor, points, load), load)
        if found.converged:
            new = problem.linearise(found.x, load)
            if new.stable == before.stable:
                return found, new, None
            if before.stable and size.rejected(load - last, size.settings.critical_step):
                if on_rejected is not None:
                    on_rejected(load, load - last, "the state found is unstable")
                continue
            if watch is None:
                return found, new, None
            try:
                change = Change(last, before, load, new)
                between = _between(watch, predictor, points, found)
                return found, new, critical_point(watch, change, between)
            except JumpError as error:
                found = elsewhere(found, str(error))
        if not size.rejected(load - last):
            rescued = rescue(watch, predictor, points, load, before.stable) if watch else None
            if rescued is None:
                raise no_way_on(points, load - last, found, watch)
            return *rescued, None
        if on_rejected is not None:
            on_rejected(load, load - last, found.reason)
