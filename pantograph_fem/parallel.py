"""Work that one MPI rank does for all, with errors that reach every rank."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from mpi4py import MPI

T = TypeVar("T")


def at_root(comm: MPI.Comm, action: Callable[[], T]) -> T | None:
    """Call `action` on rank 0 and return its value there, None elsewhere; a collective call.

    An error raised there is raised on every rank, so that none waits for ever.
    """
    value: T | None = None
    error: BaseException | None = None
    if comm.rank == 0:
        try:
            value = action()
        except BaseException as caught:
            error = caught
    error = comm.bcast(error, root=0)
    if error is not None:
        raise error
    return value
