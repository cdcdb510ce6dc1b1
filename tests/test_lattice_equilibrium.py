"""Equilibria of chains and lattices: closed forms, balance, work, processes."""

import math

import numpy as np
import pytest

from mpi4py import MPI

from pantograph_fem.lattice.chain import chain
from pantograph_fem.lattice.cut import cut
from pantograph_fem.lattice.end_load import EndLoad
from pantograph_fem.lattice.equilibrium import LatticeEquilibrium
from pantograph_fem.lattice.links import angle_between
from pantograph_fem.physics.rigid_motion import RigidMotion
from pantograph_fem.solve.newton import NewtonSolver
from pantograph_fem.solve.newton_settings import NewtonSettings

K_E, K_B, LENGTH, COUNT = 4.05e8, 7.59e5, 1.0, 20
SPACING = LENGTH / COUNT


def solve(equilibrium, loads, start=None):
    """The states at increasing load factors, each from the one before, and their inertias."""
    now = [0.0]
    newton = NewtonSolver(
        lambda x, r: equilibrium.residual(x, now[0], r),
        lambda x, A, _: equilibrium.tangent(x, now[0], A),
        equilibrium.matrix(),
        equilibrium.typical_sizes,
        equilibrium.typical_energy,
        NewtonSettings(tolerance=1e-10, max_iterations=30),
    )
    x, states = equilibrium.undeformed() if start is None else start, []
    for load in loads:
        newton.factorise(x)
        step = newton.back_substitute(equilibrium.load_rate(x, now[0])) * (load - now[0])
        now[0] = load
        result = newton.solve(equilibrium.impose(x + step, load))
        assert result.converged, result.reason
        x = result.x
        states.append(x)
    inertia = newton.factorise(x).inertia
    assert (inertia.negative, inertia.zero) == (equilibrium.expected_negative_pivots, 0)
    return states


def cantilever(force=(0.0, 0.0), moment=0.0, **changes):
    constants = {"stretch": K_E, "bending": K_B, "supports": {"left": "clamped"}}
    net = chain(LENGTH, SPACING, **(constants | changes))
    return LatticeEquilibrium(net, loads=[EndLoad("right", COUNT, COUNT - 1, force, moment)])


def turns(equilibrium, x):
    """Angles of all links, from that of the wall on the left onwards."""
    places = equilibrium.net.nodes + x.reshape(-1, 2)
    spans = np.diff(places, axis=0, prepend=[[-1.0, 0.0]])
    return angle_between(spans[:-1], spans[1:])


def test_a_straight_chain_under_an_end_force_is_a_row_of_springs():
    equilibrium = cantilever(force=(0.1 * K_E, 0.0))
    x = solve(equilibrium, [1.0])[-1].reshape(-1, 2)
    np.testing.assert_allclose(x[:, 0], 0.1 * equilibrium.net.nodes[:, 0], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(x[:, 1], 0.0, atol=1e-12)
    energies = equilibrium.energies(x.ravel(), 1.0)
    assert energies["stretch"] == pytest.approx(0.5 * K_E * 0.1**2 * LENGTH, rel=1e-9)
    assert energies["bending"] == pytest.approx(0.0, abs=1e-9)


def test_a_chain_under_an_end_moment_is_a_regular_polygon():
    """sin(turn) = M ε/K_b at each node, half as much at the wall, and nothing stretches."""
    moment = 6.0 * K_B
    equilibrium = cantilever(moment=moment)
    x = solve(equilibrium, np.linspace(0.1, 1.0, 10))[-1]
    expected = np.full(COUNT, math.asin(moment * SPACING / K_B))
    expected[0] = math.asin(moment * SPACING / (2 * K_B))
    np.testing.assert_allclose(turns(equilibrium, x), expected, rtol=1e-7)
    spans = np.diff(equilibrium.net.nodes + x.reshape(-1, 2), axis=0)
    np.testing.assert_allclose(np.hypot(*spans.T), SPACING, rtol=1e-9)
    wall = equilibrium.reactions(x, 1.0)["left"]
    np.testing.assert_allclose(wall.force, 0.0, atol=1e-6 * moment)
    assert wall.moment == pytest.approx(-moment, rel=1e-8)


def test_a_wall_balances_a_dead_force_on_the_bent_chain():
    force = np.array([-3e5, 8e5])
    equilibrium = cantilever(force=tuple(force))
    x = solve(equilibrium, np.linspace(0.2, 1.0, 5))[-1]
    arm = equilibrium.net.nodes[-1] + x[-2:]
    wall = equilibrium.reactions(x, 1.0)["left"]
    np.testing.assert_allclose(wall.force, -force, rtol=1e-8)
    assert wall.moment == pytest.approx(-(arm[0] * force[1] - arm[1] * force[0]), rel=1e-8)


def test_a_compressed_column_buckles_at_the_load_of_the_hencky_chain():
    """P l = 2 b (1 - cos(π/2n)) with the current length l = ε - P/k of a link.

    This is the chain of 2n links pinned at both ends: the node in its middle turns by twice the
    angle of the link beside it, which is what a wall of 2 b resists to.
    """
    equilibrium = cantilever(force=(-1.0, 0.0))
    k, b = K_E / SPACING, K_B / SPACING
    product = 2 * b * (1 - math.cos(math.pi / (2 * COUNT)))
    critical = k / 2 * (SPACING - math.sqrt(SPACING**2 - 4 * product / k))
    for factor, stable in ((0.999, True), (1.001, False)):
        shortening = critical * factor / K_E
        x = np.column_stack([-shortening * equilibrium.net.nodes[:, 0], np.zeros(COUNT + 1)])
        r = equilibrium.matrix().createVecLeft()
        equilibrium.residual(x.ravel(), critical * factor, r)
        assert np.abs(r.array).max() < 1e-9 * critical
        A = equilibrium.matrix()
        equilibrium.tangent(x.ravel(), critical * factor, A)
        dense = A.convert("dense")  # the array is that of the matrix, and gone with it
        smallest = np.linalg.eigvalsh(dense.getDenseArray())[0]
        assert (smallest > 0) == stable


TOP = RigidMotion(translation=(0.01, 0.03), angle=0.4, pivot=(0.034, 0.204))


def lattice(spacing=0.0096, fibre_angle=45.0, top=TOP, clamped=("top",), comm=None, **changes):
    constants = {
        "stretch": (1.34e5, 1.34e5),
        "bending": (1.92e-2, 1.92e-2),
        "shear": 1.59e2,
        "exponent": 1.36,
    }
    net = cut(0.068, 0.204, fibre_angle, spacing, clamped=clamped, **(constants | changes))
    return LatticeEquilibrium(net, {"top": top}, **({"comm": comm} if comm else {}))


@pytest.mark.parametrize("clamped", [(), ("bottom", "top")])
@pytest.mark.parametrize("fibre_angle", [45.0, 30.0])
def test_forces_and_moments_of_both_grips_are_in_balance(fibre_angle, clamped):
    equilibrium = lattice(fibre_angle=fibre_angle, clamped=clamped)
    x = solve(equilibrium, np.linspace(0.1, 1.0, 10))[-1]
    reactions = equilibrium.reactions(x, 1.0)
    bottom, top = reactions["bottom"], reactions["top"]
    forces = np.array([bottom.force, top.force])
    centres = np.array([[0.034, 0.0], [0.034 + 0.01, 0.204 + 0.03]])
    moments = bottom.moment + top.moment
    moments += (centres[:, 0] * forces[:, 1] - centres[:, 1] * forces[:, 0]).sum()
    size = np.abs(forces).max()
    np.testing.assert_allclose(forces.sum(axis=0), 0.0, atol=1e-6 * size)
    assert moments == pytest.approx(0.0, abs=1e-6 * size * 0.204)


def test_the_energy_grows_by_the_work_of_the_grip():
    """dE/dt = force · velocity of the centre + moment · angular velocity."""
    equilibrium = lattice(clamped=("bottom", "top"))
    h = 1e-3
    *_, before, here, after = solve(equilibrium, (0.2, 0.4, 0.5 - h, 0.5, 0.5 + h))
    energy = [
        sum(equilibrium.energies(x, load).values())
        for x, load in ((before, 0.5 - h), (after, 0.5 + h))
    ]
    top = equilibrium.reactions(here, 0.5)["top"]
    power = float(np.dot(top.force, TOP.translation)) + top.moment * TOP.angle
    assert (energy[1] - energy[0]) / (2 * h) == pytest.approx(power, rel=1e-5)


def test_a_symmetric_test_has_a_symmetric_answer():
    """Mirrored at both mid-lines, whether or not the spacing fits the rectangle."""
    for spacing in (0.0068 * math.sqrt(2), 0.0093):
        equilibrium = lattice(spacing, top=RigidMotion(translation=(0.0, 0.03)), clamped=())
        x = solve(equilibrium, np.linspace(0.2, 1.0, 5))[-1].reshape(-1, 2)
        nodes = equilibrium.net.nodes
        for mirrored, sign in (
            (nodes * [-1, 1] + [0.068, 0], [-1, 1]),
            (nodes * [1, -1] + [0, 0.204], [1, -1]),
        ):
            distance = np.linalg.norm(mirrored[:, None] - nodes[None], axis=2)
            assert distance.min(axis=1).max() < 1e-12
            partner = distance.argmin(axis=1)
            shift = [0.0, 0.03] if sign[1] < 0 else [0.0, 0.0]
            np.testing.assert_allclose(x[partner], x * sign + shift, atol=1e-8)


@pytest.mark.core
def test_processes_compute_together_what_one_computes():
    shared, alone = lattice(comm=MPI.COMM_WORLD), lattice(comm=MPI.COMM_SELF)
    size = 2 * alone.net.size
    whole = alone.impose(np.random.default_rng(1).uniform(-1e-3, 1e-3, size), 0.6)
    own = slice(2 * shared.owned.start, 2 * shared.owned.stop)
    assert own.stop - own.start > 0
    x = whole[own]
    A, B = shared.matrix(), alone.matrix()
    (r, v), (s, w) = A.createVecs(), B.createVecs()
    shared.residual(x, 0.6, r)
    alone.residual(whole, 0.6, s)
    np.testing.assert_allclose(r.array, s.array[own], atol=1e-9 * abs(s.array).max())
    shared.tangent(x, 0.6, A)
    alone.tangent(whole, 0.6, B)
    w.array[:] = np.random.default_rng(2).standard_normal(w.size)
    v.array[:] = w.array[own]
    A.mult(v, r)
    B.mult(w, s)
    np.testing.assert_allclose(r.array, s.array[own], atol=1e-9 * abs(s.array).max())
    rate = alone.load_rate(whole, 0.6)
    np.testing.assert_allclose(shared.load_rate(x, 0.6), rate[own], atol=1e-9 * abs(rate).max())
    np.testing.assert_array_equal(shared.impose(x, 0.9), alone.impose(whole, 0.9)[own])
    assert shared.energies(x, 0.6) == alone.energies(whole, 0.6)
    assert shared.reactions(x, 0.6) == alone.reactions(whole, 0.6)
