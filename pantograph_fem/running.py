"""One case from start to end: case → simulation → path → results."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from . import checkpoint
from .case import SheetCase
from .errors import CaseError, PathError
from .parallel import at_root
from .recorder import Recorder
from .results.failure import write_failure
from .results.history import HistoryRow
from .results.progress import Progress
from .results.summary import CRITICAL, DONE
from .simulation import Simulation, build_simulation
from .solve.arc_length import follow_arc_length
from .solve.continuation import Checkpoint, Step, follow, start_at
from .stepping import step_settings
from .stopwatch import Stopwatch

if TYPE_CHECKING:
    from mpi4py import MPI

    from .adapt.accuracy import Accuracy
    from .case import Case


@dataclass(frozen=True)
class RunResult:
    """Outcome of a run.

    Attributes
    ----------
    directory
        Where the results are.
    rows
        A row per accepted step of this run; empty on ranks other than 0.
    """

    directory: Path
    rows: tuple[HistoryRow, ...]


def run(
    case: Case,
    directory: Path | None = None,
    *,
    resume: bool = False,
    quiet: bool = False,
    comm: MPI.Comm | None = None,
) -> RunResult:
    """Simulate a case and write its results; a collective call.

    Parameters
    ----------
    case
        What to simulate.
    directory
        Where results go; ``results/<name>`` by default. Earlier results there are replaced.
    resume
        Go on from the last state of an interrupted run in that directory, if there is one.
    quiet
        Show no progress.
    comm
        MPI communicator; all processes by default.

    Raises
    ------
    CaseError
        If the directory cannot be written to; if the mesh or a probe is wrong, which shows only
        here; if what is to be resumed belongs to another case.
    PathError
        If the path could not be followed to the end. The results up to there are complete, and
        ``failure.json`` tells more.
    """
    if comm is None:
        from mpi4py import MPI

        comm = MPI.COMM_WORLD
    clock = Stopwatch()
    directory = directory or Path("results") / case.name
    at_root(comm, lambda: _check_folder(directory))
    resumed = resume and checkpoint.is_there(directory, comm, case)
    simulation, accuracy = _simulation(case, directory, clock, comm, quiet, resumed)
    saved = checkpoint.load(directory, comm, simulation.unknowns) if resumed else None
    recorder = Recorder(case, simulation, directory, clock, comm, quiet, saved, accuracy)
    start = saved.checkpoint if saved else start_at(simulation.start)
    status = DONE
    try:
        with recorder:
            for step in _steps(case, simulation, start, recorder):
                recorder.accepted(step)
                stop = step.critical is not None and case.continuation.on_instability == "stop"
                status = CRITICAL if stop else DONE
    except PathError as error:
        found = error
        at_root(comm, lambda: write_failure(directory, found))
        recorder.finish(f"stopped: {error}")
        raise
    recorder.finish(status)
    return RunResult(directory, tuple(recorder.rows))


def _steps(
    case: Case, simulation: Simulation, start: Checkpoint, recorder: Recorder
) -> Iterator[Step]:
    """The path by the method of the case."""
    options, path = case.continuation, simulation.path
    if options.method == "arc_length":
        return follow_arc_length(
            path,
            start,
            step_settings(case),
            simulation.start,
            options.max_steps,
            recorder.rejected,
            options.on_instability,
        )
    return follow(
        path,
        start,
        step_settings(case),
        options.predictor,
        recorder.rejected,
        path,
        options.on_instability,
    )


def _simulation(
    case: Case, directory: Path, clock: Stopwatch, comm: MPI.Comm, quiet: bool, resumed: bool
) -> tuple[Simulation, Accuracy | None]:
    """What is simulated, on the mesh of the case or on one that is adapted to it."""
    if not (isinstance(case, SheetCase) and case.mesh.adapt):
        return build_simulation(case, comm, clock), None
    from .adapt.adapted_sheet import adapted_sheet, resumed_sheet

    if resumed:
        return resumed_sheet(case, comm, clock, directory)
    lines = Progress(quiet=quiet or comm.rank != 0, plain=True)
    return adapted_sheet(case, comm, clock, step_settings(case), directory, lines.note)


def _check_folder(directory: Path) -> None:
    """Fail before anything is computed if results could not be written."""
    path = directory.absolute()
    existing = next(place for place in (path, *path.parents) if place.exists())
    if not existing.is_dir() or not os.access(existing, os.W_OK | os.X_OK):
        what = "is not writable" if existing.is_dir() else "is a file"
        raise CaseError(
            f"--output: {directory} cannot hold results, because {existing} {what}; "
            "give a folder that can be made or written to"
        )
