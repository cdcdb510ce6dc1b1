"""How a path ends that could not be followed to its last stop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..errors import PathError
from .advice import advise
from .cause import Cause
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
    remedies = Remedies()
    if problem is not None:
        diagnosis = problem.diagnose(here.x, here.load, failed)
        turns = None if along_arc else limit_load(problem, points, step)
        report = replace(report, diagnosis=diagnosis, turns_back_at=turns)
        remedies = problem.remedies
    report = replace(report, advice=advise(report, remedies))
    return PathError(report.message, report)


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
        report = FailureReport(load, load, 0.0, Cause.SINGULAR, reason)
        advice = advise(report, Remedies() if watch is None else watch.remedies)
        raise PathError(f"{error} Try {advice}.", replace(report, advice=advice)) from None


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
