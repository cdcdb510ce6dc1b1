"""A mesh of a sheet with its problem, as the loop of adaptive refinement sees it."""

from __future__ import annotations

from dataclasses import replace

from mpi4py import MPI

from ..case import SheetCase
from ..mesh import Triangulation, rectangle_by_sizes
from ..parallel import at_root
from ..sheet.build import triangulate
from ..sheet.simulation import SheetSimulation
from ..solve.continuation import Array, follow, start_at
from ..solve.step_size import StepSettings
from ..stopwatch import Stopwatch
from .accuracy import FullLoad
from .indicator import ErrorIndicator
from .sizes import new_sizes
from .transfer import transferred

_FULL = 1.0


class SheetLevel:
    """Implements :class:`pantograph_fem.adapt.adaptive.Level`.

    Attributes
    ----------
    simulation
        The sheet on this mesh.
    triangulation
        The mesh on rank 0, None elsewhere.
    """

    def __init__(
        self,
        case: SheetCase,
        comm: MPI.Comm,
        clock: Stopwatch,
        steps: StepSettings,
        triangulation: Triangulation | None = None,
    ) -> None:
        """Set up the problem on a mesh, by default that of the case; a collective call."""
        self._case, self._comm, self._clock = case, comm, clock
        self._steps = replace(steps, stops=(_FULL,))
        with clock("mesh"):
            self.triangulation = at_root(comm, lambda: triangulation or triangulate(case))
        self.simulation = SheetSimulation(case, comm, clock, self.triangulation)

    @property
    def cells(self) -> int:
        """Number of cells."""
        return self.simulation.cells

    @property
    def unknowns(self) -> int:
        """Number of dofs of all fields."""
        return sum(self.simulation.dofs.values())

    @property
    def order(self) -> float:
        """That of the curvatures, or without bending that of the strains."""
        degree = self._case.discretisation.degree
        return float(degree if self._case.material.bending is None else degree - 1)

    def solve_from(self, coarser: SheetLevel) -> FullLoad | None:
        """The state at full load by Newton's method from that of a coarser mesh, or None."""
        equilibrium = self.simulation.equilibrium
        guess = transferred(coarser.simulation.equilibrium.discretisation, equilibrium, _FULL)
        found = self.simulation.path.correct(guess, _FULL)
        if not found.converged:  # slow progress at the corners; still cheaper than the path
            found = self.simulation.path.correct(found.x, _FULL)
        if not found.converged:
            return None
        state = self.simulation.path.linearise(found.x, _FULL)
        return self._full_load(state.x, state.stable)

    def follow(self) -> FullLoad:
        """The state at the end of the path; where that stops, the last state stays.

        Raises
        ------
        PathError
            If the path stops.
        """
        simulation = self.simulation
        steps = follow(
            simulation.path,
            start_at(simulation.start),
            self._steps,
            self._case.continuation.predictor,
        )
        last = next(steps)
        try:
            for step in steps:
                last = step
        finally:
            simulation.equilibrium.load_state(last.x, last.load)
        return self._full_load(last.x, last.linearisation.stable)

    def refined(self, growth: float) -> SheetLevel:
        """A level whose mesh follows the error indicator of the present state."""
        with self._clock("compile"):
            indicator = ErrorIndicator(self.simulation.equilibrium.discretisation)
        eta = indicator.evaluate()
        sheet = self._case.sheet

        def mesh() -> Triangulation:
            assert eta is not None
            assert self.triangulation is not None
            sizes = new_sizes(self.triangulation, eta, growth, self.order)
            return rectangle_by_sizes(sheet.width, sheet.height, sizes)

        with self._clock("mesh"):
            triangulation = at_root(self._comm, mesh)
        return SheetLevel(self._case, self._comm, self._clock, self._steps, triangulation)

    def _full_load(self, x: Array, stable: bool) -> FullLoad:
        reaction = self.simulation.reaction(x, _FULL)
        energy = sum(self.simulation.equilibrium.energies(x, _FULL).values())
        return FullLoad(reaction.force, energy, stable)
