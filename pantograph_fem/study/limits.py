"""What series of meshes tend to."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..compare.orders import Limit, orders_of_values, richardson_limit
from ..compare.outcome import Outcome
from ..compare.quantities import FORCE, values
from .measurement import Measurement
from .sizes import in_proportion

NAN = float("nan")

#: What accuracy is measured in.
QUANTITIES = (FORCE, "energy")

#: Loads that differ by less are the same.
_SAME_LOAD = 1e-9

#: Orders below this are too slow, and those that change by more than this factor too unsettled, for
#: a limit to be taken from them.
_SLOWEST, _UNSETTLED = 0.5, 1.5


@dataclass(frozen=True)
class SeriesLimit:
    """What a series of meshes tends to; `error` is relative to the reference, without sign."""

    series: str
    quantity: str
    limit: Limit
    error: float = NAN


def at_full_load(run: Measurement, quantity: str) -> float:
    """Value of a quantity at the last stop; NaN for a run that did not reach it."""
    return at_load(run.outcome, quantity, 1.0) if run.done else NAN


def at_load(outcome: Outcome | None, quantity: str, load: float) -> float:
    """Value of a quantity at a load; NaN where there is no state."""
    column = None if outcome is None else values(outcome, quantity)
    if outcome is None or column is None:
        return NAN
    found = np.flatnonzero(np.abs(outcome.history["load"] - load) < _SAME_LOAD)
    return float(column[found[-1]]) if len(found) else NAN


def series_limits(
    runs: Sequence[Measurement], matrix: Sequence[int], reference: Measurement | None
) -> dict[tuple[str, str], SeriesLimit]:
    """Limits by series and quantity, of the finished runs of each series.

    Parameters
    ----------
    runs, matrix
        As in `assess`.
    reference
        What the errors of the limits are taken against, if anything.
    """
    limits = {}
    for series in dict.fromkeys(runs[i].variant.series for i in matrix):
        members = [runs[i] for i in matrix if runs[i].variant.series == series and runs[i].done]
        sizes = [run.variant.sizes for run in members]
        # one size stands for the mesh only where all are refined alike
        if not in_proportion(sizes):
            continue
        h = np.array([s.size for s in sizes])
        for quantity in QUANTITIES:
            limit = settled_limit(h, np.array([at_full_load(run, quantity) for run in members]))
            if limit is not None:
                error = NAN
                if reference is not None:
                    exact = at_full_load(reference, quantity)
                    error = abs(limit.value / exact - 1) if exact else math.nan
                limits[series, quantity] = SeriesLimit(series, quantity, limit, error)
    return limits


def settled_limit(sizes: NDArray[np.float64], numbers: NDArray[np.float64]) -> Limit | None:
    """Richardson's limit of a series, where its order has settled.

    The order must be 0.5 or more, and within a factor of 1.5 of that one mesh earlier, where there
    are four meshes or more.

    Parameters
    ----------
    sizes
        Positive, decreasing, shape (n,).
    numbers
        Values, shape (n,).
    """
    limit = richardson_limit(sizes, numbers)
    if limit is None or limit.order < _SLOWEST or limit.value == 0:
        return None
    if len(sizes) > 3:
        before = orders_of_values(sizes, numbers)[-2]
        if not limit.order / _UNSETTLED <= before <= limit.order * _UNSETTLED:
            return None
    return limit
