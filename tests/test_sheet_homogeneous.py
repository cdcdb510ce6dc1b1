"""Homogeneous states, which every mesh and degree represents exactly, through the whole program."""

import numpy as np
import pytest

pytestmark = pytest.mark.core

W, H = 0.068, 0.204
K1, K2 = 1.0e5, 2.5e5
DELTA = 0.02
STRETCH = 1 + DELTA / H


def rotation(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s], [s, c]])


@pytest.mark.parametrize(
    ("fibre_angle", "family"), [(0.0, 2), (90.0, 1), (-90.0, 1), (180.0, 2), (270.0, 1)]
)
def test_fibres_along_the_load_stretch_alone(solve, fibre_angle, family):
    """F = diag(1, λ): force W K_e (λ - 1), energy W H ½ K_e (λ - 1)², nothing else."""
    K = {1: K1, 2: K2}[family]
    sheet = solve(
        sheet={"fibre_angle": fibre_angle},
        material={"stretch": [K1, K2]},
        grips={"top": {"translation": [0.0, DELTA]}},
    )
    force = W * K * (STRETCH - 1)
    assert sheet.last.force == pytest.approx((0.0, force), rel=1e-9, abs=1e-9 * force)
    assert sheet.last.moment == pytest.approx(0.0, abs=1e-9 * force * W)
    assert sheet.last.energies["stretch"] == pytest.approx(
        W * H * 0.5 * K * (STRETCH - 1) ** 2, rel=1e-9
    )
    assert sheet.last.energy == pytest.approx(sheet.last.energies["stretch"], rel=1e-9)
    np.testing.assert_allclose(sheet.fields[f"stretch_{family}"], STRETCH, rtol=1e-10)
    np.testing.assert_allclose(sheet.fields[f"stretch_{3 - family}"], 1.0, rtol=1e-10)
    np.testing.assert_allclose(sheet.fields["shear_angle"], 0.0, atol=1e-10)
    np.testing.assert_allclose(
        sheet.displacement, np.outer(sheet.X[:, 1], [0.0, STRETCH - 1]), atol=1e-10 * H
    )
    assert all(row.stable for row in sheet.rows)


def test_force_and_energy_follow_the_closed_form_at_every_step(solve):
    sheet = solve(sheet={"fibre_angle": 0.0}, grips={"top": {"translation": [0.0, DELTA]}})
    assert len(sheet.rows) > 3
    for row in sheet.rows:
        strain = row.load * DELTA / H
        assert row.force[1] == pytest.approx(W * 1.34e5 * strain, rel=1e-9, abs=1e-9)
        assert row.energy == pytest.approx(W * H * 0.5 * 1.34e5 * strain**2, rel=1e-9, abs=1e-12)


def test_a_large_rotation_on_top_turns_the_force_and_changes_nothing_else(solve):
    angle, pivot, shift = 100.0, [0.1, 0.05], np.array([0.3, -0.1])
    R = rotation(angle)
    turned = {"rotation": angle, "pivot": pivot}
    sheet = solve(
        sheet={"fibre_angle": 0.0},
        grips={
            "bottom": turned | {"translation": shift.tolist()},
            "top": turned | {"translation": (shift + R @ [0.0, DELTA]).tolist()},
        },
    )
    force = W * 1.34e5 * (STRETCH - 1)
    np.testing.assert_allclose(sheet.last.force, R @ [0.0, force], atol=1e-9 * force)
    assert sheet.last.moment == pytest.approx(0.0, abs=1e-9 * force * W)
    assert sheet.last.energy == pytest.approx(W * H * 0.5 * 1.34e5 * (STRETCH - 1) ** 2, rel=1e-9)
    np.testing.assert_allclose(sheet.fields["stretch_2"], STRETCH, rtol=1e-9)
    np.testing.assert_allclose(sheet.fields["shear_angle"], 0.0, atol=1e-9)
    stretched = sheet.X * [1.0, STRETCH]
    expected = pivot + shift + (stretched - pivot) @ R.T
    np.testing.assert_allclose(sheet.X + sheet.displacement, expected, atol=1e-9 * H)


def test_grips_held_still_leave_the_sheet_at_rest(solve):
    sheet = solve(grips={"top": None})
    for row in sheet.rows:
        assert np.abs(row.force).max() < 1e-9 * 1.34e5 * W
        assert row.stable
    assert sheet.last.load == 1.0
    np.testing.assert_allclose(sheet.displacement, 0.0, atol=1e-12)


@pytest.mark.parametrize("angle", [60.0, 170.0])
def test_two_grips_that_move_as_one_body_meet_no_resistance(solve, angle):
    pivot, shift = np.array([0.1, 0.05]), np.array([0.3, -0.1])
    motion = {"rotation": angle, "pivot": pivot.tolist(), "translation": shift.tolist()}
    sheet = solve(
        grips={"bottom": motion, "top": motion}, mesh={"size": 0.034, "corner_size": 0.034}
    )
    scale = 1.34e5 * W  # N: what a stretch of order one takes
    for row in sheet.rows:
        assert np.abs(row.force).max() < 1e-9 * scale
        assert abs(row.moment) < 1e-9 * scale * W
        assert row.energy < 1e-12 * scale * W
        assert row.stable
    expected = pivot + shift + (sheet.X - pivot) @ rotation(angle).T
    np.testing.assert_allclose(sheet.X + sheet.displacement, expected, atol=1e-9)
