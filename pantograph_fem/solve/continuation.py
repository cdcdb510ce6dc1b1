"""Load continuation: follow an equilibrium path from stop to stop.

It knows the problem by :class:`Equilibrium` alone, and where critical points are looked for by
:class:`ModalEquilibrium`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from .critical import Change, CriticalPoint, JumpError, locate
from .ending import elsewhere, linearise_first, no_way_on, without_factor
from .equilibrium import (
    Array,
    Correction,
    Equilibrium,
    Linearisation,
    ModalEquilibrium,
)
from .factorisation import SingularTangentError
from .instability import OnInstability, pass_critical
from .ladder import rescue
from .predictor import PathPoint, PredictorName, predict
from .step_size import StepSettings, StepSize
from .steps import Checkpoint, Step, accepted_step, start_at

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

    With `watch`, the same problem, critical points are located wherever the number of unstable
    modes changes, and each is a step of its own. Where stability is lost, `on_instability` says
    whether to "follow" the path, to "stop", or to "branch": to go on, at a bifurcation, along the
    stable path that branches off. Before a smallest step is given up, other ways to its end are
    tried, see :func:`pantograph_fem.solve.ladder.rescue`.

    Raises
    ------
    PathError
        Where the smallest step fails too, or no stable branch is found; with a report.
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
        correction, new, critical = _advance(
            problem, points, linearisation, size, predictor, on_rejected, watch
        )
        earlier = [here]
        if watch is not None and new.unstable_modes != linearisation.unstable_modes:
            change = Change(here.load, linearisation, correction.load, new)
            passage = yield from pass_critical(
                watch, critical, change, correction, checkpoint, size, on_instability
            )
            if passage.ended:
                return
            number = passage.number
            if passage.left is not None:
                point, branch = passage.left
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
) -> tuple[Correction, Linearisation, tuple[CriticalPoint, ...]]:
    """The next state that is accepted, and the critical points before it, after cut-backs."""
    last = points[-1].load

    def critical(found: Correction, new: Linearisation) -> tuple[CriticalPoint, ...]:
        if watch is None or new.unstable_modes == before.unstable_modes:
            return ()
        change = Change(last, before, found.load, new)
        return locate(watch, change, _between(watch, predictor, points, found))

    while True:
        load = size.next_load(last)
        found = problem.correct(predict(predictor, points, load), load)
        if found.converged:
            try:
                new = problem.linearise(found.x, load)
                lost = before.stable and not new.stable
                if lost and size.rejected(load - last, size.settings.critical_step):
                    if on_rejected is not None:
                        on_rejected(load, load - last, "the state found is unstable")
                    continue
                return found, new, critical(found, new)
            except JumpError as error:
                found = elsewhere(found, str(error))
            except SingularTangentError:
                found = without_factor(found)
        if not size.rejected(load - last):
            rescued = rescue(watch, predictor, points, load, before.stable) if watch else None
            if rescued is None:
                raise no_way_on(points, load - last, found, watch)
            try:
                return *rescued, critical(*rescued)
            except JumpError as error:
                found = elsewhere(rescued[0], str(error))
                raise no_way_on(points, load - last, found, watch) from None
        if on_rejected is not None:
            on_rejected(load, load - last, found.reason)
