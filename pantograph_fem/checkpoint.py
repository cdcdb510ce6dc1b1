"""The file ``checkpoint.npz``: what an interrupted run goes on from."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from .errors import CaseError
from .numbering import same_points
from .parallel import at_root
from .solve.continuation import Checkpoint
from .solve.predictor import PathPoint

if TYPE_CHECKING:
    from mpi4py import MPI

    from .case import Case

Array = NDArray[np.float64]

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


def gathered(comm: MPI.Comm, unknowns: Array) -> Array | None:
    """What each unknown of every process is, on rank 0, None elsewhere; a collective call."""
    parts = comm.gather(unknowns, root=0)
    return None if parts is None else np.concatenate(parts)


def save(
    directory: Path, comm: MPI.Comm, case_fingerprint: str, unknowns: Array | None, saved: Saved
) -> None:
    """Replace the checkpoint of a run in one step; a collective call.

    `unknowns` are those that were :func:`gathered`.
    """
    checkpoint = saved.checkpoint
    own = {}
    for i, point in enumerate(checkpoint.points):
        assert point.rate is not None  # accepted states have it
        own[f"point_{i}"] = np.column_stack([point.x, point.rate])
    parts = comm.gather(own, root=0)

    def write() -> None:
        assert parts is not None
        arrays: dict[str, Any] = {
            "fingerprint": case_fingerprint,
            "counts": [checkpoint.number, checkpoint.iterations, saved.rows, saved.states],
            "step_size": checkpoint.step_size,
            "critical_points": json.dumps(saved.critical_points),
            "loads": [point.load for point in checkpoint.points],
            "unknowns": unknowns,
        }
        for name in own:
            arrays[name] = np.concatenate([part[name] for part in parts])
        aside = directory / (NAME + ".part")
        with aside.open("wb") as file:
            np.savez(file, **arrays)
            file.flush()
            os.fsync(file.fileno())
        os.replace(aside, directory / NAME)

    at_root(comm, write)


def is_there(directory: Path, comm: MPI.Comm, case: Case) -> bool:
    """Whether an earlier run of the case has left a checkpoint; a collective call.

    Raises
    ------
    CaseError
        If it is damaged, of an earlier version of the program, or belongs to another case.
    """
    path = directory / NAME

    def look() -> bool:
        if not path.is_file():
            return False
        with _opened(path) as file:
            if str(file["fingerprint"]) != fingerprint(case):
                raise CaseError(
                    f"{path} belongs to another case: only the sections {', '.join(sorted(_FREE))} "
                    "may differ from those of the interrupted run; start anew without --resume"
                )
            if "unknowns" not in file.files:
                raise CaseError(
                    f"{path} was written by an earlier version of pantograph_fem, which did not "
                    "say what its numbers stand for; start anew without --resume"
                )
        return True

    return comm.bcast(at_root(comm, look), root=0)


def load(directory: Path, comm: MPI.Comm, unknowns: Array) -> Saved:
    """The checkpoint of an earlier run for the unknowns that there are now; a collective call.

    The earlier run may have had another number of processes, or numbered its unknowns otherwise.
    `unknowns` tells what each owned one is: see :attr:`.simulation.Simulation.unknowns`.

    Raises
    ------
    CaseError
        If it is damaged, or belongs to other unknowns.
    """
    path = directory / NAME
    everyone = comm.gather(unknowns, root=0)

    def read() -> list[Saved]:
        assert everyone is not None
        with _opened(path) as file:
            number, iterations, rows, states = (int(n) for n in file["counts"])
            critical_points = tuple(json.loads(str(file["critical_points"])))
            step_size, loads = float(file["step_size"]), file["loads"].tolist()
            points = [file[f"point_{i}"] for i in range(len(loads))]
            known = file["unknowns"]
        try:
            order = same_points(known, np.concatenate(everyone))
        except ValueError as error:
            raise CaseError(
                f"{path} belongs to another mesh ({error}), as another version of gmsh or of "
                "this program makes; start anew without --resume"
            ) from None
        shares = np.split(order, np.cumsum([len(part) for part in everyone])[:-1])
        return [
            Saved(
                Checkpoint(
                    tuple(
                        PathPoint(load, *np.ascontiguousarray(point[share].T))
                        for load, point in zip(loads, points, strict=True)
                    ),
                    number,
                    iterations,
                    step_size,
                ),
                rows,
                states,
                critical_points,
            )
            for share in shares
        ]

    return comm.scatter(at_root(comm, read) or [], root=0)


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    """The arrays of a checkpoint by their names."""
    try:
        with np.load(path) as file:
            yield file
    except (ValueError, KeyError, OSError, EOFError, BadZipFile) as error:
        raise CaseError(f"{path} is damaged ({error}); start anew without --resume") from error
