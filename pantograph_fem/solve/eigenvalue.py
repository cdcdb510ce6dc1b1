"""Eigenvalues next to zero of a factorised tangent, by back-substitutions alone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from petsc4py import PETSc

from .factorisation import Factorisation

Array = NDArray[np.float64]

#: Relative error of an eigenvalue.
_TOLERANCE = 1e-8
_RESTARTS = 100
#: Entries of a mode that are as large as the largest one, but for rounding.
_AS_LARGE = 0.9


class ModesNearZero:
    r"""Eigenvalues μ of A φ = μ B φ with B diagonal and, for multipliers say, singular.

    With :math:`D = B^{1/2}` the symmetric operator :math:`D A^{-1} D` has the eigenvalues 1/μ,
    and 0 for what B does not see. Its extreme eigenvalues are found by SLEPc's Krylov-Schur
    method. So the eigenvalues of a saddle point are those of the energy under its constraints,
    and as many of them are negative as A has negative pivots beyond one per constraint.
    """

    def __init__(self, matrix: PETSc.Mat, factor: Factorisation, weights: Array) -> None:
        """`weights` are the owned diagonal entries of B; `factor` is one of `matrix`."""
        self._root = matrix.createVecLeft()
        self._root.array[:] = np.sqrt(weights)
        self._right, self._left = matrix.createVecLeft(), matrix.createVecLeft()
        self._factor = factor
        self._operator = PETSc.Mat().createPython(matrix.getSizes(), self, comm=matrix.comm)
        self._operator.setUp()
        self._comm = matrix.comm.tompi4py()

    def mult(self, _: PETSc.Mat, v: PETSc.Vec, w: PETSc.Vec) -> None:
        """The operator, as PETSc's shell matrix."""
        self._back_substitute(v)
        w.pointwiseMult(self._left, self._root)

    def find(self, place: int) -> tuple[float, Array] | None:
        """An eigenvalue and its vector with φ·Bφ = 1, or None where the method fails.

        Where A has been factorised at another state since, it is that state's. A collective call.

        Parameters
        ----------
        place
            Which one, counted from zero: -1 is the first below it, 1 the first above, and 0 the
            nearest, whatever its sign. With n negative ones, which inertia tells, -n is the lowest.
        """
        from slepc4py import SLEPc  # type: ignore[import-untyped]  # only where it is asked for: it takes a while to load

        solver = SLEPc.EPS().create(self._operator.comm)
        solver.setOperators(self._operator)
        solver.setProblemType(SLEPc.EPS.ProblemType.HEP)
        sides = SLEPc.EPS.Which
        which = (sides.LARGEST_MAGNITUDE, sides.LARGEST_REAL, sides.SMALLEST_REAL)
        solver.setWhichEigenpairs(which[(place > 0) - (place < 0)])
        wanted = max(abs(place), 1)
        solver.setDimensions(wanted)
        solver.setTolerances(_TOLERANCE, _RESTARTS)
        solver.setInitialSpace(self._start())
        solver.solve()
        if solver.getConverged() < wanted:
            solver.destroy()
            return None
        vector = self._operator.createVecLeft()
        # 1/μ comes in the order of its size: that of the μ next to zero first.
        inverse = self._comm.bcast(solver.getEigenpair(wanted - 1, vector).real)
        solver.destroy()
        self._back_substitute(vector)
        phi = self._left.array / inverse
        return 1.0 / inverse, self._sign(phi * self._root.array) * phi

    def _back_substitute(self, v: PETSc.Vec) -> None:
        self._right.pointwiseMult(v, self._root)
        self._factor.solve(self._right, self._left)

    def _start(self) -> PETSc.Vec:
        """A vector of no symmetry, the same in every run."""
        start = self._operator.createVecLeft()
        start.array[:] = np.random.default_rng(self._comm.rank).standard_normal(start.local_size)
        start.pointwiseMult(start, self._root)
        return start

    def _sign(self, values: Array) -> float:
        """Sign of the first of the largest entries: that of the mode is anybody's choice."""
        largest = max(self._comm.allgather(float(np.abs(values).max(initial=0.0))))
        found = values[np.abs(values) >= _AS_LARGE * largest][:1]
        return float(np.sign(np.concatenate(self._comm.allgather(found))[0]))


def place_of(number: int, negative: int, zero: int) -> int:
    """Place of an eigenvalue, as :meth:`ModesNearZero.find` has it, by its number from the lowest.

    `negative` and `zero` are those that inertia tells.
    """
    if number <= negative:
        return number - negative - 1
    above = number - negative - zero  # zeros have no place: MUMPS solves for nothing along them
    nearest = above <= 0 or (number == 1 and negative == 0)
    return 0 if nearest else above
