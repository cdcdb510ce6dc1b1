"""Mirrored, scaled and relabelled cases give mirrored, scaled and relabelled results."""

import numpy as np
import pytest

pytestmark = pytest.mark.core

W, H = 0.068, 0.204
X_AXIS, Y_AXIS = 0, 1
#: Line of symmetry that a mirror turns the sheet about: the coordinate that changes, its value.
LEFT_RIGHT, UP_DOWN = (X_AXIS, W / 2), (Y_AXIS, H / 2)


def images(X, mirror):
    """Number of the node at the mirror image of each node."""
    axis, position = mirror
    mirrored = X.copy()
    mirrored[:, axis] = 2 * position - X[:, axis]
    distance = np.linalg.norm(X[None] - mirrored[:, None], axis=2)
    assert distance.min(axis=1).max() < 1e-9 * H  # the mesh itself is symmetric
    return distance.argmin(axis=1)


def assert_close(actual, expected, scale=None):
    """Equal to 1e-6 of the largest value, or of the scale."""
    scale = np.abs(expected).max() if scale is None else scale
    np.testing.assert_allclose(actual, expected, rtol=0, atol=1e-6 * scale)


def assert_mirrored(one, other, mirror):
    """The fields of one state are those of the other seen in a mirror: families change places."""
    axis, _ = mirror
    image = images(one.X, mirror)
    displacement = other.displacement[image]
    displacement[:, axis] *= -1
    assert_close(one.displacement, displacement)
    # Left-right takes D1 to D2 and turns angles round; up-down takes D1 to -D2 as well.
    turn = -1 if axis == X_AXIS else 1
    for field, reflected, sign in (
        ("shear_angle", "shear_angle", 1),
        ("stretch_1", "stretch_2", 1),
        ("stretch_2", "stretch_1", 1),
        ("curvature_1", "curvature_2", turn),
        ("curvature_2", "curvature_1", turn),
        ("energy_density", "energy_density", 1),
        ("energy_density_bending", "energy_density_bending", 1),
    ):
        assert_close(one.fields[field], sign * other.fields[reflected][image])


def assert_same_energies(one, other, factor=1.0):
    for effect, energy in one.last.energies.items():
        assert energy == pytest.approx(factor * other.last.energies[effect], rel=1e-6)


def assert_stable(*runs):
    for run in runs:
        assert all(row.stable for row in run.rows)
        assert all(row.negative_pivots == row.expected_negative_pivots for row in run.rows)


@pytest.fixture(scope="module")
def bias_extension(solve):
    return solve()


@pytest.mark.parametrize("mirror", [LEFT_RIGHT, UP_DOWN], ids=["left-right", "up-down"])
def test_bias_extension_has_both_symmetries(bias_extension, mirror):
    axis, _ = mirror
    middle = np.array([0.0, 0.015])  # of the sheet: half of the top's 0.03
    displacement = bias_extension.displacement - middle
    reflected = displacement[images(bias_extension.X, mirror)]
    reflected[:, axis] *= -1
    assert_close(displacement, reflected, scale=0.03)
    assert np.abs(displacement).max() > 0.01


def test_bias_extension_has_no_lateral_force_and_no_moment(bias_extension):
    for row in bias_extension.rows[1:]:
        assert row.force[0] == pytest.approx(0.0, abs=1e-6 * row.force[1])
        assert row.moment == pytest.approx(0.0, abs=1e-6 * row.force[1] * W)
        assert row.force[1] > 0


@pytest.mark.parametrize(
    ("translation", "rotation"),
    [([-0.06, 0.0], 0.0), ([0.0, 0.034], 30.0), ([0.01, -0.01], 10.0)],
    ids=["shear", "extension-rotation", "compression"],
)
def test_a_load_mirrored_left_to_right(solve, translation, rotation):
    x, y = translation
    one = solve(grips={"top": {"translation": [x, y], "rotation": rotation}})
    other = solve(grips={"top": {"translation": [-x, y], "rotation": -rotation}})
    assert_mirrored(one, other, LEFT_RIGHT)
    assert_same_energies(one, other)
    fx, fy = other.last.force
    scale = np.hypot(fx, fy)
    assert_close(one.last.force, (-fx, fy), scale)
    assert_close(one.last.moment, -other.last.moment, scale * W)
    assert abs(fx) > 0.1 * scale
    assert_stable(one, other)


@pytest.mark.parametrize("pivot", ["left", "right"])
def test_a_pivot_mirrored_left_to_right(solve, pivot):
    opposite = {"left": "right", "right": "left"}[pivot]
    one = solve(grips={"top": {"rotation": 20.0, "pivot": pivot, "translation": None}})
    other = solve(grips={"top": {"rotation": -20.0, "pivot": opposite, "translation": None}})
    assert_mirrored(one, other, LEFT_RIGHT)
    assert_same_energies(one, other)
    assert one.last.moment == pytest.approx(-other.last.moment, rel=1e-6)


def test_grips_that_change_places(solve):
    """Loading the bottom is the mirror image of loading the top; forces are equal and opposite."""
    x, y, angle = 0.01, 0.02, 15.0
    top = solve(grips={"top": {"translation": [x, y], "rotation": angle}})
    bottom = solve(
        grips={"top": None, "bottom": {"translation": [x, -y], "rotation": -angle}},
    )
    assert_mirrored(top, bottom, UP_DOWN)
    assert_same_energies(top, bottom)
    fx, fy = top.last.force
    scale = np.hypot(fx, fy)
    # The mirror image of what the held grip exerts: -f, and what balances the moments.
    assert_close(bottom.last.force, (-fx, fy), scale)
    balance = top.last.moment + x * fy - (H + y) * fx
    assert_close(bottom.last.moment, balance, scale * H)


def test_only_the_relative_motion_of_the_grips_counts(solve):
    by_top = solve(grips={"top": {"translation": [0.01, 0.02]}})
    by_bottom = solve(grips={"top": None, "bottom": {"translation": [-0.01, -0.02]}})
    assert_close(by_bottom.last.force, by_top.last.force)
    assert by_bottom.last.moment == pytest.approx(by_top.last.moment, rel=1e-6)
    assert_same_energies(by_bottom, by_top)
    assert_close(by_bottom.displacement + np.array([0.01, 0.02]), by_top.displacement)


def test_a_bias_extension_seen_from_a_turned_frame(solve, bias_extension):
    """Both grips turned by 60 degrees besides: the force turns, all else is the same."""
    c, s = np.cos(np.pi / 3), np.sin(np.pi / 3)
    R, pivot = np.array([[c, -s], [s, c]]), np.array([0.02, 0.05])
    turned = {"rotation": 60.0, "pivot": pivot.tolist()}
    up = (R @ [0.0, 0.03]).tolist()
    sheet = solve(grips={"bottom": turned, "top": turned | {"translation": up}})
    assert_close(sheet.last.force, R @ bias_extension.last.force)
    assert_close(sheet.last.moment, 0.0, scale=bias_extension.last.force[1] * W)
    assert_same_energies(sheet, bias_extension)
    upright = bias_extension.X + bias_extension.displacement
    assert_close(sheet.X + sheet.displacement, pivot + (upright - pivot) @ R.T)
    for name in ("shear_angle", "stretch_1", "stretch_2", "curvature_1", "curvature_2"):
        assert_close(sheet.fields[name], bias_extension.fields[name])


def test_families_that_change_places(solve):
    stretch, bending = [0.7e5, 2.1e5], [1e-2, 3e-2]
    one = solve(
        material={"stretch": stretch, "bending": bending},
        grips={"top": {"translation": [-0.05, 0.01]}},
    )
    other = solve(
        material={"stretch": stretch[::-1], "bending": bending[::-1]},
        grips={"top": {"translation": [0.05, 0.01]}},
    )
    assert_mirrored(one, other, LEFT_RIGHT)
    fx, fy = other.last.force
    assert_close(one.last.force, (-fx, fy))
    assert one.last.moment == pytest.approx(-other.last.moment, rel=1e-6)
    # The families do differ: without the mirror the same load gives another force.
    unswapped = solve(
        material={"stretch": stretch, "bending": bending},
        grips={"top": {"translation": [0.05, 0.01]}},
    )
    assert abs(unswapped.last.force[0] / fx - 1) > 0.01


def test_a_quarter_turn_of_the_fibres_renames_the_families(solve):
    stretch, bending = [0.7e5, 2.1e5], [1e-2, 3e-2]
    load = {"top": {"translation": [-0.03, 0.01]}}
    one = solve(material={"stretch": stretch, "bending": bending}, grips=load)
    other = solve(
        sheet={"fibre_angle": -45.0},
        material={"stretch": stretch[::-1], "bending": bending[::-1]},
        grips=load,
    )
    assert_close(one.displacement, other.displacement)
    assert_close(one.last.force, other.last.force)
    # D1 becomes D2 and D2 becomes -D1: the angle between them becomes its supplement.
    assert_close(one.fields["shear_angle"], -other.fields["shear_angle"])
    assert_close(one.fields["stretch_1"], other.fields["stretch_2"])


def test_constants_times_a_factor_give_the_same_shape(solve, bias_extension):
    c = 7.0
    stiffer = solve(
        material={"stretch": c * 1.34e5, "bending": c * 1.92e-2, "shear": c * 1.59e2},
    )
    assert_close(stiffer.displacement, bias_extension.displacement)
    assert stiffer.last.force[1] == pytest.approx(c * bias_extension.last.force[1], rel=1e-8)
    assert stiffer.last.energy == pytest.approx(c * bias_extension.last.energy, rel=1e-8)
    assert len(stiffer.rows) == len(bias_extension.rows)


def test_millimetres_give_the_answer_of_metres(solve, bias_extension):
    """Lengths in mm and forces in N: K_e and K_p in N/mm, K_b in N mm, energy in N mm."""
    in_mm = solve(
        sheet={"width": 68.0, "height": 204.0},
        material={"stretch": 1.34e2, "bending": 19.2, "shear": 0.159},
        grips={"top": {"translation": [0.0, 30.0]}},
        mesh={"size": 20.0, "corner_size": 10.0},
    )
    one, other = in_mm.last, bias_extension.last
    assert one.force[1] == pytest.approx(other.force[1], rel=1e-8)
    for effect, energy in one.energies.items():
        assert energy == pytest.approx(1e3 * other.energies[effect], rel=1e-8)
    assert one.shear_max == pytest.approx(other.shear_max, rel=1e-8)
    np.testing.assert_allclose(
        in_mm.displacement, 1e3 * bias_extension.displacement, rtol=0, atol=1e-8 * 30.0
    )
    # Tolerances and step sizes are without units too.
    assert [row.newton_iterations for row in in_mm.rows] == [
        row.newton_iterations for row in bias_extension.rows
    ]
    assert [row.load for row in in_mm.rows] == [row.load for row in bias_extension.rows]
