"""What mechanics demands of a path: work, bounds, constraints, and effects that are absent."""

from pathlib import Path

import numpy as np
import pytest

from .distributed import largest, own_blocks, total
from .processes import SEVERAL

pytestmark = pytest.mark.core

W, H = 0.068, 0.204
FULL = 0.0567  # m, beyond the inextensible limit


def held(hold):
    return {"bottom": {"hold": hold}, "top": {"hold": hold}}


def test_force_is_the_slope_of_the_energy_along_the_bias_extension(solve):
    """dE/dΔ = F, from the soft start to beyond the lock-up of the fibres."""
    loads, h = (0.3, 0.6, 0.9, 0.99), 0.002
    stops = [round(load + k * h, 6) for load in loads for k in (-1, 0, 1)]
    sheet = solve(grips={"top": {"translation": [0.0, FULL]}}, continuation={"stops": stops})
    rows = {row.load: row for row in sheet.rows}
    for load in loads:
        before, here, after = (rows[round(load + k * h, 6)] for k in (-1, 0, 1))
        slope = (after.energy - before.energy) / (2 * h * FULL)
        assert slope == pytest.approx(here.force[1], rel=1e-4)
    assert rows[0.99].force[1] > 2.5 * rows[0.6].force[1]


@pytest.fixture(scope="module")
def stiffer_and_stiffer(solve):
    return [
        solve(material={"stretch": factor * 1.34e5}, grips={"top": {"translation": [0.0, 0.04]}})
        for factor in (0.1, 1, 10, 100)
    ]


def test_stiffer_fibres_store_more_and_resist_more(stiffer_and_stiffer):
    energies = [sheet.last.energy for sheet in stiffer_and_stiffer]
    forces = [sheet.last.force[1] for sheet in stiffer_and_stiffer]
    assert (np.diff(energies) > 0).all()
    assert (np.diff(forces) > 0).all()


def test_an_extensible_sheet_stores_less_than_a_hardly_extensible_one_all_along(
    stiffer_and_stiffer,
):
    soft, stiff = (
        {row.load: row.energy for row in stiffer_and_stiffer[i].rows if row.load} for i in (1, 3)
    )
    common = soft.keys() & stiff.keys()
    assert len(common) >= 2
    assert all(soft[load] < stiff[load] for load in common)


@pytest.mark.parametrize("scheme", ["micromorphic", "hinge"])
def test_a_clamp_is_one_constraint_more(solve, scheme):
    """On the same mesh its energy is no lower; how the grips hold does not touch the dofs."""
    changes = {"mesh": {"grip_size": 0.01}, "discretisation": {"scheme": scheme}}
    free, clamped = (solve(grips=held(hold), **changes) for hold in ("position", "clamp"))
    assert clamped.last.energy > free.last.energy
    assert clamped.last.force[1] > free.last.force[1]
    assert clamped.summary["dofs"] == free.summary["dofs"]
    for sheet in (free, clamped):
        assert all(row.negative_pivots == row.expected_negative_pivots for row in sheet.rows)
        assert all(row.stable for row in sheet.rows)


def test_a_clamp_holds_the_gradient_at_its_rotation(coarse_path):
    angle = 25.0
    simulation, steps = coarse_path(
        mesh={"grip_size": 0.01},
        discretisation={"degree": 2},
        grips={
            "bottom": {"hold": "clamp"},
            "top": {"hold": "clamp", "translation": [0.0, 0.02], "rotation": angle},
        },
    )
    dofs, places = own_blocks(simulation.equilibrium, "gradient")
    F = np.eye(2) + steps[-1].x[dofs].reshape(-1, 2, 2)
    y = places[:, 1]
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    at_top, at_bottom = np.abs(y - H) < 1e-9, np.abs(y) < 1e-9
    assert total(at_top.sum()) > 3
    assert total(at_bottom.sum()) > 3
    np.testing.assert_allclose(F[at_top], np.broadcast_to([[c, -s], [s, c]], F[at_top].shape))
    np.testing.assert_allclose(F[at_bottom], np.broadcast_to(np.eye(2), F[at_bottom].shape))
    assert largest(F - np.eye(2)) > 0.3


def test_a_position_grip_leaves_the_gradient_free(coarse_path):
    simulation, steps = coarse_path(discretisation={"degree": 2})
    dofs, places = own_blocks(simulation.equilibrium, "gradient")
    H_top = steps[-1].x[dofs][np.abs(places[:, 1] - H) < 1e-9]
    assert largest(H_top) > 0.05


@pytest.fixture(scope="module")
def small_extension(solve):
    return {
        name: solve(material=material, grips={"top": {"translation": [0.0, 0.01]}})
        for name, material in (
            ("full", {}),
            ("no bending", {"bending": None}),
            ("linear pivots", {"shear_exponent": None}),
        )
    }


def test_without_bending_the_displacement_is_all_there_is(small_extension):
    full, plain = small_extension["full"], small_extension["no bending"]
    assert set(full.summary["dofs"]) == {"displacement", "gradient", "multiplier"}
    assert full.summary["dofs"]["gradient"] == full.summary["dofs"]["multiplier"]
    assert full.last.expected_negative_pivots == full.summary["dofs"]["multiplier"]
    assert plain.summary["dofs"] == {"displacement": full.summary["dofs"]["displacement"]}
    assert all(row.expected_negative_pivots == row.negative_pivots == 0 for row in plain.rows)
    assert plain.rows[-1].columns()["energy_bending"] == 0.0
    assert not any("curvature" in name or "bending" in name for name in plain.fields)


def test_bending_stiffens(small_extension):
    full, plain = small_extension["full"], small_extension["no bending"]
    assert full.last.energies["bending"] > 0
    assert full.last.energy > plain.last.energy
    assert full.last.force[1] > plain.last.force[1]


@pytest.mark.skipif(SEVERAL, reason="MUMPS then sums in an order of the moment")
def test_linear_pivots_do_not_see_the_regularisation(solve, small_extension):
    load = {"top": {"translation": [0.0, 0.01]}}
    linear = small_extension["linear pivots"]
    rounded = solve(
        material={"shear_exponent": 2.0},
        discretisation={"shear_regularisation": 0.5},
        grips=load,
    )
    assert rounded.last == linear.last
    # For an exponent below 2 a δ of that size matters, which shows that the key is read.
    power = small_extension["full"]
    blunt = solve(discretisation={"shear_regularisation": 0.5}, grips=load)
    assert abs(blunt.last.energy / power.last.energy - 1) > 0.1


def test_linear_pivots_answer_in_proportion_at_small_loads(solve):
    """With γ = 2 all is linear near rest: twice the displacement, twice the force."""
    one, two = (
        solve(material={"shear_exponent": None}, grips={"top": {"translation": [0.0, d]}})
        for d in (1e-7, 2e-7)
    )
    assert two.last.force[1] == pytest.approx(2 * one.last.force[1], rel=1e-4)
    assert two.last.energy == pytest.approx(4 * one.last.energy, rel=1e-4)
    assert one.last.energy == pytest.approx(0.5 * one.last.force[1] * 1e-7, rel=1e-4)


@pytest.mark.skipif(SEVERAL, reason="long; test_processes has one")
@pytest.mark.parametrize(
    ("scheme", "degree", "size", "corner_size"),
    [
        ("micromorphic", 3, 0.02, 0.01),
        ("micromorphic", 3, 0.01, 0.0005),
        ("micromorphic", 2, 0.01, 0.0005),
        ("hinge", 2, 0.02, 0.01),
        ("hinge", 2, 0.01, 0.0005),
        ("hinge", 3, 0.01, 0.0005),
    ],
)
def test_upright_fibres_lose_stability_at_their_buckling_load(
    solve, scheme, degree, size, corner_size
):
    r"""Fibres along x and y, compressed along y by the force N per width.

    The sway u_x(y) with hinged ends bends the upright fibres and turns them against the others,
    so N λ = K_b k² + K_p with N = K_e (1 - λ), k = π/H: Euler's load of extensible fibres with the
    pivots (γ = 2) as a rotational foundation. Wrinkles of single elements must not come first.
    """
    K_e, K_b, K_p = 1.34e5, 10.0, 1.59e2
    resistance = K_b * (np.pi / H) ** 2 + K_p
    critical = H * (1 - np.sqrt(1 - 4 * resistance / K_e)) / 2  # (1 - λ) H
    sheet = solve(
        sheet={"fibre_angle": 0.0},
        material={"bending": K_b, "shear_exponent": None},
        discretisation={"scheme": scheme, "degree": degree},
        mesh={"size": size, "corner_size": corner_size},
        grips={"top": {"translation": [0.0, -1.03 * critical]}},
        continuation={"stops": [0.97 / 1.03, 1.0]},
    )
    unstable_from = next(row.load * 1.03 for row in sheet.rows if not row.stable)
    stable_to = max(row.load * 1.03 for row in sheet.rows if row.stable)
    assert 0.97 <= stable_to < unstable_from <= 1.03
    first = next(row for row in sheet.rows if not row.stable)
    assert first.negative_pivots == first.expected_negative_pivots + 1
    assert sheet.last.force[1] == pytest.approx(-W * K_e * 1.03 * critical / H, rel=1e-6)


@pytest.mark.slow
def test_a_sheet_with_a_hole_is_softer_than_one_without(solve):
    file = Path(__file__).parents[1] / "meshes" / "specimen_with_hole.msh"
    load = {"top": {"translation": [0.0, 0.01]}}
    holed = solve(mesh={"file": str(file), "size": None, "corner_size": None}, grips=load)
    whole = solve(mesh={"size": 0.006, "corner_size": 0.001}, grips=load)
    assert all(row.stable for row in holed.rows)
    assert all(row.negative_pivots == row.expected_negative_pivots for row in holed.rows)
    assert 0.3 * whole.last.energy < holed.last.energy < 0.97 * whole.last.energy
    # The mesh is not quite symmetric, the sheet is.
    assert holed.last.force[0] == pytest.approx(0.0, abs=1e-2 * holed.last.force[1])
