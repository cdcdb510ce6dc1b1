"""Equilibrium of a continuum between supports, as residual, tangent and rate of one state."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from mpi4py import MPI
from petsc4py import PETSc

from dolfinx import fem

from .. import dolfinx_api as api
from ..physics.reaction import Reaction
from ..schemes import Discretisation
from ..solve.failure import Remedies
from ..solve.origin import Origin
from ..stopwatch import Stopwatch
from .forms import EquilibriumForms
from .softening import Softening
from .support import Support
from .symmetric_matrix import create_symmetric_matrix

Array = NDArray[np.float64]


class ContinuumEquilibrium:
    """The discrete problem: compiled forms and held dofs.

    Implements :class:`pantograph_fem.solve.problem.Problem`.
    """

    def __init__(
        self,
        discretisation: Discretisation,
        supports: Sequence[Support],
        clock: Stopwatch | None = None,
        check: Callable[[], str] | None = None,
        remedies: Remedies | None = None,
    ) -> None:
        """Compile the forms.

        `check` objects to the discretisation's present state, or not; `remedies` are what a user
        can change.
        """
        self._check = check
        self.remedies = remedies or Remedies()
        self._softening = Softening(discretisation.energy)
        self.discretisation = discretisation
        self.supports = supports
        self._clock = clock or Stopwatch()
        self._state = discretisation.state
        space = self._state.function_space
        self._owned = api.owned_size(space)
        self._comm = space.mesh.comm
        with self._clock("compile"):
            self._forms = EquilibriumForms(discretisation, supports, self.has_minima)
        dofs = np.concatenate([support.dofs for support in supports])
        self._owned_dofs = np.unique(dofs[dofs < self._owned])
        self._data = fem.Function(space)
        blocks = dofs if space.dofmap.index_map_bs == 1 else dofs[::2] // 2
        self._bcs = [fem.dirichletbc(self._data, np.unique(blocks).astype(np.int32))]
        self._vector = api.create_vector(space)

    @property
    def held_dofs(self) -> NDArray[np.int32]:
        """Owned dofs that the supports hold."""
        return self._owned_dofs

    @property
    def typical_sizes(self) -> Array:
        """Typical size of each owned dof."""
        return self.discretisation.typical_sizes()[: self._owned]

    @property
    def unknowns(self) -> Array:
        """What each owned dof is, and where: see :meth:`.Discretisation.unknowns`."""
        return self.discretisation.unknowns()[: self._owned]

    @property
    def typical_energy(self) -> float:
        """Typical energy, J."""
        return self.discretisation.scales.energy

    @property
    def expected_negative_pivots(self) -> int:
        """One per multiplier dof."""
        return self.discretisation.multiplier_dofs

    @property
    def has_minima(self) -> bool:
        """Yes, but for multipliers."""
        return self.discretisation.multiplier_dofs == 0

    @property
    def near(self) -> float:
        """Errors, in typical sizes, up to which the factor of an old tangent serves."""
        return self.discretisation.near

    def matrix(self) -> PETSc.Mat:
        """A matrix for the tangent, of which it holds the upper half."""
        with self._clock("assemble"):
            return create_symmetric_matrix(self._forms.tangent)

    def undeformed(self) -> Array:
        """The state of rest."""
        return np.zeros(self._owned)

    def impose(self, x: Array, load: float) -> Array:
        """A copy of x with the supports where they are at the load factor."""
        imposed = x.copy()
        for support in self.supports:
            mine = support.dofs < self._owned
            imposed[support.dofs[mine]] = support.values(load)[mine]
        return imposed

    def potential(self, x: Array, load: float) -> float:
        """The functional of which an equilibrium is a stationary point, J."""
        with self._clock("assemble"):
            self.load_state(x, load)
            assert self._forms.potential is not None  # it has minima
            potential = fem.assemble_scalar(self._forms.potential)
            return self._comm.allreduce(potential, MPI.SUM)

    def residual(self, x: Array, load: float, r: PETSc.Vec) -> None:
        """Out-of-balance forces; zero at the held dofs, whose values x must already have."""
        with self._clock("assemble"):
            self.load_state(x, load)
            api.assemble_vector(self._vector, self._forms.residual)
            r.array[:] = self._vector.array[: self._owned]
            r.array[self._owned_dofs] = 0.0

    def tangent(self, x: Array, load: float, A: PETSc.Mat, origin: Origin | None = None) -> None:
        """Derivative of the residual; rows and columns of held dofs are the identity's.

        With an origin the stresses are those extrapolated from there: see
        :mod:`pantograph_fem.schemes.stiff`.
        """
        with self._clock("assemble"):
            self._forms.extrapolate_from(origin or Origin(x, np.zeros_like(x)))
            self.load_state(x, load)
            api.assemble_matrix(A, self._forms.tangent, self._bcs)

    def load_rate(self, x: Array, load: float) -> Array:
        """Right side whose solution with the tangent is dx/dload along the path.

        The tangent is that assembled last, with the stresses extrapolated there.
        """
        with self._clock("assemble"):
            self.load_state(x, load)
            rate = np.zeros(self._owned)
            if self._forms.pull is not None:
                api.assemble_vector(self._vector, self._forms.pull)
                rate[:] = self._vector.array[: self._owned]
            rate += self._forces_of(lambda support: support.rates(load))
            rate[self._owned_dofs] = self._data.x.array[self._owned_dofs]
        return rate

    def lift(self, x: Array, load: float, shift: Array) -> Array:
        """Right side whose solution with the tangent follows a shift of the held dofs."""
        with self._clock("assemble"):
            self.load_state(x, load)
            self._data.x.array[:] = 0.0
            self._data.x.array[self._owned_dofs] = shift[self._owned_dofs]
            self._data.x.scatter_forward()
            forces = self._lifted()
            forces[self._owned_dofs] = shift[self._owned_dofs]
        return forces

    def energies(self, x: Array, load: float) -> dict[str, float]:
        """Stored energy of each effect, J."""
        self.load_state(x, load)
        return {
            name: self._comm.allreduce(fem.assemble_scalar(form), MPI.SUM)
            for name, form in self._forms.energies.items()
        }

    def reactions(self, x: Array, load: float) -> list[Reaction]:
        """What each support exerts: the work of the residual on its virtual rigid motions."""
        forces = self.forces(x, load)
        return [
            Reaction(
                (
                    self.work(support, support.virtual_translation(0), forces),
                    self.work(support, support.virtual_translation(1), forces),
                ),
                self.work(support, support.virtual_rotation(load), forces),
            )
            + support.exerted()
            for support in self.supports
        ]

    def forces(self, x: Array, load: float) -> Array:
        """Gradient of the functional; at held dofs, what the supports exert there."""
        self.load_state(x, load)
        api.assemble_vector(self._vector, self._forms.residual)
        return self._vector.array[: self._owned].copy()

    def work(self, support: Support, virtual: Array, forces: Array) -> float:
        """Work of the forces on a virtual displacement of a support's dofs."""
        mine = support.dofs < self._owned
        return self._comm.allreduce(float(forces[support.dofs[mine]] @ virtual[mine]), MPI.SUM)

    def work_rate(self, x: Array, load: float, support: Support, virtual: Array) -> Array:
        """Derivative of that work with respect to the free unknowns; zero at the held dofs."""
        with self._clock("assemble"):
            self._forms.extrapolate_from(Origin(x, np.zeros_like(x)))
            self.load_state(x, load)
            rate = -self._forces_of(lambda one: virtual if one is support else 0.0)
            rate[self._owned_dofs] = 0.0
        return rate

    def sum(self, shares: Array) -> Array:
        """Sum of what the processes have of some numbers."""
        return self._comm.allreduce(shares, MPI.SUM)

    def objection(self, x: Array, load: float) -> str:
        """What the check has against a state; empty where it has nothing."""
        if self._check is None:
            return ""
        self.load_state(x, load)
        return self._check()

    @property
    def softest(self) -> int:
        """Level of the smoothest pivots; 0 where they are smooth."""
        return self._softening.softest

    def soften(self, level: int) -> None:
        """Have the pivots of a level; 0 are those of the case."""
        self._softening.set(level)

    def locate(self, unknown: int) -> str:
        """Field and reference position of an owned dof, as "displacement at (0, 0.1) m"."""
        for field in self.discretisation.fields:
            blocks = np.flatnonzero((field.dofs == unknown).any(axis=1))
            if len(blocks):
                x, y = field.coordinates[blocks[0]]
                return f"{field.name} at ({x:.4g}, {y:.4g}) m"
        raise IndexError(f"dof {unknown} belongs to no field")

    def load_state(self, x: Array, load: float) -> None:
        """Put x into the state function, ghosts included, and move the supports."""
        self._state.x.array[: self._owned] = x
        self._state.x.scatter_forward()
        for support in self.supports:
            support.move(load)

    def _forces_of(self, displaced: Callable[[Support], Array | float]) -> Array:
        """Minus what it takes to hold the free dofs while the supports' dofs are displaced."""
        self._data.x.array[:] = 0.0
        for support in self.supports:
            self._data.x.array[support.dofs] = displaced(support)
        return self._lifted()

    def _lifted(self) -> Array:
        """Minus what it takes to hold the free dofs while the data move the held ones."""
        self._vector.array[:] = 0.0
        api.lift(self._vector, self._forms.tangent, self._bcs)
        return self._vector.array[: self._owned].copy()
