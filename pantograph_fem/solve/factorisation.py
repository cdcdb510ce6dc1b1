"""Symmetric indefinite factorisation by MUMPS, and the inertia that comes with it."""

from __future__ import annotations

from dataclasses import dataclass

from petsc4py import PETSc

#: MUMPS control: detect null pivots, so that the inertia also counts zero eigenvalues.
_NULL_PIVOTS = 24
#: MUMPS control: per cent of workspace beyond the estimate, for delayed pivots.
_WORKSPACE = 14


@dataclass(frozen=True)
class Inertia:
    """Numbers of negative and zero eigenvalues of a symmetric matrix (Sylvester)."""

    negative: int
    zero: int


class Factorisation:
    """LDLᵀ factor of one symmetric matrix whose entries change."""

    def __init__(self, ksp: PETSc.KSP, matrix: PETSc.Mat) -> None:
        """Set up `ksp` to solve with `matrix` directly."""
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

    def update(self) -> None:
        """Factorise the matrix as it is now."""
        self._ksp.setOperators(self._matrix)
        self._ksp.setUp()

    def solve(self, right: PETSc.Vec, x: PETSc.Vec) -> None:
        """Back-substitute with the last factor."""
        self._ksp.solve(right, x)

    @property
    def inertia(self) -> Inertia:
        """Inertia of the matrix last factorised."""
        negative, zero, _ = self._ksp.getPC().getFactorMatrix().getInertia()
        return Inertia(negative, zero)
