"""When Newton's method stops, and what it ends with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .cause import Cause

Array = NDArray[np.float64]


@dataclass(frozen=True)
class NewtonSettings:
    """When to stop.

    Attributes
    ----------
    tolerance
        Largest remaining error of any unknown, in its typical size.
    max_iterations
        Tangents after which an attempt has failed.
    contraction
        A factor is used again while each step leaves at most this share of the error; 0 makes
        every step a full Newton step.
    near
        Errors, in typical sizes, above which a factor is not used again.
    """

    tolerance: float = 1e-8
    max_iterations: int = 15
    contraction: float = 0.5
    near: float = 1e-2


@dataclass(frozen=True)
class NewtonResult:
    """What a solve ended with.

    `iterations` counts the tangents that were factorised, which is what a solve costs;
    `residuals` holds the norm of the scaled residual before each step of the last attempt and
    after it.
    `cause` is None where it converged.
    """

    x: Array
    converged: bool
    iterations: int
    reason: str
    residuals: tuple[float, ...]
    cause: Cause | None = None


#: PETSc's reasons in words.
REASONS = {
    2: "converged: the residual is zero",
    4: "converged: the remaining error is below the tolerance",
    -3: "the tangent is singular",
    -4: "the residual is not a number",
    -5: "no convergence within max_iterations",
    -6: "the line search found no shorter step that is better",
    -8: "the line search ended in a local minimum of the residual",
    -9: "the error does not fall any more",
}

#: Their causes; any other failure is a residual that does not fall.
CAUSES = {-3: Cause.SINGULAR, -4: Cause.DIVERGED, -5: Cause.ITERATIONS}
