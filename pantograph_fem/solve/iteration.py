"""Newton's steps from a guess until they arrive or are given up, by PETSc SNES."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from petsc4py import PETSc

from .attempt import Attempt
from .cause import Cause
from .factor_reuse import FactorReuse
from .factorisation import SingularTangentError
from .newton_settings import CAUSES, REASONS, NewtonResult, NewtonSettings
from .origin import Origin
from .scaled import ScaledSystem
from .snes import newton_snes

Array = NDArray[np.float64]

#: What steps are shortened for: until the residual is smaller, or the potential; or to where the
#: residual is smallest, be it beyond Newton's step.
Search = Literal["residual", "potential", "smallest residual"]


class NewtonIteration:
    """Attempts at one solve; each begins at the guess and may use the factor that is at hand.

    Attributes
    ----------
    tangents
        Factorised since the solve began.
    residuals
        Norm of the scaled residual at each iterate since the solve began.
    """

    def __init__(
        self,
        system: ScaledSystem,
        settings: NewtonSettings,
        potential: Callable[[Array], float] | None,
    ) -> None:
        """`potential` is that of the unknowns in physical units, in typical energies."""
        self._system, self._settings, self._potential = system, settings, potential
        self._error, self._x = system.vector(), system.vector()
        self._policy = FactorReuse(settings.tolerance, settings.contraction, settings.near)
        self.residuals: list[float] = []
        self.tangents = 0
        self._attempt = Attempt()
        self._factorised = False  # the factor at hand is that of a state nearby
        self._keep = False  # the factor at hand is used for the next step
        self._step_at_hand = False  # that step is the error just estimated
        self._guess_origin: Origin | None = None
        self._origin: Origin | None = None  # of the present iterate
        self._iterate = np.empty(0)

    def begin(self, origin: Origin | None) -> None:
        """Another solve begins, from a guess of that origin."""
        self._guess_origin = origin
        self.residuals.clear()
        self.tangents = 0

    def attempt(
        self, search: Search, guess: Array, reuse: bool = False, patient: bool = True
    ) -> NewtonResult:
        """Iterate from the guess; with `reuse` and `patient` see :class:`Attempt`."""
        self._attempt = Attempt(self.tangents + self._settings.max_iterations, reuse, patient)
        first = len(self.residuals)
        self._policy.begin()
        self._error.set(0.0)
        self._system.measure(guess, self._x)
        snes = self._solver(search)  # made anew: it and this object would keep each other alive
        try:
            snes.solve(None, self._x)
            code = snes.getConvergedReason()
            reason = REASONS.get(code, f"PETSc's SNES stopped with reason {code}")
        except (PETSc.Error, SingularTangentError) as error:  # out of memory, for one
            code, reason = -3, f"the tangent could not be factorised ({error})"
        finally:
            snes.destroy()
        if code > 0:
            self._x.axpy(-1.0, self._error)
        self._factorised = code > 0  # the factor of a failed iterate estimates nothing
        return NewtonResult(
            x=self._system.physical(self._x),
            converged=code > 0,
            iterations=self.tangents,
            reason=reason,
            residuals=tuple(self.residuals[first:]),
            cause=None if code > 0 else CAUSES.get(code, Cause.STALLED),
        )

    def factorise(self, x: Array, origin: Origin | None) -> None:
        """Factorise the tangent at x, outside of a solve."""
        self._system.measure(x, self._x)
        self._origin = origin
        self._new_factor(self._x)

    def apply(self, _: PETSc.PC, r: PETSc.Vec, step: PETSc.Vec) -> None:
        """Newton's step from the residual r, as PETSc's preconditioner."""
        if self._step_at_hand:
            self._error.copy(step)
        else:
            self._system.factorisation.solve(r, step)
        self._step_at_hand = False

    def _solver(self, search: Search) -> PETSc.SNES:
        return newton_snes(
            self._system.matrix,
            self,
            self._fill_residual,
            self._fill_tangent,
            self._test_convergence,
            self._settings.max_iterations,
            line_search="l2" if search == "smallest residual" else "bt",
            objective=self._evaluate_potential if search == "potential" else None,
        )

    def _fill_residual(self, _: PETSc.SNES, x: PETSc.Vec, r: PETSc.Vec) -> None:
        self._system.residual(x, r)

    def _fill_tangent(self, _: PETSc.SNES, x: PETSc.Vec, A: PETSc.Mat, P: PETSc.Mat) -> None:
        if not self._keep:
            self._new_factor(x)

    def _new_factor(self, x: PETSc.Vec) -> None:
        self._system.factorise(x, self._origin)
        self.tangents += 1
        self._factorised = True

    def _evaluate_potential(self, _: PETSc.SNES, x: PETSc.Vec) -> float:
        assert self._potential is not None
        return self._potential(self._system.physical(x))

    def _trace(self, x: Array, iteration: int) -> None:
        before, self._iterate = self._iterate, x
        self._origin = Origin(before, x - before) if iteration else self._guess_origin

    def _test_convergence(
        self, snes: PETSc.SNES, iteration: int, norms: tuple[float, float, float]
    ) -> int:
        residual = norms[2]
        self.residuals.append(residual)
        self._keep = self._step_at_hand = False
        self._trace(self._system.physical(snes.getSolution()), iteration)
        reasons = PETSc.SNES.ConvergedReason
        if not np.isfinite(residual):
            return reasons.DIVERGED_FNORM_NAN
        if residual == 0.0:
            return reasons.CONVERGED_FNORM_ABS
        if not self._factorised or (iteration == 0 and not self._attempt.reuse):
            return reasons.ITERATING
        self._system.factorisation.solve(snes.getFunction()[0], self._error)
        error = self._error.norm(PETSc.NormType.NORM_INFINITY)
        if error <= self._settings.tolerance:
            return reasons.CONVERGED_SNORM_RELATIVE
        going_on = self._attempt.outcome(error, self.tangents)
        if going_on == reasons.ITERATING:
            self._keep = self._step_at_hand = self._policy.keep(error) and self._attempt.reuse
        return going_on
