"""Ways from a guess to an equilibrium at its load."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from .cause import Cause
from .equilibrium import Array, Correction
from .newton import NewtonSolver
from .newton_settings import NewtonResult
from .origin import Origin
from .problem import Problem


class Corrector:
    """Newton's method from guesses, whose held unknowns it puts in place.

    An equilibrium that the problem objects to is a failure. Every method is collective.
    """

    def __init__(
        self, problem: Problem, newton: NewtonSolver, set_load: Callable[[float], None]
    ) -> None:
        """`set_load` tells the load at which `newton` evaluates residual and tangent."""
        self._problem, self._newton, self._set_load = problem, newton, set_load

    def correct(
        self, guess: Array, load: float, origin: Origin | None, exactly: bool = False
    ) -> Correction:
        """From a guess of that origin; with `exactly` see :meth:`NewtonSolver.solve`."""
        self._set_load(load)
        guess = self._problem.impose(guess, load)
        return self._checked(self._newton.solve(guess, origin, exactly), load)

    def correct_softly(
        self, guess: Array, load: float, origin: Origin | None, level: int
    ) -> Correction:
        """By way of easier problems from the one of a level down to the problem itself.

        Each sets out from where the one before arrived.
        """
        self._set_load(load)
        x, iterations = self._problem.impose(guess, load), 0
        try:
            for easier in range(level, -1, -1):
                self._problem.soften(easier)
                result = self._newton.solve(x, origin)
                iterations += result.iterations
                if not result.converged:
                    break
                x, origin = result.x, None
        finally:
            self._problem.soften(0)
        return self._checked(replace(result, iterations=iterations), load)

    def _checked(self, result: NewtonResult, load: float) -> Correction:
        reason = self._problem.objection(result.x, load) if result.converged else ""
        return Correction(
            load,
            result.x,
            result.converged and not reason,
            result.iterations,
            reason or result.reason,
            Cause.OBJECTION if reason else result.cause,
            result.residuals,
        )
