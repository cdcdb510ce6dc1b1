"""Residual, tangent and its factor in typical sizes, whatever the units."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from petsc4py import PETSc

from .factorisation import Factorisation
from .origin import Origin

Array = NDArray[np.float64]

#: Steps, in typical sizes, that are no more than round-off.
_ROUND_OFF = 1e-15


class ScaledSystem:
    r"""The linear side of r(x) = 0, with a tangent that is symmetric, definite or not.

    Unknowns are measured in typical sizes s and the residual in e/s, with e a typical energy:
    :math:`\hat x = x/s`, :math:`\hat r = s\,r/e`. Units drop out of norms and tolerances. Vectors
    are in these measures, arrays in physical units.

    Attributes
    ----------
    matrix
        The tangent that was factorised last; also gives the layout of vectors.
    factorisation
        Its factor.
    """

    def __init__(
        self,
        residual: Callable[[Array, PETSc.Vec], None],
        tangent: Callable[[Array, PETSc.Mat, Origin | None], None],
        matrix: PETSc.Mat,
        typical: Array,
        typical_energy: float,
    ) -> None:
        """Set up, with s and e; for `residual` and `tangent` see :class:`NewtonSolver`."""
        self._residual, self._tangent = residual, tangent
        self._energy = typical_energy
        self.matrix = matrix
        self._scale = matrix.createVecLeft()
        self._scale.array[:] = typical
        self.factorisation = Factorisation(matrix)

    def vector(self) -> PETSc.Vec:
        """A vector of the unknowns."""
        return self.matrix.createVecLeft()

    def physical(self, x: PETSc.Vec) -> Array:
        """Unknowns in physical units."""
        return x.array_r * self._scale.array_r

    def measure(self, x: Array, into: PETSc.Vec) -> None:
        """Unknowns in typical sizes."""
        into.array[:] = x / self._scale.array_r

    def residual(self, x: PETSc.Vec, r: PETSc.Vec) -> None:
        """Fill r."""
        self._residual(self.physical(x), r)
        r.pointwiseMult(r, self._scale)
        r.scale(1.0 / self._energy)

    def residual_at(self, x: Array) -> Array:
        """Residual at x, in its typical sizes."""
        at, r = self.vector(), self.vector()
        self.measure(x, at)
        self.residual(at, r)
        return r.array.copy()

    def factorise(self, x: PETSc.Vec, origin: Origin | None = None) -> None:
        """Factorise the tangent at x, which may be told where x is from."""
        self._tangent(self.physical(x), self.matrix, origin)
        self.matrix.diagonalScale(self._scale, self._scale)
        self.matrix.scale(1.0 / self._energy)
        self.factorisation.update()

    def correction(self, x: Array) -> Array:
        """What a Newton step from x with the last factor adds to x.

        Nothing where it is no more than round-off: the state of rest stays at rest.
        """
        residual, step = self.vector(), self.vector()
        self._residual(x, residual)
        self.measure(self.back_substitute(residual.array), step)
        if step.norm(PETSc.NormType.NORM_INFINITY) < _ROUND_OFF:
            return np.zeros_like(x)
        return -self.physical(step)

    def back_substitute(self, load: Array) -> Array:
        """Solve (tangent last factorised) y = load."""
        right, y = self.vector(), self.vector()
        right.array[:] = load * self._scale.array_r / self._energy
        self.factorisation.solve(right, y)
        return self.physical(y)
