"""Solvers for equilibrium problems that they know only by residual, tangent and load rate."""

# PETSc of a wheel finds the MPI that comes beside it once that is loaded.
from mpi4py import MPI  # noqa: F401
