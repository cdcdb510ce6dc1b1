"""One setting to try where a path ends, by the cause."""

from __future__ import annotations

from .cause import Cause
from .failure import FailureReport, Remedies

#: A smallest step above this may still be too long.
_LONG = 1e-4
#: Share of its first value to which a residual has fallen that was about to vanish.
_FALLEN = 0.1


def advise(report: FailureReport, remedies: Remedies) -> str:
    """The setting that the cause asks for; the first of these that applies.

    The steps ran out: more or longer ones. A critical point is not what was asked for: to follow
    the path. The load turns back: steps along the arc. The tangent has no factor: an effect that
    resists. Newton's method was about to arrive: more iterations. The body folds: no more motion.
    Even the smallest step is long: a smaller one. What is left is a mesh too coarse for the state.
    """
    if report.cause is Cause.STEPS:
        return "a larger continuation.max_steps or continuation.max_step"
    if report.cause is Cause.NO_MODE:
        return f'{remedies.finer}, or continuation.on_instability = "follow"'
    if report.cause is Cause.NO_BRANCH:
        return 'continuation.on_instability = "follow" or "stop"'
    if report.turns_back_at is not None:
        return 'continuation.method = "arc_length"'
    singular = report.cause is Cause.SINGULAR
    if remedies.missing and (singular or report.diagnosis.zero_pivots):
        return f"an effect that resists what nothing does now: {' or '.join(remedies.missing)}"
    if singular:
        return "a coarser mesh, as memory may have run out"
    if report.cause is Cause.ITERATIONS and _falling(report.residuals):
        return "a larger continuation.max_iterations"
    if report.cause is Cause.OBJECTION:
        return f"a motion that ends before that load, or {remedies.finer}"
    if report.step > _LONG:
        return "a smaller continuation.min_step"
    return remedies.finer


def _falling(residuals: tuple[float, ...]) -> bool:
    return len(residuals) > 1 and residuals[-1] < min(_FALLEN * residuals[0], residuals[-2])
