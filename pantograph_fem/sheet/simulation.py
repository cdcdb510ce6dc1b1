"""A sheet as a run sees it: a path to follow, and what there is to observe at each state."""

from __future__ import annotations

from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mpi4py import MPI

from ..case import SheetCase
from ..continuum.element_files import ElementFiles
from ..continuum.equilibrium import ContinuumEquilibrium
from ..continuum.probes import Probes
from ..continuum.sampling import FieldSampler
from ..continuum.weights import displacement_weights
from ..mesh import Triangulation
from ..physics.reaction import Reaction
from ..reporting import history_row
from ..results.fields import FieldGrid
from ..simulation import Observation
from ..solve.continuation import Array, Step
from ..solve.failure import Remedies
from ..solve.newton_settings import NewtonSettings
from ..solve.path import NewtonPath
from ..stopwatch import Stopwatch
from .build import build_domain, build_grips, discretise_sheet
from .domain import GRIPS
from .fold import FoldCheck
from .grip import GripSupport
from .observables import sheet_observables

if TYPE_CHECKING:
    from .measurements import SheetMeasurements

#: Stretch stiffness, over what else resists, from which fibres hardly stretch. The paper's: 840.
_INEXTENSIBLE = 1e5
#: Degree from which elements do not lock then.
_FREE = 5
_REPORTED = GRIPS.index("top")


class SheetSimulation:
    """Implements :class:`pantograph_fem.simulation.Simulation` for ``kind = "sheet"``."""

    extra_columns: tuple[str, ...] = ()

    def __init__(
        self,
        case: SheetCase,
        comm: MPI.Comm,
        clock: Stopwatch,
        triangulation: Triangulation | None = None,
    ) -> None:
        """Mesh the sheet and compile its forms; a collective call.

        A `triangulation` on rank 0 takes the place of the one that the case asks for.
        """
        self._clock = clock
        with clock("mesh"):
            domain = build_domain(case, comm, triangulation)
        with clock("compile"):
            discretisation = discretise_sheet(case, domain)
        self._domain = domain.mesh
        self._probes = Probes(discretisation, domain.mesh, case.output.probes)
        self.measurements: SheetMeasurements | None = None
        if case.measurements:
            from .measurements import SheetMeasurements

            self.measurements = SheetMeasurements(case, discretisation, domain.mesh)
            self.extra_columns = self.measurements.columns
        supports = [GripSupport(grip, discretisation) for grip in build_grips(case, domain)]
        with clock("compile"):
            check = FoldCheck(discretisation, domain.mesh)
        self.equilibrium = ContinuumEquilibrium(
            discretisation, supports, clock, check, _remedies(case)
        )
        options = case.continuation
        self.path = NewtonPath(
            self.equilibrium,
            NewtonSettings(options.tolerance, options.max_iterations),
            clock,
            partial(displacement_weights, discretisation, domain.mesh),
            case.output.eigenvalues,
        )
        self.cells = int(domain.mesh.topology.index_map(2).size_global)
        self.dofs = {field.name: field.size for field in discretisation.fields}

    @property
    def start(self) -> Array:
        """The state of rest."""
        return self.equilibrium.undeformed()

    @property
    def unknowns(self) -> Array:
        """What each owned unknown is: see :attr:`.Simulation.unknowns`."""
        return self.equilibrium.unknowns

    @cached_property
    def _sampler(self) -> FieldSampler:
        """Only where fields are looked at: most meshes on the way to a better one are not."""
        discretisation = self.equilibrium.discretisation
        with self._clock("compile"):
            return FieldSampler(discretisation, self._domain, sheet_observables(discretisation))

    def grid(self) -> FieldGrid | None:
        """Nodes of the fields on rank 0, None elsewhere; a collective call."""
        grid = self._sampler.grid()
        return None if grid is None else FieldGrid(*grid)

    def element_files(self, directory: Path, kept: int) -> ElementFiles:
        """A writer of the displacement on the elements; a collective call."""
        return ElementFiles(self.equilibrium.discretisation, self._domain, directory, kept)

    def reaction(self, x: Array, load: float) -> Reaction:
        """What the top grip exerts; a collective call."""
        return self.equilibrium.reactions(x, load)[_REPORTED]

    def displacement(self, x: Array, load: float) -> Array | None:
        """Displacement on the nodes of the fields on rank 0, None elsewhere; a collective call."""
        self.equilibrium.load_state(x, load)
        fields = self._sampler.sample()
        return None if fields is None else fields["displacement"]

    def observe(self, step: Step) -> Observation | None:
        """Numbers and fields of a state on rank 0, None elsewhere; a collective call."""
        reaction = self.reaction(step.x, step.load)
        energies = self.equilibrium.energies(step.x, step.load)
        probes = self._probes.displacements()
        readings = None if self.measurements is None else self.measurements.read()
        fields = self._sampler.sample()
        if fields is None:
            return None
        angles = fields["shear_angle"]
        shear = float(angles.min()), float(angles.max())
        row = history_row(step, reaction, energies, shear=shear, probes=probes, extra=readings)
        return Observation(row, fields)


def _remedies(case: SheetCase) -> Remedies:
    """What the case can change."""
    own = case.mesh.file is not None
    missing = tuple(
        f"material.{name}"
        for name in ("stretch", "bending", "shear")
        if not getattr(case.material, name)
    )
    if _locks(case):
        return Remedies("discretisation.degree = 5, as elements of low degree lock", missing)
    return Remedies("a finer mesh" if own else "a finer mesh (a smaller mesh.corner_size)", missing)


def _locks(case: SheetCase) -> bool:
    """Whether fibres can hardly stretch for elements whose degree is too low for that."""
    material = case.material
    K_e, K_b = (np.max(value or 0.0) for value in (material.stretch, material.bending))
    easy = max(material.shear or 0.0, K_b / case.sheet.width**2)
    return bool(K_e > _INEXTENSIBLE * easy) and case.discretisation.degree < _FREE
