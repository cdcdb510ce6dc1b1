"""Errors of the runs of a study: against a reference, and against the limits of their series."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..compare.quantities import FORCE, is_negligible
from .limits import NAN, QUANTITIES, SeriesLimit, at_full_load, at_load, series_limits
from .measurement import Measurement

#: Components that are reported beside the magnitude of the force.
COMPONENTS = ("force_x", "force_y")

#: A step of a series larger than the one before by this factor, and larger than what comes of
#: tolerances, is no sign of convergence.
_OFF_SERIES, _SMALL = 10.0, 1e-6


@dataclass(frozen=True)
class Error:
    """Errors of a quantity of a run, all relative and without sign; NaN where not known.

    Attributes
    ----------
    last
        At full load, over the magnitude of the reference there; for a component of the force over
        the magnitude of the force.
    largest
        The largest at any stop, over the largest magnitude of the reference at a stop.
    to_limit
        At full load against the limit of the run's own series.
    """

    last: float = NAN
    largest: float = NAN
    to_limit: float = NAN


@dataclass(frozen=True, eq=False)
class Accuracy:
    """Errors of all runs of a study.

    Attributes
    ----------
    errors
        By number of the run and quantity.
    limits
        By series and quantity, where the series converges.
    reference
        The run that errors are taken against; None where they are to the limits alone.
    uncertainty
        By quantity: relative difference of the reference and the next finest run.
    off_series
        Quantities by which the reference differs from the next finest run by far more than that
        from the one before it: it may lie on another branch of equilibria.
    """

    errors: dict[tuple[int, str], Error]
    limits: dict[tuple[str, str], SeriesLimit]
    reference: Measurement | None = None
    uncertainty: dict[str, float] = field(default_factory=dict)
    off_series: tuple[str, ...] = ()

    def error(self, number: int, quantity: str) -> float:
        """Error at full load: against the reference, or the limit of the series without one."""
        found = self.errors.get((number, quantity), Error())
        return found.to_limit if self.reference is None else found.last


def assess(
    runs: Sequence[Measurement], matrix: Sequence[int], reference: Measurement | None
) -> Accuracy:
    """Take the errors of runs that reached full load; those of others stay unknown.

    Parameters
    ----------
    runs
        All runs.
    matrix
        Numbers of those in the matrix of schemes, degrees and meshes, each series coarsest first.
    reference
        What errors are taken against, if anything.
    """
    if reference is not None and not reference.done:
        # the most accurate that there is
        reference = next(iter(_most_accurate(runs[i] for i in matrix)), None)
    limits = series_limits(runs, matrix, reference)
    errors = {
        (i, quantity): _error(run, quantity, reference, limits)
        for i, run in enumerate(runs)
        if run.done and run is not reference
        for quantity in (*QUANTITIES, *COMPONENTS)
    }
    if reference is None:
        return Accuracy(errors, limits)
    nearest = _most_accurate(
        run
        for run in (runs[i] for i in matrix)
        if run is not reference and run.variant.scheme == reference.variant.scheme
    )[:2]
    uncertainty, off_series = {}, []
    for quantity in QUANTITIES:
        found = [_error(run, quantity, reference, {}).last for run in nearest]
        uncertainty[quantity] = found[0] if found else NAN
        if len(found) == 2:
            step = _error(nearest[1], quantity, nearest[0], {}).last
            if found[0] > max(_OFF_SERIES * step, _SMALL):
                off_series.append(quantity)
    return Accuracy(errors, limits, reference, uncertainty, tuple(off_series))


def error_text(error: float, digits: int = 1) -> str:
    """Write an error, such as "1.2e-4"; a dash where it is not known."""
    if math.isnan(error) or not error:
        return "–" if error else "0"
    return re.sub(r"e([-+])0", r"e\1", f"{error:.{digits}e}")


def _most_accurate(runs: Iterable[Measurement]) -> list[Measurement]:
    """Finished runs, of the highest degree and finest mesh first."""
    done = [run for run in runs if run.done]
    return sorted(done, key=lambda run: (-(run.variant.degree or 0), run.variant.sizes.size))


def _error(
    run: Measurement,
    quantity: str,
    reference: Measurement | None,
    limits: dict[tuple[str, str], SeriesLimit],
) -> Error:
    last = largest = to_limit = NAN
    if (found := limits.get((run.variant.series, quantity))) and not run.variant.key:
        to_limit = abs(at_full_load(run, quantity) / found.limit.value - 1)
    if reference is None or run.outcome is None or reference.outcome is None:
        return Error(last, largest, to_limit)
    norm = FORCE if quantity in COMPONENTS else quantity
    stops = run.outcome.case.continuation.stops
    ours, theirs, norms = (
        np.array([at_load(outcome, name, stop) for stop in stops])
        for outcome, name in (
            (run.outcome, quantity),
            (reference.outcome, quantity),
            (reference.outcome, norm),
        )
    )
    differences = np.abs(ours - theirs)
    if not is_negligible(norms[-1], reference.outcome, norm):
        last = float(differences[-1] / abs(norms[-1]))
    known = np.isfinite(differences)
    scale = float(np.abs(norms[known]).max(initial=0.0))
    if scale > 0 and not is_negligible(scale, reference.outcome, norm):
        largest = float(differences[known].max() / scale)
    return Error(last, largest, to_limit)
