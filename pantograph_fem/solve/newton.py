"""Newton's method with a symmetric factorisation that tells the inertia."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from mpi4py import MPI
from petsc4py import PETSc

from .factorisation import Factorisation
from .iteration import NewtonIteration
from .newton_settings import NewtonResult, NewtonSettings
from .origin import Origin
from .scaled import ScaledSystem

Array = NDArray[np.float64]


class NewtonSolver:
    """Solve r(x) = 0 where the tangent of r is symmetric, definite or not.

    Unknowns are measured in typical sizes, see :class:`~pantograph_fem.solve.scaled.ScaledSystem`.

    A solve has converged when the error that is left, estimated by one more back-substitution
    with the last factor (Deuflhard's simplified Newton correction), is below the tolerance.
    Unlike a residual norm this depends neither on the mesh size nor on the quality of the
    predictor. That correction, being at hand, is then applied.

    Comparing such corrections tells how well the factor at hand still contracts the error: see
    :class:`~pantograph_fem.solve.factor_reuse.FactorReuse`.

    An attempt that fails is followed by another: with a new factor at each step, as the direction
    from an old one may be none in which the residual falls; and with steps that are shortened
    until the potential falls instead of the residual, where stable states are its minima. Far
    from equilibrium the potential is the better guide; near it differences of it drown in
    round-off, which is why it comes last.
    """

    def __init__(
        self,
        residual: Callable[[Array, PETSc.Vec], None],
        tangent: Callable[[Array, PETSc.Mat, Origin | None], None],
        matrix: PETSc.Mat,
        typical: Array,
        typical_energy: float,
        settings: NewtonSettings | None = None,
        potential: Callable[[Array], float] | None = None,
    ) -> None:
        """Prepare the solver.

        Parameters
        ----------
        residual, tangent
            Fill a vector or matrix at the owned unknowns x, in physical units; `tangent` is told
            the origin of x, if it is known.
        matrix
            Where the tangent goes; also gives the layout of vectors.
        typical
            Typical size of the owned unknowns.
        typical_energy
            Typical energy.
        settings
            When to stop.
        potential
            The potential at the owned unknowns x, if a stable equilibrium is a minimum of it.
        """
        self.settings = settings or NewtonSettings()
        self._system = ScaledSystem(residual, tangent, matrix, typical, typical_energy)
        self._descends = potential is not None
        scaled = None if potential is None else lambda x: potential(x) / typical_energy
        self._iteration = NewtonIteration(self._system, self.settings, scaled)

    def solve(
        self, guess: Array, origin: Origin | None = None, exactly: bool = False
    ) -> NewtonResult:
        """Iterate from a guess that satisfies the constraints; `guess` is not changed.

        The first tangent is told the origin of the guess, those that follow the iterate before.
        With `exactly` steps are as long as makes the residual smallest. That takes more residuals,
        and finds states where the usual ways find none.
        """
        iteration = self._iteration
        iteration.begin(origin)
        if exactly:
            return iteration.attempt("smallest residual", guess)
        reuse = self.settings.contraction > 0
        result = iteration.attempt("residual", guess, reuse, patient=not self._descends)
        if self._descends and not result.converged:
            return iteration.attempt("potential", guess)
        if reuse and not result.converged and iteration.tangents < len(iteration.residuals) - 1:
            return iteration.attempt("residual", guess)
        return result

    @property
    def factorisation(self) -> Factorisation:
        """The factor of the tangent, measured in typical sizes and energy."""
        return self._system.factorisation

    @property
    def comm(self) -> MPI.Comm:
        """Of the processes that share the unknowns."""
        return self._system.matrix.comm.tompi4py()

    def factorise(self, x: Array, origin: Origin | None = None) -> Factorisation:
        """Factorise the tangent at x, which may be told where x is from; until the next solve."""
        self._iteration.factorise(x, origin)
        return self.factorisation

    def residual(self, x: Array) -> Array:
        """Residual at x in typical sizes and energy."""
        return self._system.residual_at(x)

    def correction(self, x: Array) -> Array:
        """What a Newton step from x with the last factor adds to x, in physical units."""
        return self._system.correction(x)

    def back_substitute(self, load: Array) -> Array:
        """Solve (tangent last factorised) y = load, in physical units."""
        return self._system.back_substitute(load)
