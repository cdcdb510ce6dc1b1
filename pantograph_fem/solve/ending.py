"""How a path ends that could not be followed to its last stop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..errors import PathError
from .advice import advise
from .cause import Cause
from .critical import Change, CriticalPoint
from .equilibrium import Array, Correction, Equilibrium, Linearisation, ModalEquilibrium
from .factorisation import SingularTangentError
from .failure import FailureReport, Remedies
from .predictor import PathPoint

#: A load that cannot be passed lies within so many of the step that failed.
_WITHIN_STEPS = 3.0


def no_way_on(
    points: Sequence[PathPoint],
    step: float,
    failed: Correction,
    problem: ModalEquilibrium | None,
    along_arc: bool = False,
) -> PathError:
    """The error with which a path ends.

    Parameters
    ----------
    points
        The last accepted states, the last one last.
    step
        The smallest step.
    failed
        What came of it.
    problem
        Tells more, if it is there. It is not asked on paths that nobody reads about.
    along_arc
        Whether steps are lengths of an arc, which pass points where the load turns back.
    """
    here = points[-1]
    report = FailureReport(
        here.load, failed.load, step, failed.cause or Cause.STALLED, failed.reason, failed.residuals
    )
    if problem is not None:
        diagnosis = problem.diagnose(here.x, here.load, failed)
        turns = None if along_arc else limit_load(problem, points, step)
        report = replace(report, diagnosis=diagnosis, turns_back_at=turns)
    return _error(report, problem)


def too_many_steps(
    problem: ModalEquilibrium, here: PathPoint, number: int, most: int, step: float
) -> PathError:
    """The error with which a path ends that took so many steps and may take no more than `most`.

    `step` is the one that would have been next.
    """
    reason = f"{number} steps were taken, and continuation.max_steps is {most}"
    return _at_a_state(
        problem,
        (here.load, here.x),
        FailureReport(
            here.load,
            here.load,
            step,
            Cause.STEPS,
            reason,
            sentence=f"The path was at load factor {here.load:.6g} after {number} steps, and had "
            f"not come to the full load; continuation.max_steps is {most}. Every state is saved.",
        ),
    )


def no_mode(problem: ModalEquilibrium, change: Change) -> PathError:
    """The error with which a path ends where something is wanted at a point that has no mode."""
    return _at_a_state(
        problem,
        (change.load, change.first.x),
        FailureReport(
            change.load,
            change.next_load,
            change.next_load - change.load,
            Cause.NO_MODE,
            "no mode was found by which to locate the critical point",
            sentence=f"The path loses stability between load factors {change.load:.9g} and "
            f"{change.next_load:.9g}, and no mode was found there by which to locate the critical "
            "point. Every state up to there is saved.",
        ),
    )


def no_branch(problem: ModalEquilibrium, point: CriticalPoint, upwards: bool) -> PathError:
    """The error with which a path ends that was to be left at a bifurcation.

    With `upwards` for a branch that rises, which along an arc it need not.
    """
    missing, at, there = "no branch was found", "at", "there"
    if upwards:
        missing, at, there = "no stable branch was found to rise", "from", "from there"
    return _at_a_state(
        problem,
        (point.load, point.x),
        FailureReport(
            point.load,
            point.load,
            0.0,
            Cause.NO_BRANCH,
            f"{missing} {at} the bifurcation",
            sentence=f"The path loses stability at load factor {point.load:.9g}, and {missing} "
            f"{there}. Every state up to there is saved.",
        ),
        ', or continuation.method = "arc_length"' if upwards else "",
    )


def linearise_first(
    problem: Equilibrium, x: Array, load: float, watch: ModalEquilibrium | None
) -> Linearisation:
    """The linearisation at the start of a path.

    Raises
    ------
    PathError
        If there is none, as nothing resists some motion.
    """
    try:
        return problem.linearise(x, load)
    except SingularTangentError as error:
        reason = "the tangent there has no factor"
        report = FailureReport(load, load, 0.0, Cause.SINGULAR, reason, sentence=str(error))
        raise _error(report, watch) from None


def limit_load(problem: ModalEquilibrium, points: Sequence[PathPoint], step: float) -> float | None:
    r"""Load near which a path seems to turn back: close ahead of the last point, or None.

    Towards a limit point t* the rate grows as :math:`|x'| \propto (t^*-t)^{-1/2}`, so that
    :math:`|x'|^{-2}` of two states in a row falls to zero there on a line.
    """
    rates = [point.rate for point in points[-2:] if point.rate is not None]
    if len(rates) < 2:
        return None
    first, last = (1.0 / max(problem.inner(rate, rate), 1e-300) for rate in rates)
    if not last < first:
        return None
    ahead = last * (points[-1].load - points[-2].load) / (first - last)
    return points[-1].load + ahead if 0.0 <= ahead <= _WITHIN_STEPS * step else None


def elsewhere(found: Correction, reason: str) -> Correction:
    """A state that is none of the path that is followed, as a failure."""
    return replace(found, converged=False, reason=reason, cause=Cause.ELSEWHERE)


def without_factor(found: Correction) -> Correction:
    """A state whose tangent has no factor, as a failure."""
    reason = "the tangent at the state found has no factor"
    return replace(found, converged=False, reason=reason, cause=Cause.SINGULAR)


def _at_a_state(
    problem: ModalEquilibrium,
    state: tuple[float, Array],
    report: FailureReport,
    more_advice: str = "",
) -> PathError:
    """Where the path ends at an equilibrium: there is no residual to look into."""
    load, x = state
    known = problem.diagnose(x, load, Correction(load, x, True, 0, ""))
    known = replace(known, worst_residual=None, worst_at="")
    return _error(replace(report, diagnosis=known), problem, more_advice)


def _error(
    report: FailureReport, problem: ModalEquilibrium | None, more_advice: str = ""
) -> PathError:
    """With the advice that goes with the report."""
    remedies = Remedies() if problem is None else problem.remedies
    report = replace(report, advice=advise(report, remedies) + more_advice)
    return PathError(report.message, report)
