"""How large a change of state is, whatever the units and the mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mpi4py import MPI

from .problem import Problem

Array = NDArray[np.float64]


def free_unknowns(problem: Problem) -> NDArray[np.bool_]:
    """Which of the owned unknowns the load factor does not prescribe."""
    nowhere = np.full_like(problem.typical_sizes, np.nan)
    return np.isnan(problem.impose(nowhere, 0.0))


class Metric:
    """Means over the displacement, measured in typical sizes.

    Attributes
    ----------
    free
        Which of the owned unknowns are not held.
    weights
        Share of each owned unknown in the means, 0 where it is held or is no displacement.
    """

    def __init__(self, problem: Problem, comm: MPI.Comm, weights: Array | None = None) -> None:
        """By default all free unknowns have the same share, and their sum is one."""
        self._typical = problem.typical_sizes
        self._comm = comm
        self.free = free_unknowns(problem)
        if weights is None:
            weights = np.full(len(self.free), 1.0 / comm.allreduce(int(self.free.sum()), MPI.SUM))
        self.weights: Array = self.free * weights

    def inner(self, a: Array, b: Array) -> float:
        """Mean product of two states; a collective call."""
        square = self._typical**2
        return self._comm.allreduce(float(np.sum(self.weights * a * b / square)), MPI.SUM)

    def largest(self, a: Array) -> float:
        """Largest of all unknowns; a collective call."""
        return self._comm.allreduce(float(np.abs(a / self._typical).max(initial=0.0)), MPI.MAX)
