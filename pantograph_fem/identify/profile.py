"""Profile likelihood: how χ² grows as one constant is held elsewhere and the others follow."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import PathError
from .data import Observations
from .fit import Fit, fit
from .parameters import bounds_of
from .paths import Paths

Array = NDArray[np.float64]

#: Where a constant is held, in standard errors from its estimate; each way outwards.
_PLACES = (1.2, 2.4)
#: No farther than this in a coordinate, such as ln K: for constants that are not known.
_FARTHEST = 1.5
#: Relative change of χ² at which a search for the others ends: a figure shows no more.
_CHI2_CHANGE = 1e-4
#: Share of the distance of the bounds that is kept from them.
_MARGIN = 1e-3


@dataclass(frozen=True, eq=False)
class Profile:
    """χ² along a constant: at its coordinates `q` the least `chi2` over the others; ascending."""

    q: Array
    chi2: Array


def profile_of(
    paths: Paths,
    observations: Observations,
    best: Fit,
    number: int,
    tell: Callable[[str], None] | None = None,
) -> Profile:
    """Profile of the constant of that number, with real fits, through the estimate.

    Places without a path are left out.
    """
    covariance = best.covariance
    deviation = float(np.sqrt(covariance[number, number]))
    lower, upper = (bound[number] for bound in bounds_of(paths.parameters))
    margin = _MARGIN * (upper - lower)
    points = {float(best.q[number]): best.chi2}
    free = np.arange(len(best.q)) != number
    for side in (-1.0, 1.0):
        for place in _PLACES:
            step = side * place * min(deviation, _FARTHEST / max(_PLACES))
            to = float(np.clip(best.q[number] + step, lower + margin, upper - margin))
            if to in points:
                continue
            try:
                chi2 = _held(paths, observations, best, number, to, free)
            except PathError:
                break
            points[to] = chi2
            if tell is not None:
                parameter = paths.parameters[number]
                value = parameter.text(parameter.value(to))
                tell(f"profile of {parameter.symbol}: chi² {chi2:.6g} at {value}")
    q = np.array(sorted(points))
    return Profile(q, np.array([points[place] for place in q.tolist()]))


def _held(
    paths: Paths,
    observations: Observations,
    best: Fit,
    number: int,
    to: float,
    free: NDArray[np.bool_],
) -> float:
    """Least χ² with one constant held."""
    covariance = best.covariance
    lower, upper = bounds_of(paths.parameters)
    margin = _MARGIN * (upper - lower)
    # where the others go to first order
    start = best.q + covariance[number] / covariance[number, number] * (to - best.q[number])
    start = np.clip(start, lower + margin, upper - margin)
    start[number] = to
    if not free.any():
        return float(np.sum(observations.residuals(paths.at(start).values) ** 2))
    return fit(paths, observations, start, free, change=_CHI2_CHANGE).chi2
