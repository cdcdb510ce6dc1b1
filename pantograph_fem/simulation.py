"""What a run needs of a simulation, whatever is simulated."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from .case import BeamCase, ChainCase, LatticeCase, SheetCase
from .results.fields import FieldGrid
from .results.history import HistoryRow
from .solve.continuation import Step
from .solve.equilibrium import Array, ModalEquilibrium
from .stopwatch import Stopwatch

if TYPE_CHECKING:
    from mpi4py import MPI

    from .case import Case
    from .continuum.element_files import ElementFiles


@dataclass(frozen=True, eq=False)
class Observation:
    """What is reported of a state: a row of ``history.csv``, and fields by name.

    `fields` has values on the nodes of the grid, `cell_fields` on its cells.
    """

    row: HistoryRow
    fields: dict[str, Array]
    cell_fields: dict[str, Array] = field(default_factory=dict)


class Simulation(Protocol):
    """A problem to follow, and how to look at its states. Every method is collective."""

    cells: int
    dofs: dict[str, int]
    #: Names of the columns of ``history.csv`` between `shear_max` and the probes, in order.
    extra_columns: tuple[str, ...]

    @property
    def path(self) -> ModalEquilibrium:
        """The problem for continuation."""

    @property
    def start(self) -> Array:
        """The state at load factor 0."""

    @property
    def unknowns(self) -> Array:
        """What each owned unknown is, however it is numbered, shape (n, 3).

        A number for its component of its field, and where in the reference shape it is.
        """

    def grid(self) -> FieldGrid | None:
        """Nodes of the fields on rank 0, None elsewhere."""

    def observe(self, step: Step) -> Observation | None:
        """Numbers and fields of a state on rank 0, None elsewhere."""

    def displacement(self, x: Array, load: float) -> Array | None:
        """Displacement of a state, or of a mode, on the nodes of the fields, shape (n, 2).

        On rank 0, None elsewhere.
        """


@runtime_checkable
class OnElements(Protocol):
    """A simulation whose displacement is a function on a mesh of finite elements."""

    def element_files(self, directory: Path, kept: int) -> ElementFiles:
        """A writer of the displacement on the elements; a collective call."""


def build_simulation(case: Case, comm: MPI.Comm, clock: Stopwatch) -> Simulation:
    """The simulation of a case's kind; only that kind's code is imported."""
    match case:
        case SheetCase():
            from .sheet.simulation import SheetSimulation

            return SheetSimulation(case, comm, clock)
        case BeamCase():
            from .beam.simulation import BeamSimulation

            return BeamSimulation(case, comm, clock)
        case LatticeCase():
            from .lattice.simulation import LatticeSimulation

            return LatticeSimulation(case, comm, clock)
        case ChainCase():
            from .lattice.simulation import ChainSimulation

            return ChainSimulation(case, comm, clock)
    raise NotImplementedError(case.kind)
