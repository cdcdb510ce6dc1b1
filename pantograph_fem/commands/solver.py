"""What simulates a case, imported when a case is there to be simulated."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..running import RunResult


def solver() -> Callable[..., RunResult]:
    """Import what simulates a case; only for a case that is right, as it takes seconds."""
    # The fronts of the factorisation are small: threads cost more than they bring.
    for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(threads, "1")
    # A process that is not under mpirun needs no daemon of Open MPI; many at a time get in each
    # other's way.
    os.environ.setdefault("OMPI_MCA_ess_singleton_isolated", "1")
    # PETSc of a wheel finds the MPI that comes beside it once that is loaded.
    import mpi4py.MPI
    import petsc4py

    from .ending import guard

    guard(mpi4py.MPI.COMM_WORLD)

    # A closed pipe or an interrupt is no crash: no PETSc report of a segmentation fault.
    petsc4py.init(["pantograph", "-no_signal_handler"])
    from ..running import run

    return run
