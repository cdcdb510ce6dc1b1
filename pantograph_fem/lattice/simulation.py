"""Lattices and chains as a run sees them: a path to follow, and what to observe at each state."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import Delaunay

from mpi4py import MPI

from ..case import ChainCase, LatticeCase
from ..physics.reaction import NO_REACTION
from ..reporting import TIP_COLUMNS, history_row, tip_columns
from ..results.fields import FieldGrid
from ..simulation import Observation
from ..solve.continuation import Step
from ..solve.newton_settings import NewtonSettings
from ..solve.path import NewtonPath
from ..stopwatch import Stopwatch
from .build import NetProblem, build_chain, build_lattice
from .equilibrium import LatticeEquilibrium
from .sampling import ChainSampler, LatticeSampler, NetFields, NetSampler

Array = NDArray[np.float64]


class NetSimulation:
    """Implements :class:`pantograph_fem.simulation.Simulation` for a net of springs."""

    extra_columns: tuple[str, ...] = ()
    #: The end whose reaction is reported.
    reported: str

    def __init__(
        self,
        case: LatticeCase | ChainCase,
        problem: NetProblem,
        sampler: NetSampler,
        comm: MPI.Comm,
        clock: Stopwatch,
    ) -> None:
        """Distribute the net; a collective call."""
        self._comm = comm
        self._problem = problem
        self._sampler = sampler
        self._equilibrium = LatticeEquilibrium(
            problem.net, problem.motions, problem.loads, comm, clock
        )
        options = case.continuation
        self.path = NewtonPath(
            self._equilibrium,
            NewtonSettings(options.tolerance, options.max_iterations),
            clock,
            lambda: np.full_like(self._equilibrium.typical_sizes, 1.0 / problem.net.size),
            case.output.eigenvalues,
        )
        self.cells = len(problem.net.links)
        self.dofs = {"displacement": 2 * problem.net.size}
        self._probes = self._interpolation(np.array(case.output.probes).reshape(-1, 2))

    @property
    def start(self) -> Array:
        """The state of rest."""
        return self._equilibrium.undeformed()

    @property
    def unknowns(self) -> Array:
        """What each owned unknown is: see :attr:`.Simulation.unknowns`."""
        return self._equilibrium.unknowns

    def grid(self) -> FieldGrid | None:
        """Nodes and links on rank 0, None elsewhere."""
        net = self._problem.net
        return FieldGrid(net.nodes, net.links) if self._comm.rank == 0 else None

    def displacement(self, x: Array, load: float) -> Array | None:
        """Displacement of the nodes on rank 0, None elsewhere; a collective call."""
        u = self._equilibrium.gather(x)
        return u if self._comm.rank == 0 else None

    def observe(self, step: Step) -> Observation | None:
        """Numbers and fields of a state on rank 0, None elsewhere; a collective call."""
        u = self._equilibrium.gather(step.x)
        reactions = self._equilibrium.reactions(step.x, step.load)
        energies = self._equilibrium.energies(step.x, step.load)
        if self._comm.rank != 0:
            return None
        fields = self._sampler.sample(u, self._equilibrium.rotations(step.load))
        row = history_row(
            step,
            reactions.get(self.reported, NO_REACTION),
            energies,
            shear=self._shear(fields),
            probes=self._probes @ u.reshape(len(u), 2),
            extra=self._extra(fields),
        )
        return Observation(row, fields.nodes, fields.links)

    def _interpolation(self, points: Array) -> Array:
        """Weights of the nodes at each point, shape (points, n)."""
        raise NotImplementedError

    def _shear(self, fields: NetFields) -> tuple[float, float]:
        return 0.0, 0.0

    def _extra(self, fields: NetFields) -> dict[str, float]:
        return {}


class LatticeSimulation(NetSimulation):
    """``kind = "lattice"``."""

    reported = "top"

    def __init__(self, case: LatticeCase, comm: MPI.Comm, clock: Stopwatch) -> None:
        """Cut the lattice; a collective call."""
        with clock("mesh"):
            problem = build_lattice(case)
            sampler = LatticeSampler(problem.net, problem.parts)
        super().__init__(case, problem, sampler, comm, clock)

    def _interpolation(self, points: Array) -> Array:
        nodes = self._problem.net.nodes
        weights = np.zeros((len(points), len(nodes)))
        if len(points):
            triangulation = Delaunay(nodes)
            # A point on the side of the sheet may lie outside of all triangles, by rounding.
            triangle = triangulation.find_simplex(points, tol=1e-6)
            for row, (point, simplex) in enumerate(zip(points, triangle, strict=True)):
                corners = triangulation.simplices[simplex]
                if simplex < 0:
                    corners = [np.argmin(((nodes - point) ** 2).sum(axis=1))]
                    weights[row, corners] = 1.0
                    continue
                transform = triangulation.transform[simplex]
                share = transform[:2] @ (point - transform[2])
                weights[row, corners] = [*share, 1.0 - share.sum()]
        return weights

    def _shear(self, fields: NetFields) -> tuple[float, float]:
        psi = fields.nodes["shear_angle"]
        return float(psi.min()), float(psi.max())


class ChainSimulation(NetSimulation):
    """``kind = "chain"``."""

    reported = "right"

    def __init__(self, case: ChainCase, comm: MPI.Comm, clock: Stopwatch) -> None:
        """Lay out the chain; a collective call."""
        with clock("mesh"):
            problem = build_chain(case)
            sampler = ChainSampler(problem.net, problem.parts)
        effects = ["energy_foundation"] if problem.net.ground is not None else []
        self.extra_columns = (*effects, *TIP_COLUMNS)
        super().__init__(case, problem, sampler, comm, clock)

    def _interpolation(self, points: Array) -> Array:
        S = self._problem.net.nodes[:, 0]
        hats = np.eye(len(S))
        return np.array([[np.interp(x, S, hat) for hat in hats] for x, _ in points]).reshape(
            len(points), len(S)
        )

    def _extra(self, fields: NetFields) -> dict[str, float]:
        return tip_columns(fields.nodes["displacement"][-1], fields.nodes["angle"][-1])
