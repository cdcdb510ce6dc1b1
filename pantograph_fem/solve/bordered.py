"""Newton's method for a state and its load at once, on a plane that crosses the path."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..errors import PathError
from .cause import Cause
from .equilibrium import Array, Correction, Plane
from .factor_reuse import FactorReuse
from .metric import Metric
from .newton import NewtonSolver
from .origin import Origin
from .problem import Problem

#: An iterate so far from the plane's point, in typical sizes and loads, is lost.
_LOST = 10.0


class BorderedNewton:
    r"""Solves r(x, load) = 0 with the equation of a plane.

    By block elimination with the factor of the tangent A alone:
    :math:`\delta x = a + \delta t\, b` with :math:`A a = -r` and :math:`A b = f`, and
    :math:`\delta t` from the plane. The bordered system is regular at limit points; the factor is
    that of a regular A unless an iterate hits the critical state to the last digit.
    """

    def __init__(
        self,
        problem: Problem,
        newton: NewtonSolver,
        metric: Metric,
        set_load: Callable[[float], None],
    ) -> None:
        """`set_load` tells the load at which `newton` evaluates residual and tangent."""
        self._problem, self._newton, self._metric = problem, newton, metric
        self._set_load = set_load
        settings = newton.settings
        self._tolerance, self._most = settings.tolerance, settings.max_iterations
        self._policy = FactorReuse(settings.tolerance, settings.contraction, settings.near)

    def solve(self, plane: Plane, guess: Array) -> Correction:
        """Iterate from a guess near the point of the plane; a collective call."""
        try:
            return self._solve(plane, guess)
        except PathError as error:  # a factorisation that failed
            return _failure(plane.load, plane.x, self._most, str(error), Cause.SINGULAR)

    def _solve(self, plane: Plane, guess: Array) -> Correction:
        load, origin = plane.load, plane.origin
        x = self._problem.impose(guess, load)
        for iterations in range(1, self._most + 1):
            self._set_load(load)
            self._newton.factorise(x, origin)
            b = self._newton.back_substitute(self._problem.load_rate(x, load))
            slope = self._metric.inner(plane.normal, b) + plane.slope
            self._policy.begin()
            while True:
                a = self._newton.correction(x)
                off = self._metric.inner(plane.normal, x + a - plane.x)
                change = -(off + plane.slope * (load - plane.load)) / slope if slope else np.nan
                step = a + change * b
                error = max(self._metric.largest(step), abs(change))
                if not np.isfinite(error):
                    return _failure(load, x, iterations, "the residual is not a number")
                origin = Origin(x, step)
                x, load = x + step, load + change
                x = self._problem.impose(x, load)
                self._set_load(load)
                if error <= self._tolerance:
                    return self._accept(x, load, iterations)
                away = max(self._metric.largest(x - plane.x), abs(load - plane.load))
                if away > _LOST:
                    return _failure(load, x, iterations, "the iteration diverged")
                if not self._policy.keep(error):
                    break
        reason = "no convergence within max_iterations"
        return _failure(load, x, self._most, reason, Cause.ITERATIONS)

    def _accept(self, x: Array, load: float, iterations: int) -> Correction:
        reason = self._problem.objection(x, load)
        cause = Cause.OBJECTION if reason else None
        return Correction(load, x, not reason, iterations, reason or "converged", cause)


def _failure(
    load: float, x: Array, iterations: int, reason: str, cause: Cause = Cause.DIVERGED
) -> Correction:
    return Correction(load, x, False, iterations, reason, cause)
