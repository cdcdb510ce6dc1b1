r"""Which further measurement would tell a constant that the data do not.

A measured column c with the standard error σ at all loads adds :math:`\mathbf G_c^\mathsf T
\mathbf G_c/\sigma^2` to the information :math:`\mathbf J^\mathsf T\mathbf J` of the data, with G
its derivatives, which are known for all columns of the case.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from .data import Observations
from .estimates import Estimate
from .fit import Fit, covariance_of

Array = NDArray[np.float64]

#: Standard error of a coordinate, such as ln K, that is asked for.
_WANTED = 0.1
#: Standard errors that are tried, as shares of the range of the readings.
_RANGE = (1e-5, 1.0)


@dataclass(frozen=True)
class Advice:
    """A measurement that would tell a constant: its column, and the standard error needed."""

    column: str
    error: float
    share: float


def advice(
    fit: Fit, observations: Observations, columns: Sequence[str], number: int
) -> Advice | None:
    """The column, not yet measured, that is allowed the largest error relative to its range.

    `number` is that of the constant. None where no column would do.
    """
    used = set(observations.column.tolist())
    found: list[Advice] = []
    for c, column in enumerate(columns):
        readings = fit.path.values[:, c]
        reach = float(np.ptp(readings) if len(readings) > 1 else np.abs(readings).max())
        if c in used or reach < 1e-9:
            continue
        share = _share(fit.jacobian, fit.path.slopes[:, c] / reach, number)
        if share is not None:
            found.append(Advice(column, share * reach, share))
    return max(found, key=lambda one: one.share, default=None)


def advice_sentence(estimate: Estimate, one: Advice, unit: str) -> str:
    """What to measure."""
    error = f"{one.error:.2g} {unit}".rstrip()
    what = estimate.parameter.symbol + (" - 1" if estimate.parameter.origin else "")
    return (
        f"To know {what} within {100 * _WANTED:g} %, measure {one.column} at "
        f"these loads, too, with a standard error of {error} or less."
    )


def _share(jacobian: Array, slopes: Array, number: int) -> float | None:
    """Largest error, as a share of the range, with which the constant is known well enough."""

    def excess(log_share: float) -> float:
        more = np.concatenate([jacobian, slopes / np.exp(log_share)])
        return float(np.log(covariance_of(more)[number, number] / _WANTED**2))

    low, high = np.log(_RANGE)
    if excess(low) > 0:
        return None
    if excess(high) < 0:
        return _RANGE[1]
    return float(np.exp(brentq(excess, low, high, xtol=1e-3)))
