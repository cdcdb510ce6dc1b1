"""A beam as a run sees it: a path to follow, and what there is to observe at each state."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np

from mpi4py import MPI

from ..case import BeamCase
from ..continuum.element_files import ElementFiles
from ..continuum.equilibrium import ContinuumEquilibrium
from ..continuum.probes import Probes
from ..continuum.sampling import FieldSampler
from ..continuum.weights import displacement_weights
from ..reporting import TIP_COLUMNS, history_row, tip_columns
from ..results.fields import FieldGrid
from ..simulation import Observation
from ..solve.continuation import Array, Step
from ..solve.failure import Remedies
from ..solve.newton_settings import NewtonSettings
from ..solve.path import NewtonPath
from ..stopwatch import Stopwatch
from .build import build_axis, build_supports, discretise_beam
from .domain import ENDS
from .fold import FoldCheck
from .observables import AXIS, beam_observables

_REPORTED = ENDS.index("right")


class BeamSimulation:
    """Implements :class:`pantograph_fem.simulation.Simulation` for ``kind = "beam"``."""

    def __init__(self, case: BeamCase, comm: MPI.Comm, clock: Stopwatch) -> None:
        """Mesh the beam and compile its forms; a collective call."""
        with clock("mesh"):
            axis = build_axis(case, comm)
        with clock("compile"):
            discretisation = discretise_beam(case, axis)
            sampler = FieldSampler(discretisation, axis.mesh, beam_observables(discretisation))
            supports = build_supports(case, discretisation, axis)
            check = FoldCheck(discretisation, axis)
        self._mesh = axis.mesh
        self._sampler = sampler
        nodes = sampler.grid()
        # of the nodes from left to right, on rank 0
        self._order = np.empty(0, dtype=int) if nodes is None else np.argsort(nodes[0][:, 0])
        self._nodes = None if nodes is None else nodes[0][self._order]
        self._probes = Probes(discretisation, axis.mesh, case.output.probes)
        self._equilibrium = ContinuumEquilibrium(
            discretisation, supports, clock, check, _remedies(case)
        )
        options = case.continuation
        self.path = NewtonPath(
            self._equilibrium,
            NewtonSettings(options.tolerance, options.max_iterations),
            clock,
            partial(displacement_weights, discretisation, axis.mesh),
            case.output.eigenvalues,
        )
        self.cells = int(axis.mesh.topology.index_map(1).size_global)
        self.dofs = {field.name: field.size for field in discretisation.fields}
        effects = ["energy_foundation"] if "foundation" in discretisation.densities else []
        self.extra_columns = (*effects, *TIP_COLUMNS)

    @property
    def start(self) -> Array:
        """The state of rest."""
        return self._equilibrium.undeformed()

    @property
    def unknowns(self) -> Array:
        """What each owned unknown is: see :attr:`.Simulation.unknowns`."""
        return self._equilibrium.unknowns

    def grid(self) -> FieldGrid | None:
        """Nodes along the axis on rank 0, None elsewhere."""
        if self._nodes is None:
            return None
        numbers = np.arange(len(self._nodes))
        return FieldGrid(self._nodes, np.column_stack([numbers[:-1], numbers[1:]]))

    def element_files(self, directory: Path, kept: int) -> ElementFiles:
        """A writer of the displacement on the elements; a collective call."""
        return ElementFiles(self._equilibrium.discretisation, self._mesh, directory, kept)

    def displacement(self, x: Array, load: float) -> Array | None:
        """Displacement along the axis on rank 0, None elsewhere; a collective call."""
        self._equilibrium.load_state(x, load)
        fields = self._sampler.sample()
        return None if fields is None else fields["displacement"][self._order]

    def observe(self, step: Step) -> Observation | None:
        """Numbers and fields of a state on rank 0, None elsewhere; a collective call."""
        reaction = self._equilibrium.reactions(step.x, step.load)[_REPORTED]
        energies = self._equilibrium.energies(step.x, step.load)
        probes = self._probes.displacements()
        sampled = self._sampler.sample()
        if sampled is None:
            return None
        fields = {name: values[self._order] for name, values in sampled.items()}
        x, y = (fields.pop(name) for name in AXIS)
        # The beam turns continuously along its axis, by more than half a turn if it must.
        fields["angle"] = np.unwrap(np.arctan2(y, x))
        row = history_row(
            step,
            reaction,
            energies,
            extra=tip_columns(fields["displacement"][-1], fields["angle"][-1]),
            probes=probes,
        )
        return Observation(row, fields)


def _remedies(case: BeamCase) -> Remedies:
    """What the case can change."""
    missing = tuple(
        f"material.{name}" for name in ("stretch", "bending") if not getattr(case.material, name)
    )
    return Remedies("a finer mesh (a smaller mesh.size)", missing)
