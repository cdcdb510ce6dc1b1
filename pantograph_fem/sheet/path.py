"""A sheet as continuation sees it: something that corrects a guess and linearises a state."""

from __future__ import annotations

from ..solve.continuation import Array, Correction, Linearisation
from ..solve.newton import NewtonSettings, NewtonSolver
from ..stopwatch import Stopwatch
from .equilibrium import SheetEquilibrium


class SheetPath:
    """Implements :class:`pantograph_fem.solve.continuation.Equilibrium`."""

    def __init__(
        self, equilibrium: SheetEquilibrium, settings: NewtonSettings, clock: Stopwatch
    ) -> None:
        self._equilibrium = equilibrium
        self._clock = clock
        self._newton = NewtonSolver(
            equilibrium.residual,
            equilibrium.tangent,
            equilibrium.matrix(),
            equilibrium.typical_sizes,
            equilibrium.discretisation.scales.energy,
            settings,
        )

    def correct(self, guess: Array, load: float) -> Correction:
        """Newton's method from the guess, with the grips put in place."""
        with self._clock("solve"):
            result = self._newton.solve(self._equilibrium.impose(guess, load))
        return Correction(load, result.x, result.converged, result.iterations, result.reason)

    def linearise(self, x: Array, load: float) -> Linearisation:
        """Factorise the tangent at an accepted state: its inertia, and the path's direction."""
        with self._clock("solve"):
            factor = self._newton.factorise(x)
            rate = self._newton.back_substitute(self._equilibrium.load_rate(x, load))
            inertia = factor.inertia
        return Linearisation(
            rate=rate,
            negative_pivots=inertia.negative,
            expected_negative_pivots=self._equilibrium.discretisation.multiplier_dofs,
            zero_pivots=inertia.zero,
        )
