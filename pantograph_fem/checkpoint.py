"""The file ``checkpoint.npz``: what an interrupted run goes on from."""

from __future__ import annotations

import hashlib
import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import BadZipFile

import numpy as np

from .errors import CaseError
from .parallel import at_root
from .solve.continuation import Checkpoint
from .solve.predictor import PathPoint

if TYPE_CHECKING:
    from mpi4py import MPI

    from .case import Case

NAME = "checkpoint.npz"
#: Sections of a case that may differ between the parts of a run: they change no equilibrium.
_FREE = {"title", "continuation", "output"}


@dataclass(frozen=True)
class Saved:
    """A checkpoint, and what the results held before its state was added.

    Attributes
    ----------
    checkpoint
        From which the path goes on.
    rows, states
        Number of rows and states.
    critical_points
        As in ``summary.json``; those that rank 0 gives are saved.
    """

    checkpoint: Checkpoint
    rows: int
    states: int
    critical_points: tuple[dict[str, Any], ...] = ()


def fingerprint(case: Case) -> str:
    """Hash of what determines the equilibria of a case."""
    physics = case.model_dump(mode="json", exclude=_FREE)
    digest = hashlib.sha256(json.dumps(physics, sort_keys=True).encode())
    for path in case.input_files:
        digest.update(path.read_bytes())
    return digest.hexdigest()


def save(directory: Path, comm: MPI.Comm, case_fingerprint: str, saved: Saved) -> None:
    """Replace the checkpoint of a run in one step; a collective call."""
    checkpoint = saved.checkpoint
    parts = comm.gather([(point.load, point.x, point.rate) for point in checkpoint.points], root=0)

    def write() -> None:
        arrays: dict[str, Any] = {
            "fingerprint": case_fingerprint,
            "ranks": comm.size,
            "counts": [checkpoint.number, checkpoint.iterations, saved.rows, saved.states],
            "step_size": checkpoint.step_size,
            "critical_points": json.dumps(saved.critical_points),
        }
        for rank, points in enumerate(parts or []):
            for i, (load, x, rate) in enumerate(points):
                arrays[f"{rank}_{i}"] = np.stack([x, rate])
                arrays[f"load_{i}"] = load
        aside = directory / (NAME + ".part")
        with aside.open("wb") as file:
            np.savez(file, **arrays)
            file.flush()
            os.fsync(file.fileno())
        os.replace(aside, directory / NAME)

    at_root(comm, write)


def load(directory: Path, comm: MPI.Comm, case: Case) -> Saved | None:
    """The checkpoint of an earlier run, None if there is none; a collective call.

    Raises
    ------
    CaseError
        If it is damaged, or belongs to another case or another number of processes.
    """
    path = directory / NAME

    def read() -> list[Saved | None]:
        if not path.is_file():
            return [None] * comm.size
        with np.load(path) as file:
            if str(file["fingerprint"]) != fingerprint(case):
                raise CaseError(
                    f"{path} belongs to another case: only the sections {', '.join(sorted(_FREE))} "
                    "may differ from those of the interrupted run; start anew without --resume"
                )
            if int(file["ranks"]) != comm.size:
                raise CaseError(
                    f"{path} was written by {int(file['ranks'])} processes and cannot be taken up "
                    f"by {comm.size}; use the same number, or start anew without --resume"
                )
            number, iterations, rows, states = (int(n) for n in file["counts"])
            # without them in files of earlier versions
            known = str(file["critical_points"]) if "critical_points" in file.files else "[]"
            critical_points = tuple(json.loads(known))
            count = sum(name.startswith("load_") for name in file.files)
            return [
                Saved(
                    Checkpoint(
                        tuple(
                            PathPoint(float(file[f"load_{i}"]), *file[f"{rank}_{i}"])
                            for i in range(count)
                        ),
                        number,
                        iterations,
                        float(file["step_size"]),
                    ),
                    rows,
                    states,
                    critical_points,
                )
                for rank in range(comm.size)
            ]

    def read_or_explain() -> list[Saved | None]:
        try:
            return read()
        except (ValueError, KeyError, OSError, EOFError, BadZipFile) as error:
            raise CaseError(f"{path} is damaged ({error}); start anew without --resume") from error

    return comm.scatter(at_root(comm, read_or_explain) or [], root=0)
