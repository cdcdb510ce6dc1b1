"""The end of a command on several processes: all of them come to it, or the run is aborted.

Errors that belong to the run are raised on every process. One that a single process meets, as when
its memory runs out, would leave the others waiting for it for ever.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mpi4py import MPI

#: Seconds within which processes that have the same error come to their end.
_PATIENCE = 10.0

_guard: MPI.Comm | None = None


def guard(comm: MPI.Comm) -> None:
    """Have the processes of `comm` watched from now on; a collective call."""
    global _guard
    if _guard is None and comm.size > 1:
        _guard = comm.Dup()  # apart from what the run sends


def guarded() -> bool:
    """Whether the processes are watched."""
    return _guard is not None


def alone() -> bool:
    """Whether other processes do not come to their end with this one."""
    if _guard is None:
        return False
    arrived = _guard.Ibarrier()
    deadline = time.monotonic() + _PATIENCE
    while not arrived.Test():
        if time.monotonic() > deadline:
            return True
        time.sleep(0.01)
    return False


def abort(code: int) -> None:
    """End all processes with an exit code."""
    if _guard is not None:
        _guard.Abort(code)
