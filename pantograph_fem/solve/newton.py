"""Newton's method by PETSc SNES, with a symmetric factorisation that tells the inertia."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from petsc4py import PETSc

from .factorisation import Factorisation

Array = NDArray[np.float64]

#: Errors, in typical sizes, above which an old factor is not trusted.
_NEAR = 1e-2
#: A bound that is never met in practice: each step with an old factor contracts the error.
_STEPS_PER_TANGENT = 10


@dataclass(frozen=True)
class NewtonSettings:
    """When to stop.

    Attributes
    ----------
    tolerance
        Largest remaining error of any unknown, in its typical size.
    max_iterations
        Tangents after which a solve has failed.
    line_search
        PETSc's name: "bt" shortens steps until the residual norm falls, "basic" never does.
    contraction
        A factor is used again while each step leaves at most this share of the error; 0 makes
        every step a full Newton step.
    """

    tolerance: float = 1e-8
    max_iterations: int = 15
    line_search: str = "bt"
    contraction: float = 0.2


@dataclass(frozen=True)
class NewtonResult:
    """What a solve ended with.

    `iterations` counts the tangents that were factorised, which is what a solve costs;
    `residuals` holds the norm of the scaled residual before each step and after the last.
    """

    x: Array
    converged: bool
    iterations: int
    reason: str
    residuals: tuple[float, ...]


class NewtonSolver:
    r"""Solve r(x) = 0 where the tangent of r is symmetric, definite or not.

    Unknowns are measured in typical sizes s and the residual in e/s, with e a typical energy:
    :math:`\hat x = x/s`, :math:`\hat r = s\,r/e`. Units drop out of norms and tolerances.

    A solve has converged when the error that is left, estimated by one more back-substitution
    with the last factor (Deuflhard's simplified Newton correction), is below the tolerance.
    Unlike a residual norm this depends neither on the mesh size nor on the quality of the
    predictor. That correction, being at hand, is then applied.

    Comparing such corrections tells how well the factor at hand still contracts the error. While
    it does well no new one is made: a back-substitution costs a tenth of a factorisation.
    """

    def __init__(
        self,
        residual: Callable[[Array, PETSc.Vec], None],
        tangent: Callable[[Array, PETSc.Mat], None],
        matrix: PETSc.Mat,
        typical: Array,
        typical_energy: float,
        settings: NewtonSettings | None = None,
    ) -> None:
        """Prepare the solver.

        Parameters
        ----------
        residual, tangent
            Fill a vector or matrix at the owned unknowns x, in physical units.
        matrix
            Where the tangent goes; also gives the layout of vectors.
        typical
            s of the owned unknowns.
        typical_energy
            e.
        """
        self.settings = settings or NewtonSettings()
        self._residual, self._tangent = residual, tangent
        self._matrix = matrix
        self._energy = typical_energy
        self._scale = matrix.createVecLeft()
        self._scale.array[:] = typical
        self._error = matrix.createVecLeft()
        self._x = matrix.createVecLeft()
        self._residuals: list[float] = []
        self._last_error = np.inf
        self._tangents = 0
        self._factorised = False
        self._reuse = True
        self._keep = False

        self._snes = PETSc.SNES().create(matrix.comm)
        self._factorisation = Factorisation(self._snes.getKSP(), matrix)
        self._snes.setFunction(self._fill_residual, matrix.createVecLeft())
        self._snes.setJacobian(self._fill_tangent, matrix)
        self._snes.setConvergenceTest(self._test_convergence)
        # SNES compares its own residual tolerances nowhere: the test above replaces them.
        self._snes.setTolerances(max_it=_STEPS_PER_TANGENT * self.settings.max_iterations)
        options = PETSc.Options()
        name = "snes_linesearch_type"
        prefix = f"pantograph_{id(self):x}_"
        options[prefix + name] = self.settings.line_search
        self._snes.setOptionsPrefix(prefix)
        self._snes.setFromOptions()
        options.delValue(prefix + name)

    def solve(self, guess: Array) -> NewtonResult:
        """Iterate from a guess that satisfies the constraints; `guess` is not changed."""
        self._reuse = self.settings.contraction > 0
        result = self._solve(guess)
        if self._reuse and not result.converged and result.iterations < len(result.residuals) - 1:
            # A direction from an old factor may be none in which the residual falls.
            self._reuse = False
            result = self._solve(guess)
        return result

    def _solve(self, guess: Array) -> NewtonResult:
        self._residuals.clear()
        self._tangents = 0
        self._last_error = np.inf
        self._error.set(0.0)
        self._x.array[:] = guess / self._scale.array
        try:
            self._snes.solve(None, self._x)
            code = self._snes.getConvergedReason()
            reason = _REASONS.get(code, f"PETSc's SNES stopped with reason {code}")
        except PETSc.Error as error:  # a factorisation that runs out of memory, for one
            code, reason = -3, f"the tangent could not be factorised ({error})"
        if code > 0:
            self._x.axpy(-1.0, self._error)
        self._factorised = code > 0  # the factor of a failed iterate estimates nothing
        return NewtonResult(
            x=self._x.array * self._scale.array,
            converged=code > 0,
            iterations=self._tangents,
            reason=reason,
            residuals=tuple(self._residuals),
        )

    def factorise(self, x: Array) -> Factorisation:
        """Factorise the tangent at x; valid until the next solve."""
        self._x.array[:] = x / self._scale.array
        self._keep = False
        self._fill_tangent(self._snes, self._x, self._matrix, self._matrix)
        self._factorisation.update()
        self._factorised = True
        return self._factorisation

    def back_substitute(self, load: Array) -> Array:
        """Solve (tangent last factorised) y = load, in physical units."""
        right = self._matrix.createVecLeft()
        right.array[:] = load * self._scale.array / self._energy
        y = self._matrix.createVecLeft()
        self._factorisation.solve(right, y)
        return y.array * self._scale.array

    def _fill_residual(self, _: PETSc.SNES, x: PETSc.Vec, r: PETSc.Vec) -> None:
        self._residual(x.array_r * self._scale.array, r)
        r.pointwiseMult(r, self._scale)
        r.scale(1.0 / self._energy)

    def _fill_tangent(self, _: PETSc.SNES, x: PETSc.Vec, A: PETSc.Mat, P: PETSc.Mat) -> None:
        if self._keep:  # PETSc sees that the matrix has not changed, and keeps its factor
            return
        self._tangent(x.array_r * self._scale.array, P)
        P.diagonalScale(self._scale, self._scale)
        P.scale(1.0 / self._energy)
        self._tangents += 1
        self._factorised = True  # SNES factorises what it asked for before anything else

    def _test_convergence(
        self, snes: PETSc.SNES, iteration: int, norms: tuple[float, float, float]
    ) -> int:
        residual = norms[2]
        self._residuals.append(residual)
        reasons = PETSc.SNES.ConvergedReason
        if not np.isfinite(residual):
            return reasons.DIVERGED_FNORM_NAN
        if residual == 0.0:
            return reasons.CONVERGED_FNORM_ABS
        if not self._factorised or (iteration == 0 and not self._reuse):
            self._keep = False
            return reasons.ITERATING
        self._factorisation.solve(snes.getFunction()[0], self._error)
        error = self._error.norm(PETSc.NormType.NORM_INFINITY)
        if error <= self.settings.tolerance:
            return reasons.CONVERGED_SNORM_RELATIVE
        if self._tangents >= self.settings.max_iterations:
            return reasons.DIVERGED_MAX_IT
        contracts = error <= self.settings.contraction * min(self._last_error, _NEAR)
        self._keep = self._reuse and contracts
        self._last_error = error
        return reasons.ITERATING


_REASONS = {
    2: "converged: the residual is zero",
    4: "converged: the remaining error is below the tolerance",
    -3: "the tangent is singular",
    -4: "the residual is not a number",
    -5: "no convergence within max_iterations",
    -6: "the line search found no step that lowers the residual",
    -8: "the line search ended in a local minimum of the residual",
}
