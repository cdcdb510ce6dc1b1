"""Equilibrium of a sheet between grips, as residual, tangent and load rate of one state vector."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import ufl
from numpy.typing import NDArray

from mpi4py import MPI
from petsc4py import PETSc

from dolfinx import fem

from .. import dolfinx_api as api
from ..schemes import Discretisation
from ..stopwatch import Stopwatch
from .grip import Grip, HeldDofs

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Reaction:
    """What a grip exerts on the sheet: force (N) and moment about its current centre (N m)."""

    force: tuple[float, float]
    moment: float


class SheetEquilibrium:
    """The discrete problem: compiled forms and held dofs.

    States are arrays of the dofs that this process owns, in SI units. Every method is collective.
    """

    def __init__(
        self, discretisation: Discretisation, grips: Sequence[Grip], clock: Stopwatch | None = None
    ) -> None:
        self.discretisation = discretisation
        self._clock = clock or Stopwatch()
        self._state = discretisation.state
        space = self._state.function_space
        self._owned = api.owned_size(space)
        self._comm = space.mesh.comm
        with self._clock("compile"):
            residual = ufl.derivative(discretisation.functional, self._state)
            self._residual = api.form(residual)
            self._tangent = api.form(ufl.derivative(residual, self._state))
            self._energies = {
                name: api.form(density * discretisation.measure)
                for name, density in discretisation.densities.items()
            }
        self.held = [HeldDofs(grip, discretisation) for grip in grips]
        dofs = np.concatenate([held.dofs for held in self.held])
        self._owned_dofs = np.unique(dofs[dofs < self._owned])
        self._data = fem.Function(space)
        blocks = dofs if space.dofmap.index_map_bs == 1 else dofs[::2] // 2
        self._bcs = [fem.dirichletbc(self._data, np.unique(blocks).astype(np.int32))]
        self._vector = api.create_vector(space)

    @property
    def typical_sizes(self) -> Array:
        """Typical size of each owned dof."""
        return self.discretisation.typical_sizes()[: self._owned]

    def matrix(self) -> PETSc.Mat:
        """An empty matrix for the tangent."""
        return api.create_matrix(self._tangent)

    def undeformed(self) -> Array:
        """The state of rest."""
        return np.zeros(self._owned)

    def impose(self, x: Array, load: float) -> Array:
        """A copy of x with the grips where they are at the load factor."""
        imposed = x.copy()
        for held in self.held:
            mine = held.dofs < self._owned
            imposed[held.dofs[mine]] = held.values(load)[mine]
        return imposed

    def residual(self, x: Array, r: PETSc.Vec) -> None:
        """Out-of-balance forces; zero at the held dofs, whose values x must already have."""
        with self._clock("assemble"):
            self.load_state(x)
            api.assemble_vector(self._vector, self._residual)
            r.array[:] = self._vector.array[: self._owned]
            r.array[self._owned_dofs] = 0.0

    def tangent(self, x: Array, A: PETSc.Mat) -> None:
        """Derivative of the residual; rows and columns of held dofs are the identity's."""
        with self._clock("assemble"):
            self.load_state(x)
            api.assemble_matrix(A, self._tangent, self._bcs)

    def load_rate(self, x: Array, load: float) -> Array:
        """Right side whose solution with the tangent is dx/dload along the path."""
        with self._clock("assemble"):
            self.load_state(x)
            self._data.x.array[:] = 0.0
            for held in self.held:
                self._data.x.array[held.dofs] = held.rates(load)
            self._vector.array[:] = 0.0
            api.lift(self._vector, self._tangent, self._bcs)
            rate = self._vector.array[: self._owned].copy()
            rate[self._owned_dofs] = self._data.x.array[self._owned_dofs]
        return rate

    def energies(self, x: Array) -> dict[str, float]:
        """Stored energy of each effect, J."""
        self.load_state(x)
        return {
            name: self._comm.allreduce(fem.assemble_scalar(form), MPI.SUM)
            for name, form in self._energies.items()
        }

    def reactions(self, x: Array, load: float) -> list[Reaction]:
        """Reaction of each grip, as the work of the residual on its virtual rigid motions."""
        self.load_state(x)
        api.assemble_vector(self._vector, self._residual)
        return [
            Reaction(
                (
                    self._work(held, held.virtual_translation(0)),
                    self._work(held, held.virtual_translation(1)),
                ),
                self._work(held, held.virtual_rotation(load)),
            )
            for held in self.held
        ]

    def load_state(self, x: Array) -> None:
        """Put x into the state function, ghosts included."""
        self._state.x.array[: self._owned] = x
        self._state.x.scatter_forward()

    def _work(self, held: HeldDofs, virtual: Array) -> float:
        mine = held.dofs < self._owned
        return self._comm.allreduce(
            float(self._vector.array[held.dofs[mine]] @ virtual[mine]), MPI.SUM
        )
