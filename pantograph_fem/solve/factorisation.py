"""Symmetric indefinite factorisation by MUMPS, and the inertia that comes with it."""

from __future__ import annotations

from dataclasses import dataclass

from petsc4py import PETSc

from ..errors import PathError
from .memory import destroy_with

#: MUMPS control: detect null pivots, so that the inertia also counts zero eigenvalues.
_NULL_PIVOTS = 24
#: MUMPS control: per cent of workspace beyond the estimate, for delayed pivots.
_WORKSPACE = 14
#: MUMPS control: analyse the errors of each solve.
_ANALYSE = 11
#: Where MUMPS then leaves its condition numbers.
_CONDITIONS = (10, 11)


@dataclass(frozen=True)
class Inertia:
    """Numbers of negative and zero eigenvalues of a symmetric matrix (Sylvester)."""

    negative: int
    zero: int


class SingularTangentError(PathError):
    """The tangent has no factor, or there is no memory for it."""


class Factorisation:
    """LDLᵀ factor of one symmetric matrix whose entries change."""

    def __init__(self, matrix: PETSc.Mat) -> None:
        """Set up to factorise `matrix`."""
        ksp = PETSc.KSP().create(matrix.comm)
        matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True)
        matrix.setOption(PETSc.Mat.Option.SYMMETRY_ETERNAL, True)
        ksp.setType(PETSc.KSP.Type.PREONLY)
        ksp.setOperators(matrix)
        pc = ksp.getPC()
        pc.setType(PETSc.PC.Type.CHOLESKY)
        pc.setFactorSolverType(PETSc.Mat.SolverType.MUMPS)
        pc.setFactorSetUpSolverType()
        pc.getFactorMatrix().setMumpsIcntl(_NULL_PIVOTS, 1)
        pc.getFactorMatrix().setMumpsIcntl(_WORKSPACE, 50)
        self._ksp = ksp
        self._matrix = matrix
        destroy_with(self, ksp)

    def update(self) -> None:
        """Factorise the matrix as it is now."""
        self._ksp.setOperators(self._matrix)
        self._ksp.setUp()

    def solve(self, right: PETSc.Vec, x: PETSc.Vec) -> None:
        """Back-substitute with the last factor.

        Raises
        ------
        SingularTangentError
            Where the factorisation failed.
        """
        self._ksp.solve(right, x)
        if self._ksp.getConvergedReason() < 0:
            raise SingularTangentError(
                f"The tangent of {self._matrix.size[0]} unknowns could not be factorised by MUMPS: "
                "it is singular, or memory ran out. Give the case an effect that resists every "
                "deformation, or a coarser mesh."
            )

    @property
    def inertia(self) -> Inertia:
        """Inertia of the matrix last factorised."""
        negative, zero, _ = self._ksp.getPC().getFactorMatrix().getInertia()
        return Inertia(negative, zero)

    def condition(self) -> float | None:
        """Condition of the matrix last factorised, of Arioli, Demmel and Duff; a few solves.

        It bounds how errors of rounding are magnified, and no scaling of rows changes it. None on
        several processes, where MUMPS has none.
        """
        right, x = self._matrix.createVecLeft(), self._matrix.createVecLeft()
        right.set(1.0)
        factor = self._ksp.getPC().getFactorMatrix()
        factor.setMumpsIcntl(_ANALYSE, 1)
        try:
            self.solve(right, x)
            found = max(factor.getMumpsRinfog(place) for place in _CONDITIONS)
        finally:
            factor.setMumpsIcntl(_ANALYSE, 0)
        return found if found > 0.0 else None
