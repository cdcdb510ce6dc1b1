"""Energy densities of (31) against closed forms, evaluated without any mesh."""

import math

import numpy as np
import pytest
import ufl
from hypothesis import given
from hypothesis import strategies as st

from pantograph_fem.physics.energy import sheet_energy
from pantograph_fem.physics.kinematics import curvature, shear_angle, stretch

K_E, K_B, K_P, GAMMA = 1.34e5, 1.92e-2, 1.59e2, 1.36
DELTA = 1e-9  # small enough to compare with the unsmoothed formula


def paper_energy(**changes):
    numbers = {
        "fibre_angle": math.pi / 4,
        "stretch": (K_E, K_E),
        "bending": (K_B, K_B),
        "shear": K_P,
        "exponent": GAMMA,
        "regularisation": DELTA,
    }
    return sheet_energy(constant=ufl.as_ufl, **(numbers | changes))


def number(expression):
    return float(expression(()))


def density(F, **changes):
    energy = paper_energy(**changes)
    return sum(number(w) for w in energy.first_gradient_densities(ufl.as_matrix(F)).values())


def stress(F, **changes):
    """First Piola-Kirchhoff stress ∂W/∂F, shape (2, 2), N/m."""
    G = ufl.variable(ufl.as_matrix(F))
    W = sum(paper_energy(**changes).first_gradient_densities(G).values())
    P = ufl.diff(W, G)
    return np.array([[number(P[i, j]) for j in range(2)] for i in range(2)])


def rotation(angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s], [s, c]])


angles = st.floats(-math.pi, math.pi)
entries = st.floats(-0.3, 0.3)


@given(angles)
def test_a_rotation_stores_nothing(angle):
    assert density(rotation(angle).tolist()) == pytest.approx(0.0, abs=1e-9)


@given(angles, entries, entries, entries, entries)
def test_energy_is_frame_indifferent(angle, a, b, c, d):
    F = np.eye(2) + np.array([[a, b], [c, d]])
    assert density((rotation(angle) @ F).tolist()) == pytest.approx(
        density(F.tolist()), rel=1e-9, abs=1e-9
    )


@given(entries, entries, entries, entries)
def test_energy_is_mirrored_with_the_sheet(a, b, c, d):
    """A reflection in x swaps the families at ±45°; equal families feel nothing of it."""
    F = np.eye(2) + np.array([[a, b], [c, d]])
    M = np.diag([-1.0, 1.0])
    assert density((M @ F @ M).tolist()) == pytest.approx(density(F.tolist()), rel=1e-12)


@given(st.floats(0.7, 1.4), st.floats(0.7, 1.4))
def test_biaxial_stress_is_the_closed_form(lx, ly):
    rho = math.sqrt((lx**2 + ly**2) / 2)
    psi = 2 * math.atan(ly / lx) - math.pi / 2
    tau = 0.5 * GAMMA * K_P * abs(psi) ** (GAMMA - 1) * np.sign(psi)
    P = stress([[lx, 0.0], [0.0, ly]])
    scale = K_E * 1e-9
    axial = K_E * (rho - 1) / rho
    assert P[0, 0] == pytest.approx(axial * lx - 2 * tau * ly / (lx**2 + ly**2), abs=scale)
    assert P[1, 1] == pytest.approx(axial * ly + 2 * tau * lx / (lx**2 + ly**2), abs=scale)
    assert P[0, 1] == pytest.approx(0.0, abs=scale)


def test_uniaxial_bias_stretch_has_the_known_force():
    P = stress([[1.2, 0.0], [0.0, 0.7509160598]])
    assert P[1, 1] == pytest.approx(0.0, abs=1e-4)
    assert P[0, 0] == pytest.approx(216.45488427, abs=1e-4)


@given(st.floats(0.8, 1.3))
def test_equibiaxial_stress(lam):
    P = stress([[lam, 0.0], [0.0, lam]])
    np.testing.assert_allclose(P, K_E * (lam - 1) * np.eye(2), atol=1e-6)


def test_picture_frame_force():
    """Sides along the fibres, pulled by the corner until the fibres have turned by ψ."""
    side, psi = 0.1, 0.5

    # Fibre stretches stay 1; the frame's diagonals change with the angle between the fibres.
    def energy_of(angle):
        half = (math.pi / 2 - angle) / 2
        F = np.sqrt(2) * np.diag([math.cos(half), math.sin(half)])
        return side**2 * density(F.tolist())

    def diagonal(angle):
        return 2 * side * math.cos((math.pi / 2 - angle) / 2)

    h = 1e-5
    force = (energy_of(psi + h) - energy_of(psi - h)) / (diagonal(psi + h) - diagonal(psi - h))
    assert force == pytest.approx(16.51234702, rel=1e-7)


@pytest.mark.parametrize("psi", [-2.0, -1.0, -1e-3, 0.0, 1e-3, 1.0, 2.0])
def test_shear_angle_is_the_signed_arccos_of_31(psi):
    a1 = ufl.as_vector((1.3, 0.0))
    a2 = ufl.as_vector((0.7 * math.sin(psi), 0.7 * math.cos(psi)))
    assert number(shear_angle(a1, a2)) == pytest.approx(psi, abs=1e-15)


@given(st.lists(st.floats(-2, 2), min_size=4, max_size=4), st.floats(0.1, 3))
def test_squared_curvature_is_the_bracket_of_31(v, length):
    a, da = np.array([length, 0.2]) + 0.1 * np.array(v[:2]), np.array(v[2:])
    bracket = (da @ da) / (a @ a) - (a @ da / (a @ a)) ** 2
    kappa = number(curvature(ufl.as_vector(a.tolist()), ufl.as_vector(da.tolist())))
    assert kappa**2 == pytest.approx(bracket, rel=1e-9, abs=1e-12)


def test_an_effect_without_stiffness_is_left_out():
    assert not paper_energy(bending=None).second_gradient
    assert not paper_energy(bending=(0.0, 0.0)).second_gradient
    assert paper_energy(bending=(0.0, K_B)).bending[0][0] == 1
    F = ufl.Identity(2)
    assert set(paper_energy(shear=None).first_gradient_densities(F)) == {"stretch"}
    assert set(paper_energy(stretch=None).first_gradient_densities(F)) == {"shear"}


def test_quadratic_pivots_need_no_regularisation():
    energy = paper_energy(exponent=2.0)
    assert energy.exponent is None
    assert energy.regularisation is None
    F = [[1.1, 0.0], [0.0, 0.9]]
    psi = 2 * math.atan(0.9 / 1.1) - math.pi / 2
    rho = math.sqrt((1.1**2 + 0.9**2) / 2)
    assert density(F, exponent=2.0) == pytest.approx(K_E * (rho - 1) ** 2 + 0.5 * K_P * psi**2)


def test_stress_vanishes_in_the_undeformed_state_in_spite_of_the_power():
    np.testing.assert_allclose(stress([[1.0, 0.0], [0.0, 1.0]]), 0.0, atol=1e-12)


def test_stretch_of_a_fibre_is_its_length():
    assert number(stretch(ufl.as_vector((3.0, 4.0)))) == 5.0
