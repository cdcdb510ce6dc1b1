r"""The error that is left in a number, from its values on successive meshes.

With the unknowns N an error falls as :math:`C N^{-r}`. The last difference then tells the last
error,

.. math:: e_n = \frac{\|q_n - q_{n-1}\|}{(N_n/N_{n-1})^r - 1}

The energy of a scheme of order p on meshes that suit it has r = p. A lower rate is taken, so that
the estimate is rather too large: the one at which the last two differences fall, within bounds. Of
two meshes alone, of a high order, no more is assumed than the rate of what is not smooth: the
corners, whose elements shrink by a bounded ratio from mesh to mesh, and the kinks of the pivots.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

Array = NDArray[np.float64]

#: Rates over the order p: the lowest and highest believed, and that of two meshes alone.
SLOWEST, FASTEST, ASSUMED = 0.25, 0.7, 0.625
#: Orders from which on errors of what is not smooth count, and their rate. The lowest rate
#: believed is no more than half of it.
HIGH, ROUGH = 2.0, 1.0
#: How much more a difference may fall than at the highest rate before chance is suspected.
_LUCK = 1.5


def remaining_error(dofs: Sequence[int], values: Sequence[Sequence[float]], order: float) -> float:
    """Estimate of the norm of the error of the last value; infinite for a single one.

    Parameters
    ----------
    dofs
        Increasing numbers of unknowns of the meshes, shape (n,).
    values
        The quantity on each mesh, shape (n, components).
    order
        Order p of the scheme in energy norm.
    """
    if len(dofs) < 2:
        return math.inf
    N = np.asarray(dofs, dtype=float)
    differences = np.linalg.norm(np.diff(np.asarray(values, dtype=float), axis=0), axis=1)
    rate = observed_rate(N, differences, order)
    last = differences[-1]
    if len(differences) > 1:
        # Errors that happen to cancel in one difference were there in the one before.
        expected = differences[-2] * _fall(N, FASTEST * order)
        last = max(last, expected / _LUCK)
    return float(last / ((N[-1] / N[-2]) ** rate - 1.0))


def observed_rate(N: Array, differences: Array, order: float) -> float:
    """Rate r at which the last two differences fall, between those that are believed."""
    low, high = min(SLOWEST * order, ROUGH / 2), FASTEST * order
    if len(differences) < 2:
        return assumed_rate(order)
    before, last = differences[-2:]

    def excess(rate: float) -> float:
        return float(before * _fall(N, rate) - last)

    if excess(high) >= 0.0:  # the differences fall even faster
        return high
    if excess(low) <= 0.0:
        return low
    return float(brentq(excess, low, high))


def assumed_rate(order: float) -> float:
    """Rate r that is taken where nothing is known of it."""
    return ROUGH if order > HIGH else ASSUMED * order


def next_growth(error: float, wanted: float, order: float, bounds: tuple[float, float]) -> float:
    """Growth of the number of cells with which an error is expected to fall to `wanted`."""
    if not math.isfinite(error):
        return bounds[0]
    ratio = (error / wanted) ** (1.0 / assumed_rate(order)) if wanted > 0.0 else math.inf
    return min(max(ratio, bounds[0]), bounds[1])


def _fall(N: Array, rate: float) -> float:
    """Last difference over the one before, for errors of the form C N^-rate."""
    powers = N[-3:] ** -rate
    return float((powers[1] - powers[2]) / (powers[0] - powers[1]))
