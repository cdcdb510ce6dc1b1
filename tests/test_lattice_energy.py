"""What the energies (1) and (19) store: rigid motions, homogeneous strains, the way to (16)."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pantograph_fem.case.lattice_spacing import fitted_spacing
from pantograph_fem.lattice.chain import chain, winkler
from pantograph_fem.lattice.cut import cut
from pantograph_fem.lattice.energy import NetEnergy
from pantograph_fem.lattice.links import angle_between
from pantograph_fem.lattice.springs import turn

K_E, K_B, K_P, GAMMA, DELTA = 1.34e5, 1.92e-2, 1.59e2, 1.36, 1e-4
W, H = 0.068, 0.204


def sheet_net(fibre_angle=45.0, spacing=0.0096, **changes):
    constants = {
        "stretch": (K_E, K_E),
        "bending": (K_B, K_B),
        "shear": K_P,
        "exponent": GAMMA,
        "regularisation": DELTA,
    }
    spacing = fitted_spacing(W, H, fibre_angle, spacing)
    return cut(W, H, fibre_angle, spacing, **(constants | changes))


def rotation(angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s], [s, c]])


def energies(net, places, wall_rotation=0.0):
    rotations = np.full(len(net.ends), wall_rotation)
    return NetEnergy(net).energies(places - net.nodes, rotations)


def total(net, places, wall_rotation=0.0):
    return sum(energies(net, places, wall_rotation).values())


def density(F, fibre_angle, stretch=K_E, shear=K_P):
    """First and last term of (31) for a homogeneous deformation, J/m²."""
    a1, a2 = (F @ rotation(math.radians(fibre_angle))).T
    psi = math.pi / 2 - math.acos(a1 @ a2 / math.sqrt((a1 @ a1) * (a2 @ a2)))
    return {
        "stretch": sum(0.5 * stretch * (math.sqrt(a @ a) - 1) ** 2 for a in (a1, a2)),
        "shear": 0.5 * shear * ((psi**2 + DELTA**2) ** (GAMMA / 2) - DELTA**GAMMA),
    }


@pytest.mark.parametrize("pivots", ["averaged", "literal"])
@pytest.mark.parametrize("fibre_angle", [45.0, 0.0, 30.0])
@pytest.mark.parametrize("angle", [0.3, 3.0, -2.0])
def test_a_rigid_motion_stores_nothing_and_pulls_at_nothing(fibre_angle, pivots, angle):
    net = sheet_net(fibre_angle, pivots=pivots, clamped=("bottom", "top"))
    places = net.nodes @ rotation(angle).T + [0.3, -0.1]
    assert total(net, places, angle) == pytest.approx(0.0, abs=1e-12)
    gradient = NetEnergy(net).gradient(places - net.nodes, np.full(2, angle))
    assert np.abs(gradient).max() < 1e-8 * K_E * 0.0048


@given(st.floats(-math.pi, math.pi), st.integers(0, 100))
def test_energy_is_that_of_the_turned_shape(angle, seed):
    net = sheet_net(30.0, 0.02, clamped=("bottom",))
    places = net.nodes + np.random.default_rng(seed).uniform(-2e-3, 2e-3, net.nodes.shape)
    turned = places @ rotation(angle).T + [0.1, 0.2]
    assert total(net, turned, angle) == pytest.approx(total(net, places), rel=1e-9)


@pytest.mark.parametrize("fibre_angle", [45.0, 0.0, 90.0, -45.0])
@pytest.mark.parametrize("F", [[[1.2, 0.0], [0.0, 0.8]], [[1.0, 0.3], [0.1, 1.1]]])
def test_a_homogeneous_deformation_has_the_energy_of_the_sheet(fibre_angle, F):
    net = sheet_net(fibre_angle)
    F = np.array(F)
    found, expected = energies(net, net.nodes @ F.T), density(F, fibre_angle)
    assert found["stretch"] == pytest.approx(W * H * expected["stretch"], rel=1e-9)
    assert found["shear"] == pytest.approx(W * H * expected["shear"], rel=1e-9)
    assert found["bending"] == pytest.approx(0.0, abs=1e-12)


def test_literal_pivots_miss_the_nodes_without_the_quadrant():
    """At 45°, nodes on the sides and on the top edge lack +D1 or +D2, or both."""
    net = sheet_net(pivots="literal")
    F = np.array([[1.2, 0.0], [0.0, 0.8]])
    spacing = fitted_spacing(W, H, 45.0, 0.0096)
    columns, rows = round(W / (spacing * math.sqrt(2))), round(H / (spacing * math.sqrt(2)))
    springs = rows * (columns - 1) + rows * columns
    found = energies(net, net.nodes @ F.T)["shear"]
    assert found == pytest.approx(springs * spacing**2 * density(F, 45.0)["shear"], rel=1e-9)


def test_shear_is_positive_where_fibres_close_up_in_every_quadrant():
    """The quadrants of a node differ in which of its links they join, not in the sign of ψ."""
    net = sheet_net(exponent=2.0)
    energy = NetEnergy(net)
    pivots = energy.rotational.pivots(energy.state(net.nodes * [-0.2, 0.2]))
    psi = pivots.first / net.pivots.stiffness
    np.testing.assert_allclose(psi, 2 * math.atan(1.2 / 0.8) - math.pi / 2, rtol=1e-12)


def test_an_effect_that_is_absent_has_no_springs():
    net = sheet_net(bending=None, shear=0.0)
    assert (net.turns, net.walls, net.pivots, net.ground) == (None, None, None, None)
    assert list(energies(net, net.nodes)) == ["stretch"]


# From (1) to (16): a smooth deformation of the axis, with horizontal ends that are curved.

LENGTH, AXIAL, BENDING = 1.0, 4e3, 70.0


def axis(s):
    """Places on a bent and stretched axis, shape (n, 2)."""
    return np.column_stack(
        [s + 0.05 * np.sin(math.pi * s), 0.8 * s**2 * (1 - s) ** 2 + 0.1 * s**2 * (3 - 2 * s)]
    )


def first_derivative(s):
    return np.column_stack(
        [
            1 + 0.05 * math.pi * np.cos(math.pi * s),
            0.8 * (2 * s - 6 * s**2 + 4 * s**3) + 0.6 * s * (1 - s),
        ]
    )


def curvature(s):
    """κ of (16), the square root of c⊥·c⊥ with its sign."""
    dx, dy = first_derivative(s).T
    ddx = -0.05 * math.pi**2 * np.sin(math.pi * s)
    ddy = 0.8 * (2 - 12 * s + 12 * s**2) + 0.6 * (1 - 2 * s)
    return (dx * ddy - dy * ddx) / (dx**2 + dy**2)


def orders(errors):
    return np.log2(np.abs(errors[:-1]) / np.abs(errors[1:]))


@pytest.mark.parametrize(("shift", "order"), [(0.0, 4.0), (0.5, 3.0)])
def test_the_turn_at_a_node_gives_the_curvature_as_in_12(shift, order):
    """Equation (12) about the node; about a point beside it an order is lost."""
    errors = []
    for spacing in 0.02 / 2.0 ** np.arange(4):
        p = axis(0.3 + spacing * np.array([-1.0, 0.0, 1.0]))
        angle = angle_between(p[1:2] - p[0:1], p[2:3] - p[1:2])
        kappa = curvature(np.array([0.3 + shift * spacing]))
        errors.append(float((turn(angle, 1.0).energy - 0.5 * (kappa * spacing) ** 2)[0]))
    assert orders(np.array(errors))[-1] == pytest.approx(order, abs=0.1)


def test_the_energy_of_a_clamped_chain_is_that_of_the_beam_with_second_order():
    points, weights = np.polynomial.legendre.leggauss(60)
    s, weights = 0.5 * (1 + points), 0.5 * weights
    rho = np.hypot(*first_derivative(s).T)
    exact = {
        "stretch": weights @ (0.5 * AXIAL * (rho - 1) ** 2),
        "bending": weights @ (0.5 * BENDING * curvature(s) ** 2),
        "foundation": 0.5 * 3e3 * weights @ ((axis(s) - np.column_stack([s, 0 * s])) ** 2).sum(1),
    }
    errors = {name: [] for name in exact}
    for spacing in (0.05, 0.025, 0.0125, 0.00625):
        net = chain(
            LENGTH,
            spacing,
            stretch=AXIAL,
            bending=BENDING,
            supports={"left": "clamped", "right": "clamped"},
            ground=winkler(LENGTH, spacing, [(LENGTH, 3e3)]),
        )
        found = energies(net, axis(net.nodes[:, 0]))
        for name, value in exact.items():
            errors[name].append(found[name] - value)
    # Of the trapezoidal sum for a displacement without slope at the ends, even of fourth.
    for name, order in (("stretch", 2.0), ("bending", 2.0), ("foundation", 4.0)):
        found = orders(np.array(errors[name]))
        np.testing.assert_allclose(found, order, atol=0.1, err_msg=name)


def test_a_foundation_in_pieces_loses_nothing():
    ground = winkler(1.0, 0.1, [(0.37, 2e8), (1.0, 8e6)])
    assert ground.sum() == pytest.approx(0.37 * 2e8 + 0.63 * 8e6, rel=1e-12)
    np.testing.assert_allclose(ground[[0, 1, 9, 10]], [1e7, 2e7, 8e5, 4e5], rtol=1e-12)
    assert ground[4] == pytest.approx(0.02 * 2e8 + 0.08 * 8e6, rel=1e-12)
