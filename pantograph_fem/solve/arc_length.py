"""Pseudo-arc-length continuation: follow a path through points where the load turns back."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from .arc import Arc, Parabola, Point
from .continuation import Rejected
from .critical import Change, CriticalPoint, JumpError, locate
from .ending import elsewhere, linearise_first, no_way_on, too_many_steps, without_factor
from .equilibrium import Array, Correction, Linearisation, ModalEquilibrium
from .factorisation import SingularTangentError
from .instability import OnInstability, pass_critical
from .origin import Origin
from .predictor import PathPoint
from .step_size import StepSettings, StepSize
from .steps import Checkpoint, Step, accepted_step

#: Share of a step by which its end may miss what the tangent predicts. Farther away are states
#: of other paths, or the path turns too sharply for the step.
_MISS = 0.5


def follow_arc_length(
    problem: ModalEquilibrium,
    start: Checkpoint,
    settings: StepSettings,
    rest: Array,
    max_steps: int = 1000,
    on_rejected: Rejected | None = None,
    on_instability: OnInstability = "follow",
) -> Iterator[Step]:
    """Yield the states of a path as they are accepted, the last one of `start` first.

    The path begins with rising loads. Step sizes are lengths of :class:`Arc`. Wherever the path
    rises past a stop, the state at the stop is found by load control; the last stop ends the path.
    Critical points are located wherever the number of unstable modes changes, see
    :func:`pantograph_fem.solve.continuation.follow`. `rest` is the state at load 0.

    Raises
    ------
    PathError
        Where the smallest step fails too; where no branch is found; or where `max_steps` are done
        before the last stop is reached. With a report.
    """
    size = StepSize(settings, start.step_size)
    arc = Arc.from_rest(problem, rest)
    points, number, iterations = start.points[-2:], start.number, start.iterations
    linearisation = linearise_first(problem, points[-1].x, points[-1].load, problem)
    while True:
        here = PathPoint(points[-1].load, linearisation.x, linearisation.rate)
        points = (*points[:-1], here)
        checkpoint = Checkpoint(points, number, iterations, size.value)
        yield accepted_step(checkpoint, linearisation, settings)
        if size.finished(here.load):
            return
        if number >= max_steps:
            raise too_many_steps(problem, here, number, max_steps, size.value)
        before = here
        end, new, critical = _advance(arc, points, linearisation, size, on_rejected)
        if new.unstable_modes != linearisation.unstable_modes:
            change = Change(here.load, linearisation, end.load, new)
            passage = yield from pass_critical(
                problem, critical, change, end, checkpoint, size, on_instability, upwards=False
            )
            if passage.ended:
                return
            number = passage.number
            if passage.left is not None:
                point, branch = passage.left
                end, new = branch.correction, branch.linearisation
                before = PathPoint(point.load, point.x, point.linearisation.rate)
                size.restart(arc.length(new.x - point.x, end.load - point.load))
        linearisation = new
        points = (before, PathPoint(end.load, new.x, new.rate))
        number, iterations = number + 1, end.iterations
        size.accepted(iterations)


def _advance(
    arc: Arc,
    points: tuple[PathPoint, ...],
    linearisation: Linearisation,
    size: StepSize,
    on_rejected: Rejected | None,
) -> tuple[Correction, Linearisation, tuple[CriticalPoint, ...]]:
    """The next state that is accepted, and the critical points before it, after cut-backs."""
    here = points[-1]
    ahead = Parabola.through(arc, points, linearisation.rate)
    while True:
        step = size.value
        found = _try(arc, ahead, step, size.next_stop(here.load), size.settings.min_step)
        if found.converged:
            try:
                new = arc.problem.linearise(found.x, found.load)
                if new.unstable_modes == linearisation.unstable_modes:
                    return found, new, ()
                change = Change(here.load, linearisation, found.load, new)
                length = arc.length(new.x - here.x, found.load - here.load)
                between = _between(arc, here, found)
                return found, new, locate(arc.problem, change, between, length)
            except JumpError as error:
                found = elsewhere(found, str(error))
            except SingularTangentError:
                found = without_factor(found)
        if on_rejected is not None:
            on_rejected(ahead.at(step).load, step, found.reason)
        if not size.rejected(step):
            raise no_way_on(points, step, found, arc.problem, along_arc=True)


def _try(arc: Arc, ahead: Parabola, step: float, stop: float, least: float) -> Correction:
    reach = ahead.reaching(stop, step)
    if reach == step:
        point = ahead.at(step)
        found = arc.problem.correct_on_plane(arc.plane(point, ahead.tangent, ahead.origin(step)))
        found = _unless_far(arc, found, point, step)
        if not found.converged or found.load < stop:
            return found
    # The stop lies within the step.
    point = ahead.at(reach)
    return _unless_far(arc, arc.problem.correct(point.x, stop), point, max(reach, least))


def _unless_far(arc: Arc, found: Correction, expected: Point, step: float) -> Correction:
    """The state found if it is near the one expected."""
    away = arc.length(found.x - expected.x, found.load - expected.load)
    if not found.converged or away <= _MISS * step:
        return found
    return elsewhere(found, "the state found is too far from where the path was heading")


def _between(arc: Arc, here: PathPoint, end: Correction) -> Callable[[float], Correction]:
    """States of the path on planes across the chord between two of its states."""
    chord = Point(end.x - here.x, end.load - here.load)

    def state_at(way: float) -> Correction:
        step = way * chord.x
        point = Point(here.x + step, here.load + way * chord.load)
        return arc.problem.correct_on_plane(arc.plane(point, chord, Origin(here.x, step)))

    return state_at
