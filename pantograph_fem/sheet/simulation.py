"""A sheet as a run sees it: a path to follow, and what there is to observe at each state."""

from __future__ import annotations

from mpi4py import MPI

from ..case import Case
from ..results.fields import FieldGrid
from ..results.history import HistoryRow
from ..simulation import Observation
from ..solve.continuation import Array, Step
from ..solve.newton import NewtonSettings
from ..stopwatch import Stopwatch
from .build import build_domain, build_grips, discretise
from .domain import GRIPS
from .equilibrium import SheetEquilibrium
from .path import SheetPath
from .probes import Probes
from .sampling import FieldSampler

_REPORTED = GRIPS.index("top")


class SheetSimulation:
    """Implements :class:`pantograph_fem.simulation.Simulation` for ``kind = "sheet"``."""

    def __init__(self, case: Case, comm: MPI.Comm, clock: Stopwatch) -> None:
        """Mesh the sheet and compile its forms; a collective call."""
        with clock("mesh"):
            domain = build_domain(case, comm)
        with clock("compile"):
            discretisation = discretise(case, domain)
            self._sampler = FieldSampler(discretisation, domain.mesh)
        self._probes = Probes(discretisation, domain.mesh, case.output.probes)
        self._equilibrium = SheetEquilibrium(discretisation, build_grips(case, domain), clock)
        options = case.continuation
        self.path = SheetPath(
            self._equilibrium,
            NewtonSettings(options.tolerance, options.max_iterations),
            clock,
        )
        self.cells = int(domain.mesh.topology.index_map(2).size_global)
        self.dofs = {field.name: field.size for field in discretisation.fields}

    @property
    def start(self) -> Array:
        """The state of rest."""
        return self._equilibrium.undeformed()

    def grid(self) -> FieldGrid | None:
        """Nodes of the fields on rank 0, None elsewhere; a collective call."""
        grid = self._sampler.grid()
        return None if grid is None else FieldGrid(*grid)

    def observe(self, step: Step) -> Observation | None:
        """Numbers and fields of a state on rank 0, None elsewhere; a collective call."""
        reaction = self._equilibrium.reactions(step.x, step.load)[_REPORTED]
        energies = self._equilibrium.energies(step.x)
        probes = self._probes.displacements()
        fields = self._sampler.sample()
        if fields is None:
            return None
        shear = fields["shear_angle"]
        row = HistoryRow(
            step=step.number,
            load=step.load,
            force=reaction.force,
            moment=reaction.moment,
            energies=energies,
            newton_iterations=step.iterations,
            negative_pivots=step.linearisation.negative_pivots,
            expected_negative_pivots=step.linearisation.expected_negative_pivots,
            stable=step.linearisation.stable,
            shear_min=float(shear.min()),
            shear_max=float(shear.max()),
            probes=tuple((float(ux), float(uy)) for ux, uy in probes),
        )
        return Observation(row, fields)
