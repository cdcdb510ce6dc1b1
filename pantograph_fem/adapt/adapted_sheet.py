"""The sheet of a case on a mesh with which it is as accurate as the case asks."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from mpi4py import MPI

from ..case import SheetCase
from ..parallel import at_root
from ..sheet.simulation import SheetSimulation
from ..solve.step_size import StepSettings
from ..stopwatch import Stopwatch
from .accuracy import Accuracy
from .adaptive import adapt
from .saved import load_mesh, save_mesh
from .sheet_level import SheetLevel


def adapted_sheet(
    case: SheetCase,
    comm: MPI.Comm,
    clock: Stopwatch,
    steps: StepSettings,
    directory: Path,
    tell: Callable[[str], None],
) -> tuple[SheetSimulation, Accuracy]:
    """Refine until the accuracy is reached, and save the last mesh; a collective call.

    Parameters
    ----------
    case
        A sheet whose mesh is adapted.
    comm, clock
        Of the run.
    steps
        Of the path.
    directory
        Where the results go.
    tell
        Called with a line about each mesh, on every process.
    """
    first = SheetLevel(case, comm, clock, steps)
    level, accuracy = adapt(first, case.mesh.accuracy_of, case.mesh.accuracy, tell)

    def save() -> None:
        assert level.triangulation is not None
        save_mesh(directory, level.triangulation, accuracy)

    at_root(comm, save)
    return level.simulation, accuracy


def resumed_sheet(
    case: SheetCase, comm: MPI.Comm, clock: Stopwatch, directory: Path
) -> tuple[SheetSimulation, Accuracy]:
    """The sheet on the mesh of an interrupted run; a collective call.

    Raises
    ------
    CaseError
        If the mesh cannot be read.
    """
    mesh, accuracy = at_root(comm, lambda: load_mesh(directory)) or (None, None)
    return SheetSimulation(case, comm, clock, mesh), comm.bcast(accuracy, root=0)
