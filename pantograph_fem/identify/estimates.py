"""Estimates of the constants with their errors, and in words how far they are known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2 as chi2_distribution
from scipy.stats import norm

from .fit import Fit
from .parameters import Parameter

Array = NDArray[np.float64]

#: Standard error of a coordinate, such as ln K, from which on a constant counts as not known.
NOT_KNOWN = 0.3
#: Correlation from which on two constants count as seen together only.
TOGETHER = 0.95
#: Probability below which a fit is called a bad one.
_UNLIKELY = 0.01
#: Share of the bounds' distance within which an estimate lies on one.
_AT_BOUND = 1e-4

_HINTS = {
    "stretch": "elongations of fibres at the corners, or forces where the fibres lock, would tell",
    "bending": "angles in the most bent region, or markers across the bent layers, would tell",
    "shear": "forces well before the fibres lock would tell",
    "shear_exponent": "forces at small and at large shear angles would tell",
}


@dataclass(frozen=True)
class Estimate:
    """What is known of a constant.

    Attributes
    ----------
    parameter
        The constant.
    value, standard_error
        SI units; the error to first order.
    deviation
        Standard error of its coordinate: for "log" the relative one, of γ - 1 for γ.
    interval
        Confidence interval: in the coordinate it is symmetric about the estimate.
    at_bound
        Whether the search ended at a bound.
    """

    parameter: Parameter
    value: float
    standard_error: float
    deviation: float
    interval: tuple[float, float]
    at_bound: bool

    @property
    def known(self) -> bool:
        """Whether the data tell the constant."""
        return self.deviation <= NOT_KNOWN and not self.at_bound


def estimates_of(fit: Fit, parameters: Sequence[Parameter], confidence: float) -> list[Estimate]:
    """The estimates, with normal intervals: the standard errors of the data are known."""
    width = norm.ppf(0.5 + 0.5 * confidence)
    deviations = np.sqrt(np.diag(fit.covariance))
    estimates = []
    for parameter, q, deviation in zip(parameters, fit.q.tolist(), deviations, strict=True):
        low, high = parameter.coordinate(parameter.lower), parameter.coordinate(parameter.upper)
        estimates.append(
            Estimate(
                parameter=parameter,
                value=parameter.value(q),
                standard_error=parameter.slope(q) * float(deviation),
                deviation=float(deviation),
                interval=(
                    parameter.value(q - width * float(deviation)),
                    parameter.value(q + width * float(deviation)),
                ),
                at_bound=min(q - low, high - q) < _AT_BOUND * (high - low),
            )
        )
    return estimates


def correlation_of(fit: Fit) -> Array:
    """Correlations of the coordinates, shape (constants, constants)."""
    deviations = np.sqrt(np.diag(fit.covariance))
    return fit.covariance / np.outer(deviations, deviations)


def sentences(
    fit: Fit, estimates: Sequence[Estimate], confidence: float, correlation: Array
) -> list[str]:
    """What cannot be known from the data, and whether the model fits them."""
    told = [_unknown(e, confidence) for e in estimates if not e.known]
    for i, first in enumerate(estimates):
        for j, second in enumerate(estimates[:i]):
            if abs(r := float(correlation[i, j])) > TOGETHER:
                told.append(_together(second.parameter, first.parameter, r))
    if not told:
        told.append("All constants are known from these data.")
    return told + [text for text in (_goodness(fit),) if text]


def _unknown(estimate: Estimate, confidence: float) -> str:
    p = estimate.parameter
    if estimate.at_bound:
        return (
            f"{p.symbol} ({p.name}) went to a bound, {p.text(estimate.value)}: the data ask for "
            "more, or do not see it; widen its bounds, or look for fewer constants."
        )
    low, high = estimate.interval
    reach = f"from {p.text(low)} to {p.text(high)}"
    factor = (high - p.origin) / max(low - p.origin, 1e-300)
    wide = f"a factor of {factor:.2g}" if factor < 1e4 else "many powers of ten"
    span = f", {wide}" if p.logarithmic and not p.origin else ""
    return (
        f"{p.symbol} ({p.name}) is not known from these data: its {100 * confidence:g} % interval "
        f"reaches {reach}{span}; {_HINTS[p.name]}."
    )


def _together(first: Parameter, second: Parameter, r: float) -> str:
    how = "one can grow as the other falls" if r < 0 else "both can grow together"
    return (
        f"{first.symbol} and {second.symbol} are told apart badly (correlation {r:.3f}): {how} "
        "and the data are hardly missed."
    )


def _goodness(fit: Fit) -> str:
    freedom = len(fit.residuals) - len(fit.q)
    if freedom < 1:
        return "There are no more data than constants: how well the model fits cannot be told."
    exceeded = float(chi2_distribution.sf(fit.chi2, freedom))
    if exceeded < _UNLIKELY:
        return (
            f"The model misses the data by more than their standard errors allow (chi² "
            f"{fit.chi2:.4g} for {freedom} degrees of freedom): the errors are too small or the "
            "model is not that of the specimen, and the intervals are too narrow."
        )
    if exceeded > 1 - 1e-6:
        return (
            f"The model meets the data better than their standard errors let expect (chi² "
            f"{fit.chi2:.4g} for {freedom} degrees of freedom)."
        )
    return ""
