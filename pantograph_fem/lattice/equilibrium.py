"""Equilibrium of a net between its ends, as residual, tangent and load rate of one state."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from mpi4py import MPI
from petsc4py import PETSc

from ..physics.reaction import NO_REACTION, Reaction
from ..physics.rigid_motion import RigidMotion
from ..solve.failure import Remedies
from ..solve.newton_settings import NewtonSettings
from ..solve.origin import Origin
from ..stopwatch import Stopwatch
from .assembly import TangentRows
from .end_load import EndLoad
from .energy import NetEnergy
from .net import Net

Array = NDArray[np.float64]


class LatticeEquilibrium:
    """The discrete problem of a net whose ends move as rigid bodies.

    Implements :class:`pantograph_fem.solve.problem.Problem`. States are displacements of nodes,
    [ux0, uy0, ux1, ...], m. Each process owns a range of nodes and has all of the net, so that
    what is summed over the net needs no communication beyond the state.
    """

    def __init__(
        self,
        net: Net,
        motions: Mapping[str, RigidMotion] | None = None,
        loads: Sequence[EndLoad] = (),
        comm: MPI.Comm = MPI.COMM_SELF,
        clock: Stopwatch | None = None,
    ) -> None:
        """Distribute the net; a collective call.

        Parameters
        ----------
        net
            The net, the same on every process.
        motions
            Motions of the ends by name; an end without one stays where it is.
        loads
            Dead loads.

        Raises
        ------
        KeyError
            Where a motion names no end of the net.
        """
        self.net = net
        self.loads = tuple(loads)
        self._comm = comm
        self._clock = clock or Stopwatch()
        if unknown := sorted(set(motions or {}) - set(net.ends)):
            raise KeyError(f"The net has no end {unknown[0]!r}, only {', '.join(net.ends)}.")
        self._motions = {name: (motions or {}).get(name, RigidMotion()) for name in net.ends}
        share = np.linspace(0, net.size, comm.size + 1).astype(int)
        self._first, self._last = int(share[comm.rank]), int(share[comm.rank + 1])
        self._held = net.held.ravel()
        self._own_held = self._held[2 * self._first : 2 * self._last]
        self._energy = NetEnergy(net)
        self._part = self._energy
        if comm.size > 1:
            self._part = NetEnergy(net.around(np.arange(self._first, self._last)))
        self._rows = TangentRows(self._part, self._held, self._first, self._last)
        self._forces, self._couples = np.zeros((net.size, 2)), np.zeros(len(net.links))
        self._loads = tuple(loads)
        for load in loads:
            self._forces[load.node] += load.force
            self._couples[load.link] += load.moment

    @property
    def owned(self) -> slice:
        """The nodes of this process."""
        return slice(self._first, self._last)

    @property
    def typical_sizes(self) -> Array:
        """The extent of the net for each owned unknown, m."""
        return np.full(2 * (self._last - self._first), self.net.extent)

    @property
    def unknowns(self) -> Array:
        """Component and number of the node of each owned unknown, shape (n, 3).

        On any number of processes the nodes have the same numbers.
        """
        nodes = np.repeat(np.arange(self._first, self._last), 2)
        return np.column_stack([np.arange(len(nodes)) % 2, nodes, np.zeros(len(nodes))])

    @property
    def typical_energy(self) -> float:
        """Largest stiffness, as of a link, times the square of the extent, J."""
        net, extent = self.net, self.net.extent
        groups = (net.turns, net.walls, net.pivots)
        couples = [group.stiffness for group in groups if group is not None]
        forces = [k * extent**2 for k in (net.stiffness, net.ground) if k is not None]
        return max(float(stiffness.max(initial=0.0)) for stiffness in couples + forces)

    @property
    def expected_negative_pivots(self) -> int:
        """None: displacements are all there is."""
        return 0

    @property
    def has_minima(self) -> bool:
        """Yes, but for dead couples: their work is that of an angle, which is many-valued."""
        return not self._couples.any()

    @property
    def near(self) -> float:
        """The default, as nothing is extrapolated."""
        return NewtonSettings.near

    def matrix(self) -> PETSc.Mat:
        """An empty matrix for the tangent."""
        return self._rows.matrix(self._comm)

    def undeformed(self) -> Array:
        """The state of rest."""
        return np.zeros(2 * (self._last - self._first))

    def impose(self, x: Array, load: float) -> Array:
        """A copy of x with the ends where they are at the load factor."""
        return np.where(self._own_held, self._own(self._prescribed(load)), x)

    def potential(self, x: Array, load: float) -> float:
        """Stored energy less the work of dead forces, J."""
        with self._clock("assemble"):
            u = self.gather(x)
            stored = sum(self._energy.energies(u, self.rotations(load)).values())
            return stored - load * float((self._forces * u).sum())

    def residual(self, x: Array, load: float, r: PETSc.Vec) -> None:
        """Out-of-balance forces; zero at the held unknowns, whose values x must already have."""
        with self._clock("assemble"):
            out_of_balance = self._own(self._gradient(self._part, self.gather(x), load))
            r.array[:] = np.where(self._own_held, 0.0, out_of_balance)

    def tangent(self, x: Array, load: float, A: PETSc.Mat, origin: Origin | None = None) -> None:
        """Derivative of the residual; rows and columns of held unknowns are the identity's."""
        with self._clock("assemble"):
            u = self.gather(x)
            self._rows.fill(self._part.blocks(u, self.rotations(load), load * self._couples), A)

    def load_rate(self, x: Array, load: float) -> Array:
        """Right side whose solution with the tangent is dx/dload along the path."""
        with self._clock("assemble"):
            u, rotations = self.gather(x), self.rotations(load)
            couples = self._couples.copy()
            walls = self._part.net.walls
            if walls is not None:
                _, stiffness = self._part.wall_couples(u, rotations)
                rates = np.array([motion.angle for motion in self._motions.values()])
                couples += self._part.rotational.on_links(stiffness * rates[walls.ends])
            pull = self._forces + self._part.couple_forces(u, couples)
            lifted = self.lift(x, load, self._own(self._prescribed_rate(load)))
            return lifted + np.where(self._own_held, 0.0, self._own(pull))

    def lift(self, x: Array, load: float, shift: Array) -> Array:
        """Right side whose solution with the tangent follows a shift of the held unknowns."""
        with self._clock("assemble"):
            moved = self.gather(np.where(self._own_held, shift, 0.0))
            couples = load * self._couples
            blocks = self._part.blocks(self.gather(x), self.rotations(load), couples)
            free = -(self._rows.derivatives(blocks) @ moved.ravel())
            return np.where(self._own_held, shift, free)

    def objection(self, x: Array, load: float) -> str:
        """Nothing: springs resist whatever could be objected to."""
        return ""

    @property
    def softest(self) -> int:
        """There is no easier net."""
        return 0

    def soften(self, level: int) -> None:
        """Nothing: there is one level."""

    @property
    def remedies(self) -> Remedies:
        """Other springs, and more of them."""
        net = self.net
        springs = {"stretch": net.stiffness, "bending": net.turns, "shear": net.pivots}
        missing = tuple(f"material.{name}" for name, group in springs.items() if group is None)
        return Remedies("more nodes (a smaller lattice.spacing)", missing)

    def locate(self, unknown: int) -> str:
        """Reference position of the node that an owned unknown displaces."""
        x, y = self.net.nodes[self._first + unknown // 2]
        return f"displacement at ({x:.4g}, {y:.4g}) m"

    def energies(self, x: Array, load: float) -> dict[str, float]:
        """Stored energy of each effect, J; the load factor tells how far walls have turned."""
        return self._energy.energies(self.gather(x), self.rotations(load))

    def reactions(self, x: Array, load: float) -> dict[str, Reaction]:
        """What each end that is held or loaded exerts on the net, by its name."""
        u = self.gather(x)
        forces = self._gradient(self._energy, u, load)
        rotations = self.rotations(load)
        reactions = {}
        for place, (name, end) in enumerate(self.net.ends.items()):
            held = np.zeros((len(end.nodes), 2))
            held[:, list(end.components)] = forces[end.entries]
            centre = np.array([end.centre])
            centre += self._motions[name].displacement(centre, load)
            arm = self.net.nodes[end.nodes] + u[end.nodes] - centre
            moment = float((arm[:, 0] * held[:, 1] - arm[:, 1] * held[:, 0]).sum())
            if self.net.walls is not None:
                couples, _ = self._energy.wall_couples(u, rotations)
                moment -= float(couples[self.net.walls.ends == place].sum())
            reactions[name] = Reaction((float(held[:, 0].sum()), float(held[:, 1].sum())), moment)
        for dead in self._loads:
            exerted = Reaction((load * dead.force[0], load * dead.force[1]), load * dead.moment)
            reactions[dead.end] = reactions.get(dead.end, NO_REACTION) + exerted
        return reactions

    def gather(self, x: Array) -> Array:
        """Displacements of all nodes, shape (n, 2); a collective call."""
        parts = [x] if self._comm.size == 1 else self._comm.allgather(x)
        return np.concatenate(parts).reshape(-1, 2)

    def _gradient(self, energy: NetEnergy, u: Array, load: float) -> Array:
        stored = energy.gradient(u, self.rotations(load), load * self._couples)
        return stored - load * self._forces

    def rotations(self, load: float) -> Array:
        """Angle of each end in the order of :attr:`Net.ends`, rad."""
        return np.array([load * motion.angle for motion in self._motions.values()])

    def _prescribed(self, load: float) -> Array:
        return self._on_ends(lambda motion, X: motion.displacement(X, load))

    def _prescribed_rate(self, load: float) -> Array:
        return self._on_ends(lambda motion, X: motion.displacement_rate(X, load))

    def _on_ends(self, value: Callable[[RigidMotion, Array], Array]) -> Array:
        """Values at held unknowns of all nodes, zero elsewhere; shape (n, 2)."""
        values = np.zeros((self.net.size, 2))
        for name, end in self.net.ends.items():
            at_end = value(self._motions[name], self.net.nodes[end.nodes])
            values[end.entries] = at_end[:, list(end.components)]
        return values

    def _own(self, nodal: Array) -> Array:
        return nodal[self._first : self._last].ravel()
