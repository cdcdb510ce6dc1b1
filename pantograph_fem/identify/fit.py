r"""Weighted least squares for the constants.

.. math:: \chi^2(q) = \sum_i \Big(\frac{m_i(q) - d_i}{\sigma_i}\Big)^2 \to \min

over the coordinates q of the constants, with data d, their standard errors σ, and the derivatives
of the model m by direct differentiation. Near the minimum the covariance of q is
:math:`(\mathbf J^\mathsf T\mathbf J)^{-1}`, J the derivative of the residuals.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from ..errors import PathError
from .data import Observations
from .parameters import bounds_of
from .paths import EquilibriumPath, Paths

Array = NDArray[np.float64]

#: Relative change of χ² and of the coordinates at which the search ends.
_CHI2_CHANGE, _STEP = 1e-7, 1e-8
#: Paths after which it gives up.
_MOST_PATHS = 40
#: Directions in which J has less than this share of its largest singular value are not seen.
_BLIND = 1e-12


@dataclass(frozen=True, eq=False)
class Fit:
    """A minimum of χ².

    Attributes
    ----------
    q
        Coordinates of the constants, shape (constants,).
    path
        What the model gives there.
    residuals
        In standard errors, shape (values,).
    jacobian
        Their derivatives, shape (values, constants).
    converged
        Whether the search ended at a minimum.
    trace
        χ² of each path that was tried, in their order.
    """

    q: Array
    path: EquilibriumPath
    residuals: Array
    jacobian: Array
    converged: bool
    trace: tuple[float, ...]

    @property
    def chi2(self) -> float:
        """χ² at the minimum."""
        return float(self.residuals @ self.residuals)

    @property
    def covariance(self) -> Array:
        """Covariance of q, shape (constants, constants)."""
        return covariance_of(self.jacobian)


def covariance_of(jacobian: Array) -> Array:
    """Inverse of JᵀJ; directions that J does not see have an enormous variance, no infinite one."""
    _, s, directions = np.linalg.svd(jacobian, full_matrices=False)
    s = np.maximum(s, _BLIND * s[0])
    return (directions.T / s**2) @ directions


def fit(
    paths: Paths,
    observations: Observations,
    q: Array | None = None,
    free: NDArray[np.bool_] | None = None,
    tell: Callable[[str], None] | None = None,
    change: float = _CHI2_CHANGE,
) -> Fit:
    """Minimise χ².

    Parameters
    ----------
    paths
        The model.
    observations
        The data.
    q
        Where to start, strictly between the bounds; at the start of each constant by default.
    free
        Which constants may vary; all by default.
    tell
        Is told how the search goes.
    change
        Relative change of χ² at which the search ends.

    Raises
    ------
    PathError
        If there is no path at the start.
    """
    count = len(paths.parameters)
    start = np.zeros(count) if q is None else q
    mask = np.ones(count, dtype=bool) if free is None else free
    lower, upper = bounds_of(paths.parameters)
    trace: list[float] = []

    def whole(part: Array) -> Array:
        full = start.copy()
        full[mask] = part
        return full

    def residuals(part: Array) -> Array:
        try:
            r = observations.residuals(paths.at(whole(part)).values)
        except PathError:
            if not trace:
                raise
            # not finite: the step is made shorter
            return np.full(len(observations.values), np.inf)
        trace.append(float(r @ r))
        if tell is not None:
            tell(_progress(paths, whole(part), trace))
        return r

    def jacobian(part: Array) -> Array:
        return observations.residuals(paths.at(whole(part)).slopes)[:, mask]

    result = least_squares(
        residuals,
        start[mask],
        jacobian,
        bounds=(lower[mask], upper[mask]),
        method="trf",
        x_scale=1.0,  # the coordinates are logarithms, or shares of the start
        ftol=change,
        xtol=_STEP,
        gtol=1e-10,
        max_nfev=_MOST_PATHS,
    )
    best = paths.at(whole(result.x))
    return Fit(
        q=best.q,
        path=best,
        residuals=observations.residuals(best.values),
        jacobian=observations.residuals(best.slopes),
        converged=result.status > 0,
        trace=tuple(trace),
    )


def _progress(paths: Paths, q: Array, trace: list[float]) -> str:
    constants = ", ".join(
        f"{p.symbol} {p.value(float(qi)):.4g}" for p, qi in zip(paths.parameters, q, strict=True)
    )
    return f"path {len(trace)}: chi² {trace[-1]:.6g} at {constants}"
