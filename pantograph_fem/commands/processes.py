"""What a command knows of other processes before MPI is imported, from the environment.

Open MPI's mpirun, MPICH's, and Slurm's srun leave it there.
"""

from __future__ import annotations

import os


def rank() -> int:
    """Rank of this process."""
    names = ("OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK")
    return int(next((os.environ[name] for name in names if os.environ.get(name)), 0))


def processes() -> int:
    """Number of processes."""
    names = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"]
    if "PMIX_RANK" in os.environ:  # else it is of a script that srun has not started in parallel
        names.append("SLURM_NTASKS")
    return int(next((os.environ[name] for name in names if os.environ.get(name)), 1))
