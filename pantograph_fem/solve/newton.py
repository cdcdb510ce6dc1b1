"""Newton's method by PETSc SNES, with a symmetric factorisation that tells the inertia."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from petsc4py import PETSc

from .factor_reuse import FactorReuse
from .factorisation import Factorisation, SingularTangentError
from .newton_settings import REASONS, NewtonResult, NewtonSettings
from .origin import Origin

Array = NDArray[np.float64]

#: A bound that is never met in practice: each step with an old factor contracts the error.
_STEPS_PER_TANGENT = 20
#: Steps, in typical sizes, that are no more than round-off.
_ROUND_OFF = 1e-15
#: A Newton step that leaves more than this share of the error is a slow one;
_SLOW = 0.7
#: so many in a row, and another way of shortening steps is tried, where there is one.
_SLOW_STEPS = 3


class NewtonSolver:
    r"""Solve r(x) = 0 where the tangent of r is symmetric, definite or not.

    Unknowns are measured in typical sizes s and the residual in e/s, with e a typical energy:
    :math:`\hat x = x/s`, :math:`\hat r = s\,r/e`. Units drop out of norms and tolerances.

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
            s of the owned unknowns.
        typical_energy
            e.
        settings
            When to stop.
        potential
            The potential at the owned unknowns x, if a stable equilibrium is a minimum of it.
        """
        self.settings = settings or NewtonSettings()
        self._residual, self._tangent, self._potential = residual, tangent, potential
        self._matrix = matrix
        self._energy = typical_energy
        self._scale = matrix.createVecLeft()
        self._scale.array[:] = typical
        self._error = matrix.createVecLeft()
        self._x = matrix.createVecLeft()
        self._factorisation = Factorisation(matrix)
        self._policy = FactorReuse(
            self.settings.tolerance, self.settings.contraction, self.settings.near
        )
        self._residuals: list[float] = []
        self._tangents = 0  # factorised in this solve
        self._bound = 0  # tangents after which the attempt has failed
        self._slow = 0  # slow Newton steps in a row
        self._last_error = np.inf
        self._factorised = False  # the factor at hand is that of a state nearby
        self._keep = False  # the factor at hand is used for the next step
        self._step_at_hand = False  # that step is the error just estimated
        self._reuse = True
        self._patient = True

        self._guess_origin: Origin | None = None
        self._origin: Origin | None = None  # of the present iterate
        self._iterate = np.empty(0)

        self._snes = self._newton(descending=False)
        self._descent = self._newton(descending=True) if potential is not None else None

    def solve(self, guess: Array, origin: Origin | None = None) -> NewtonResult:
        """Iterate from a guess that satisfies the constraints; `guess` is not changed.

        The first tangent is told the origin of the guess, those that follow the iterate before.
        """
        self._guess_origin = origin
        self._residuals.clear()
        self._tangents = 0
        self._reuse = self.settings.contraction > 0
        self._patient = self._descent is None
        result = self._attempt(self._snes, guess)
        if self._descent is not None and not result.converged:
            self._reuse, self._patient = False, True
            return self._attempt(self._descent, guess)
        if self._reuse and not result.converged and self._tangents < len(self._residuals) - 1:
            self._reuse = False
            return self._attempt(self._snes, guess)
        return result

    @property
    def factorisation(self) -> Factorisation:
        """The factor of the tangent, measured in typical sizes and energy."""
        return self._factorisation

    def factorise(self, x: Array, origin: Origin | None = None) -> Factorisation:
        """Factorise the tangent at x, which may be told where x is from; until the next solve."""
        self._x.array[:] = x / self._scale.array
        self._origin = origin
        self._new_factor(self._x)
        return self._factorisation

    def correction(self, x: Array) -> Array:
        """What a Newton step from x with the last factor adds to x, in physical units.

        Nothing where it is no more than round-off: the state of rest stays at rest.
        """
        residual, step = self._matrix.createVecLeft(), self._matrix.createVecLeft()
        self._residual(x, residual)
        step.array[:] = self.back_substitute(residual.array) / self._scale.array
        if step.norm(PETSc.NormType.NORM_INFINITY) < _ROUND_OFF:
            return np.zeros_like(x)
        return -step.array * self._scale.array

    def back_substitute(self, load: Array) -> Array:
        """Solve (tangent last factorised) y = load, in physical units."""
        right = self._matrix.createVecLeft()
        right.array[:] = load * self._scale.array / self._energy
        y = self._matrix.createVecLeft()
        self._factorisation.solve(right, y)
        return y.array * self._scale.array

    def apply(self, _: PETSc.PC, r: PETSc.Vec, step: PETSc.Vec) -> None:
        """Newton's step from the residual r, as PETSc's preconditioner."""
        if self._step_at_hand:
            self._error.copy(step)
        else:
            self._factorisation.solve(r, step)
        self._step_at_hand = False

    def _newton(self, *, descending: bool) -> PETSc.SNES:
        """SNES whose line search lowers the residual, or with `descending` the potential."""
        snes = PETSc.SNES().create(self._matrix.comm)
        ksp = snes.getKSP()
        ksp.setType(PETSc.KSP.Type.PREONLY)
        ksp.getPC().setType(PETSc.PC.Type.PYTHON)
        ksp.getPC().setPythonContext(self)
        snes.setFunction(self._fill_residual, self._matrix.createVecLeft())
        snes.setJacobian(self._fill_tangent, self._matrix)
        if descending:
            snes.setObjective(self._evaluate_potential)
        snes.setConvergenceTest(self._test_convergence)
        # The test above replaces the tolerances of SNES, which still holds that on the step against
        # line searches that failed: a state that was not left any more would count as found.
        snes.setTolerances(stol=0.0, max_it=_STEPS_PER_TANGENT * self.settings.max_iterations)
        return snes

    def _attempt(self, snes: PETSc.SNES, guess: Array) -> NewtonResult:
        self._bound = self._tangents + self.settings.max_iterations
        self._slow, self._last_error = 0, np.inf
        self._policy.begin()
        self._error.set(0.0)
        self._x.array[:] = guess / self._scale.array
        try:
            snes.solve(None, self._x)
            code = snes.getConvergedReason()
            reason = REASONS.get(code, f"PETSc's SNES stopped with reason {code}")
        except (PETSc.Error, SingularTangentError) as error:  # out of memory, for one
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

    def _fill_residual(self, _: PETSc.SNES, x: PETSc.Vec, r: PETSc.Vec) -> None:
        self._residual(x.array_r * self._scale.array, r)
        r.pointwiseMult(r, self._scale)
        r.scale(1.0 / self._energy)

    def _fill_tangent(self, _: PETSc.SNES, x: PETSc.Vec, A: PETSc.Mat, P: PETSc.Mat) -> None:
        if not self._keep:
            self._new_factor(x)

    def _new_factor(self, x: PETSc.Vec) -> None:
        self._tangent(x.array_r * self._scale.array, self._matrix, self._origin)
        self._matrix.diagonalScale(self._scale, self._scale)
        self._matrix.scale(1.0 / self._energy)
        self._factorisation.update()
        self._tangents += 1
        self._factorised = True

    def _evaluate_potential(self, _: PETSc.SNES, x: PETSc.Vec) -> float:
        assert self._potential is not None
        return self._potential(x.array_r * self._scale.array) / self._energy

    def _trace(self, x: Array, iteration: int) -> None:
        before, self._iterate = self._iterate, x
        self._origin = Origin(before, x - before) if iteration else self._guess_origin

    def _test_convergence(
        self, snes: PETSc.SNES, iteration: int, norms: tuple[float, float, float]
    ) -> int:
        residual = norms[2]
        self._residuals.append(residual)
        self._keep = self._step_at_hand = False
        self._trace(snes.getSolution().array_r * self._scale.array, iteration)
        reasons = PETSc.SNES.ConvergedReason
        if not np.isfinite(residual):
            return reasons.DIVERGED_FNORM_NAN
        if residual == 0.0:
            return reasons.CONVERGED_FNORM_ABS
        if not self._factorised or (iteration == 0 and not self._reuse):
            return reasons.ITERATING
        self._factorisation.solve(snes.getFunction()[0], self._error)
        error = self._error.norm(PETSc.NormType.NORM_INFINITY)
        if error <= self.settings.tolerance:
            return reasons.CONVERGED_SNORM_RELATIVE
        if self._tangents >= self._bound:
            return reasons.DIVERGED_MAX_IT
        self._slow = self._slow + 1 if error > _SLOW * self._last_error else 0
        self._last_error = error
        if self._slow >= _SLOW_STEPS and not self._patient:
            return reasons.DIVERGED_DTOL
        self._keep = self._step_at_hand = self._policy.keep(error) and self._reuse
        return reasons.ITERATING
