"""Problems of a few unknowns, and trusses of a few links, whose critical points are known."""

import numpy as np

from mpi4py import MPI
from petsc4py import PETSc

from pantograph_fem.lattice.end_load import EndLoad
from pantograph_fem.lattice.equilibrium import LatticeEquilibrium
from pantograph_fem.lattice.net import End, Net
from pantograph_fem.physics.rigid_motion import RigidMotion
from pantograph_fem.solve.failure import Remedies
from pantograph_fem.solve.newton_settings import NewtonSettings
from pantograph_fem.solve.path import NewtonPath
from pantograph_fem.stopwatch import Stopwatch


class Toy:
    """Implements Problem for a potential given by its gradient and second derivatives."""

    has_minima = False
    near = 1e-2

    def __init__(self, size, gradient, hessian, pull, multipliers=0):
        self.gradient, self.hessian, self.pull = gradient, hessian, pull
        self.typical_sizes, self.typical_energy = np.ones(size), 1.0
        self.expected_negative_pivots = multipliers

    def matrix(self):
        size = len(self.typical_sizes)
        A = PETSc.Mat().createAIJ((size, size), nnz=size, comm=PETSc.COMM_SELF)
        A.setUp()
        return A

    def impose(self, x, load):
        return x.copy()

    def potential(self, x, load):
        raise NotImplementedError

    def residual(self, x, load, r):
        r.array[:] = self.gradient(x, load)

    def tangent(self, x, load, A, origin=None):
        size = len(x)
        A.setValues(range(size), range(size), np.asarray(self.hessian(x, load), float).ravel())
        A.assemble()

    def load_rate(self, x, load):
        return np.asarray(self.pull(x, load), float)

    def objection(self, x, load):
        return ""

    softest, remedies = 0, Remedies()

    def soften(self, level):
        pass

    def locate(self, unknown):
        return f"unknown {unknown}"

    def path(self, weights=None, **options):
        shares = None if weights is None else lambda: weights
        return NewtonPath(self, NewtonSettings(), Stopwatch(), shares, **options)


def pitchfork(quartic=4.0, slope=0.0):
    """½ x² - t x + ½ (1 - 2 x) y² + ¼ q y⁴ - s t y: y = 0, x = t is stable up to t = ½.

    Beyond, y² = (2 t - 1)/(q - 2) branches off; it rises where q > 2. With s it is imperfect.
    """
    return Toy(
        2,
        lambda z, t: [
            z[0] - t - z[1] ** 2,
            (1 - 2 * z[0]) * z[1] + quartic * z[1] ** 3 - slope * t,
        ],
        lambda z, t: [
            [1.0, -2 * z[1]],
            [-2 * z[1], 1 - 2 * z[0] + 3 * quartic * z[1] ** 2],
        ],
        lambda z, t: [1.0, slope],
    )


def constrained_pitchfork(quartic=4.0):
    """The same with h in place of y, y = h by a multiplier, and nothing else to hold y."""

    def gradient(z, t):
        x, y, h, multiplier = z
        bent = (1 - 2 * x) * h + quartic * h**3
        return [x - t - h**2, multiplier, bent - multiplier, y - h]

    def hessian(z, t):
        x, _, h, _ = z
        stiffness = 1 - 2 * x + 3 * quartic * h**2
        return [[1, 0, -2 * h, 0], [0, 0, 0, 1], [-2 * h, 0, stiffness, -1], [0, 1, -1, 0]]

    toy = Toy(4, gradient, hessian, lambda z, t: [1.0, 0, 0, 0], multipliers=1)
    return toy, np.array([0.5, 0.5, 0.0, 0.0])


def stiffnesses(of_x, rates, pull=None, pull_rate=None, size=1):
    """t = p(x), and kᵢ(x) yᵢ + 4 yᵢ³ = 0: along y = 0 the eigenvalues are p'(x) and kᵢ(x).

    `of_x` and `rates` give k and dk/dx, arrays of `size`; p is x by default. The potential is
    that of kᵢ yᵢ²/2 but for what k' adds to the first equation, which is zero on the path.
    """
    pull, pull_rate = pull or (lambda x: x), pull_rate or (lambda x: 1.0)

    def gradient(z, t):
        return [pull(z[0]) - t, *(of_x(z[0]) * z[1:] + 4 * z[1:] ** 3)]

    def hessian(z, t):
        corner = np.array([[pull_rate(z[0])]])
        inner = np.diag(of_x(z[0]) + 12 * z[1:] ** 2)
        return np.block([[corner, np.zeros((1, size))], [(rates(z[0]) * z[1:])[:, None], inner]])

    return Toy(size + 1, gradient, hessian, lambda z, t: [1.0, *np.zeros(size)])


def falling(*loads):
    """Stiffnesses cᵢ - x: mode i is lost at the load cᵢ."""
    c = np.array(loads)
    return stiffnesses(lambda x: c - x, lambda x: -np.ones(len(c)), size=len(c))


class Truss:
    """Von Mises' truss: two bars from (±1, 0) to an apex at (0, h), each of stiffness k = 1.

    Pressed down by the force P at its apex, or through a vertical spring whose other end moves
    down. Where the apex is at z, P = 2 z (l₀/l - 1) with l² = 1 + z².
    """

    def __init__(self, height=0.3, force=None, spring=None, way=1.0):
        self.height, self.spring, self.way = height, spring, way
        self.full = force
        nodes = [[-1.0, 0.0], [0.0, height], [1.0, 0.0]]
        links, stiffness = [[0, 1], [1, 2]], [1.0, 1.0]
        ends = {"feet": End(np.array([0, 2]), (0.0, 0.0))}
        loads, motions = [], {}
        if spring is not None:
            nodes.append([0.0, height + 1.0])
            links.append([1, 3])
            stiffness.append(spring)
            ends["top"] = End(np.array([3]), (0.0, height + 1.0))
            # guided, so that the bars and the spring stay as they are in the closed form
            ends["guide"] = End(np.array([1]), (0.0, height), (0,))
            motions["top"] = RigidMotion(translation=(0.0, -way))
        else:
            loads.append(EndLoad("apex", 1, 0, (0.0, -force)))
        net = Net(
            np.array(nodes),
            np.array(links),
            np.zeros(len(links), dtype=int),
            ends,
            np.array(stiffness),
        )
        self.equilibrium = LatticeEquilibrium(net, motions, loads, MPI.COMM_SELF)

    def path(self, **options):
        return NewtonPath(self.equilibrium, NewtonSettings(), Stopwatch(), **options)

    def load(self, z):
        """Load factor at which the apex is at z."""
        force = 2 * z * (np.sqrt(1 + self.height**2) / np.sqrt(1 + z**2) - 1)
        if self.spring is None:
            return force / self.full
        return (self.height - z + force / self.spring) / self.way

    def limits(self):
        """Places of the apex where the load factor is largest and smallest, between ±h."""
        z = np.linspace(self.height, -self.height, 2_000_001)
        load = self.load(z)
        inner = np.flatnonzero(np.diff(np.sign(np.diff(load)))) + 1
        return z[inner]

    def apex(self, x):
        return self.height + x[3]
