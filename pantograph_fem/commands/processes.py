"""What a command knows of mpirun before MPI is imported: Open MPI's environment, or MPICH's."""

from __future__ import annotations

import os


def rank() -> int:
    """Rank of this process."""
    return int(os.environ.get("OMPI_COMM_WORLD_RANK") or os.environ.get("PMI_RANK") or 0)


def processes() -> int:
    """Number of processes."""
    return int(os.environ.get("OMPI_COMM_WORLD_SIZE") or os.environ.get("PMI_SIZE") or 1)
