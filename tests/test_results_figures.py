"""Figures: the curves and colours they are made of, and the files they become."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from pantograph_fem.errors import CaseError
from pantograph_fem.results.colours import (
    QUANTITIES,
    colour_scale,
    node_weights,
    weighted_percentile,
)
from pantograph_fem.results.fields import FieldGrid
from pantograph_fem.results.fields_writer import FieldsWriter
from pantograph_fem.results.figures import draw_figures
from pantograph_fem.results.force_figure import grip_panels
from pantograph_fem.results.history import HistoryRow, HistoryWriter
from pantograph_fem.results.material_lines import boundary_loops, material_lines
from pantograph_fem.results.planar_pictures import planar_pictures
from pantograph_fem.results.sheet_picture import sheet_painter

W, H = 0.06, 0.18
Array = NDArray[np.float64]


def sheet(n: int = 6, keep: Callable[[Array], NDArray[np.bool_]] | None = None) -> FieldGrid:
    """A sheet of n by 3n squares cut in two; `keep` says by their centres which triangles stay."""
    x, y = np.meshgrid(np.linspace(0, W, n + 1), np.linspace(0, H, 3 * n + 1), indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel()])
    node = np.arange(len(points)).reshape(x.shape)
    a, b, c, d = node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]
    lower, upper = np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)
    triangles = np.concatenate([lower.reshape(-1, 3), upper.reshape(-1, 3)])
    if keep is not None:
        triangles = triangles[keep(points[triangles].mean(axis=1))]
    return FieldGrid(points, triangles)


def direction(degrees: float) -> Array:
    return np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])


@pytest.mark.parametrize("angle", [45.0, 135.0, 20.0, 0.0, 90.0])
def test_lines_in_a_homogeneous_deformation_are_the_mapped_straight_lines(angle: float) -> None:
    grid, spacing = sheet(), 0.0171
    F = np.array([[0.8, 0.3], [-0.1, 1.4]])
    lines = material_lines(grid, grid.points @ (F.T - np.eye(2)), direction(angle), spacing)
    offsets, across = [], direction(angle + 90)
    for line in lines:
        reference = line @ np.linalg.inv(F).T
        offset = (reference - [W / 2, H / 2]) @ across
        np.testing.assert_allclose(offset, offset[0], atol=1e-12)
        offsets.append(offset[0] / spacing)
        for x, y in reference[[0, -1]]:
            assert min(abs(x), abs(W - x), abs(y), abs(H - y)) < 1e-12
        along = reference @ direction(angle)
        assert np.all(np.diff(along) > 0)
    reach = (W * abs(across[0]) + H * abs(across[1])) / 2 // spacing
    np.testing.assert_allclose(offsets, np.arange(-reach, reach + 1), atol=1e-9)


def test_lines_converge_to_the_material_lines_of_a_curved_deformation() -> None:
    def bend(points: Array) -> Array:
        angle, radius = points[:, 1] / H, H + W - points[:, 0]
        return np.column_stack([-radius * np.cos(angle), radius * np.sin(angle)])

    errors = []
    for n in (7, 15):  # odd: no node lies on the line x = W/2
        grid = sheet(n)
        displacement = bend(grid.points) - grid.points
        (line,) = material_lines(grid, displacement, direction(90), W)
        # It becomes a circle of radius H + W/2 about the origin.
        errors.append(np.abs(np.linalg.norm(line, axis=1) - (H + W / 2)).max())
        np.testing.assert_allclose(line[-1], bend(np.array([[W / 2, H]]))[0], atol=1e-3 * W)
    assert errors[0] < 1e-3 * W
    np.testing.assert_allclose(errors[0] / errors[1], (15 / 7) ** 2, rtol=0.1)


def test_lines_stop_at_a_hole() -> None:
    grid = sheet(6, lambda c: np.abs(c - [W / 2, H / 2]).max(axis=1) > W / 6)
    still = np.zeros_like(grid.points)
    lines = material_lines(grid, still, direction(90), W / 3 - 1e-5)
    length = [float(np.ptp(line[:, 1])) for line in lines]
    np.testing.assert_allclose(length, [H, H / 2 - W / 6, H / 2 - W / 6, H])


def test_boundary_of_a_sheet_with_a_hole_is_two_closed_loops() -> None:
    grid = sheet(6, lambda c: np.abs(c - [W / 2, H / 2]).max(axis=1) > W / 6)
    loops = boundary_loops(grid.cells)
    assert all(loop[0] == loop[-1] for loop in loops)
    length = [np.linalg.norm(np.diff(grid.points[p], axis=0), axis=1).sum() for p in loops]
    np.testing.assert_allclose(sorted(length), [4 * W / 3, 2 * (W + H)])


def test_percentile_is_one_of_area() -> None:
    values, areas = np.array([3.0, 1.0, 2.0]), np.array([0.5, 90.0, 9.5])
    assert [weighted_percentile(values, areas, p) for p in (50, 99, 100)] == [1.0, 2.0, 3.0]
    assert node_weights(sheet()).sum() == pytest.approx(W * H)


def test_colours_follow_the_sign() -> None:
    areas = np.ones(200)
    shear = QUANTITIES["shear_angle"]
    both = colour_scale(np.linspace(-0.3, 0.7, 200), areas, shear)
    assert (both.lowest, both.highest) == (-0.7, 0.7)
    np.testing.assert_allclose(both.colours(0.5)[:3], [0.97] * 3, atol=0.02)  # white at no shear
    negative = colour_scale(np.linspace(-0.7, 0.01, 200), areas, shear)
    positive = colour_scale(np.linspace(-0.01, 0.7, 200), areas, shear)
    assert (negative.lowest, negative.highest) == (-0.7, 0.01)
    assert (positive.lowest, positive.highest) == (-0.01, 0.7)
    assert negative.colours(1.0) == positive.colours(0.0)  # the same colour near no shear
    unloaded = colour_scale(np.zeros(200), areas, shear)
    assert unloaded.lowest < unloaded.highest


def test_singular_energy_is_clipped_and_the_bar_says_so() -> None:
    energy = QUANTITIES["energy_density"]
    values = np.ones(1000)
    values[:5] = 1e6
    scale = colour_scale(values, np.ones(1000), energy)
    assert (scale.lowest, scale.highest, scale.exceeded) == (0.0, 1.0, "max")
    assert colour_scale(np.ones(1000), np.ones(1000), energy).exceeded == "neither"
    values[5:] = 0.0  # confined to the singularities
    assert colour_scale(values, np.ones(1000), energy).highest == 1e6


def history(**columns: list[float]) -> dict[str, Array]:
    return {name: np.array(values) for name, values in columns.items()}


def test_force_is_taken_along_the_translation() -> None:
    run = history(load=[0.0, 0.5], force_x=[0.0, 3.0], force_y=[0.0, 4.0], moment=[0.0, 7.0])
    (pull,) = grip_panels(run, (0.0, 0.1), 0.0)
    np.testing.assert_allclose(pull.x, [0.0, 50.0])
    np.testing.assert_allclose(pull.curves["along the translation"], [0.0, 4.0])
    (push,) = grip_panels(run, (0.0, -0.1), 0.0)
    np.testing.assert_allclose(push.curves["along the translation"], [0.0, -4.0])
    both, turn = grip_panels(run, (0.1, 0.0), -90.0)
    np.testing.assert_allclose(both.curves["along the translation"], [0.0, 3.0])
    np.testing.assert_allclose(both.curves["across, to its left"], [0.0, 4.0])
    np.testing.assert_allclose(turn.x, [0.0, -45.0])
    np.testing.assert_allclose(turn.curves["moment"], [0.0, 7.0])
    (turn,) = grip_panels(run, (0.0, 0.0), 60.0)
    assert turn.xlabel == "grip rotation (degrees)"
    (still,) = grip_panels(run, (0.0, 0.0), 0.0)
    np.testing.assert_allclose(still.curves["force"], [0.0, 5.0])


def run_results(directory: Path, loads: list[float]) -> None:
    grid = sheet()
    fields = FieldsWriter(directory, grid)
    with HistoryWriter(directory / "history.csv", probes=0) as writer:
        for step, load in enumerate(loads):
            x, y = grid.points.T
            fields.write(
                load,
                {
                    "displacement": load * np.column_stack([0.0 * x, 0.2 * y]),
                    "shear_angle": load * y,
                    "energy_density": load * x,
                },
            )
            writer.write(
                HistoryRow(step, load, (0.0, load), 0.0, {}, 3, 0, 0, load < 0.4, 0.0, load)
            )


def draw(directory: Path) -> list[str]:
    files = draw_figures(
        directory,
        title="Bias extension",
        stops=[0.125, 0.5, 1.0],
        panels=lambda history: grip_panels(history, (0.0, 0.05), 0.0),
        pictures=planar_pictures(sheet_painter(0.0048, 45.0), "Bias extension"),
    )
    for path in files:
        assert np.ptp(np.asarray(Image.open(path).convert("L"))) > 200
    return [path.name for path in files]


def test_figures_of_a_run_that_stopped_early_replace_earlier_ones(tmp_path: Path) -> None:
    (tmp_path / "figures").mkdir()
    (tmp_path / "figures" / "shear_angle_100.png").touch()
    (tmp_path / "figures" / "mine.png").touch()
    run_results(tmp_path, [0.0, 0.125, 0.3, 0.45])
    expected = [
        "energy_density_012.5.png",
        "energy_density_045.png",
        "force_displacement.png",
        "shear_angle_012.5.png",
        "shear_angle_045.png",
    ]
    assert draw(tmp_path) == expected
    found = sorted(path.name for path in (tmp_path / "figures").iterdir())
    assert found == sorted([*expected, "mine.png"])


def test_run_without_fields_has_its_force_curve(tmp_path: Path) -> None:
    run_results(tmp_path, [0.0, 0.3])
    (tmp_path / "fields.xdmf").unlink()
    assert draw(tmp_path) == ["force_displacement.png"]


def test_no_results_no_figures(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=r"history\.csv is missing"):
        draw(tmp_path)
    assert not list(tmp_path.iterdir())
