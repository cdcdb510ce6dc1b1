"""Observed orders of convergence and the limits they point to."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

#: Ratios of successive parameters that differ by less count as constant: parameters are rounded.
_SAME_RATIO = 0.01

#: Changes smaller than this part of the value are rounding errors.
_ROUNDING = 1e-10


class Limit(NamedTuple):
    """Value that a series tends to, and the order at which it does."""

    value: float
    order: float


def orders_of_errors(parameters: ArrayLike, errors: ArrayLike) -> Array:
    r"""Orders at which known errors fall.

    .. math:: p_i = \frac{\log(e_{i-1}/e_i)}{\log(h_{i-1}/h_i)}

    Parameters
    ----------
    parameters
        Positive, decreasing, shape (n,).
    errors
        Shape (n,); their signs do not matter.

    Returns
    -------
    Array
        Shape (n,); NaN at first, and where an error is zero or not known.
    """
    h, e = np.asarray(parameters, float), np.abs(np.asarray(errors, float))
    logarithms = np.log(np.where(e > 0, e, np.nan))
    orders = np.full(len(h), np.nan)
    orders[1:] = np.diff(logarithms) / np.diff(np.log(h))
    return orders


def orders_of_values(parameters: ArrayLike, values: ArrayLike) -> Array:
    r"""Orders at which values converge to a limit that is not known.

    .. math:: p_i = \frac{\log\bigl((v_{i-2} - v_{i-1})/(v_{i-1} - v_i)\bigr)}{\log r},
        \qquad r = \frac{h_{i-2}}{h_{i-1}} = \frac{h_{i-1}}{h_i}

    Parameters
    ----------
    parameters
        Positive, decreasing, shape (n,).
    values
        Shape (n,).

    Returns
    -------
    Array
        Shape (n,); NaN for the first two, and where the ratio r is not constant or the values
        do not change monotonically, or no more.
    """
    h, v = np.asarray(parameters, float), np.asarray(values, float)
    orders = np.full(len(h), np.nan)
    for i in range(2, len(h)):
        first, second = h[i - 2] / h[i - 1], h[i - 1] / h[i]
        before, after = v[i - 2] - v[i - 1], v[i - 1] - v[i]
        seen = min(abs(before), abs(after)) > _ROUNDING * abs(v[i])
        if abs(second / first - 1) < _SAME_RATIO and seen and before * after > 0:
            orders[i] = np.log(before / after) / np.log(second)
    return orders


def richardson_limit(parameters: ArrayLike, values: ArrayLike) -> Limit | None:
    r"""Limit that the last three values point to.

    .. math:: v_\infty = v_n + \frac{v_n - v_{n-1}}{r^p - 1}

    with r and p as in `orders_of_values`. It rests on an order that no longer changes: compare it
    with that of the runs before.

    Returns
    -------
    Limit or None
        None when there are no three values, no constant ratio, or no convergence (p > 0).
    """
    h, v = np.asarray(parameters, float)[-3:], np.asarray(values, float)[-3:]
    order = orders_of_values(h, v)[-1] if len(h) == 3 else np.nan
    if not order > 0:
        return None
    return Limit(float(v[2] + (v[2] - v[1]) / ((h[1] / h[2]) ** order - 1)), float(order))
