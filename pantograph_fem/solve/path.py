"""An equilibrium problem as continuation sees it: it corrects a guess and linearises a state."""

from __future__ import annotations

from ..stopwatch import Stopwatch
from .continuation import Array, Correction, Linearisation
from .newton import NewtonSolver
from .newton_settings import NewtonSettings
from .problem import Problem


class NewtonPath:
    """Implements :class:`pantograph_fem.solve.continuation.Equilibrium` by Newton's method."""

    def __init__(self, problem: Problem, settings: NewtonSettings, clock: Stopwatch) -> None:
        self._problem = problem
        self._clock = clock
        self._load = 0.0
        self._newton = NewtonSolver(
            lambda x, r: problem.residual(x, self._load, r),
            lambda x, A: problem.tangent(x, self._load, A),
            problem.matrix(),
            problem.typical_sizes,
            problem.typical_energy,
            settings,
            self._potential if problem.has_minima else None,
        )

    def correct(self, guess: Array, load: float) -> Correction:
        """Newton's method from the guess, with the held unknowns put in place."""
        self._load = load
        with self._clock("solve"):
            result = self._newton.solve(self._problem.impose(guess, load))
        if result.converged and (reason := self._problem.objection(result.x, load)):
            return Correction(load, result.x, False, result.iterations, reason)
        return Correction(load, result.x, result.converged, result.iterations, result.reason)

    def _potential(self, x: Array) -> float:
        return self._problem.potential(x, self._load)

    def linearise(self, x: Array, load: float) -> Linearisation:
        """Factorise the tangent at an accepted state: its inertia, and the path's direction.

        The factor, being at hand, corrects the state once more: forces, which are differences of
        large ones in places, gain more digits than the state had.
        """
        self._load = load
        with self._clock("solve"):
            factor = self._newton.factorise(x)
            x = x + self._newton.correction(x)
            rate = self._newton.back_substitute(self._problem.load_rate(x, load))
            inertia = factor.inertia
        return Linearisation(
            x=x,
            rate=rate,
            negative_pivots=inertia.negative,
            expected_negative_pivots=self._problem.expected_negative_pivots,
            zero_pivots=inertia.zero,
        )
