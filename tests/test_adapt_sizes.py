"""New sizes from indicators: growth, symmetry, gradation; and meshes that follow them."""

import numpy as np
import pytest

from pantograph_fem.adapt.sizes import GRADATION, SHRINKAGE, Gradation, mirror_images, new_sizes
from pantograph_fem.errors import CaseError
from pantograph_fem.mesh import SizeField, Triangulation, rectangle, rectangle_by_sizes

W, H = 0.068, 0.204


@pytest.fixture(scope="module")
def mesh():
    return rectangle(W, H, 0.008, 0.008)


def centres(mesh):
    return mesh.points[mesh.triangles].mean(axis=1)


def remeshed(mesh, indicators, growth=2.2, order=2.0):
    return rectangle_by_sizes(W, H, new_sizes(mesh, indicators, growth, order))


@pytest.mark.parametrize("growth", [2.2, 4.0])
def test_number_of_cells_grows_as_asked(mesh, growth):
    x, y = centres(mesh).T
    eta = np.exp(-np.hypot(x, y) / 0.03)
    finer = remeshed(mesh, eta, growth)
    assert len(finer.triangles) / len(mesh.triangles) == pytest.approx(growth, rel=0.2)
    assert finer.area == pytest.approx(W * H, rel=1e-12)
    assert finer.quality.min() > 0.5
    assert {grip: len(edges) > 3 for grip, edges in finer.edges.items()} == {
        "bottom": True,
        "top": True,
    }


def test_equal_errors_ask_for_equal_sizes(mesh):
    eta = mesh.areas**1.5  # of an error density that is the same everywhere
    sizes = new_sizes(mesh, eta, 4.0, 2.0).sizes
    assert np.ptp(sizes) < 0.1 * sizes.mean()


def test_no_error_at_all_refines_all_over(mesh):
    sizes = new_sizes(mesh, np.zeros(len(mesh.triangles)), 4.0, 2.0).sizes
    assert 0.3 < sizes.mean() / 0.008 < 0.7


def test_the_largest_of_four_mirror_images_counts(mesh):
    corner = centres(mesh) - (W, H)
    eta = 1e-3 + np.exp(-np.linalg.norm(corner, axis=1) / 0.01)  # at the upper right only
    finer = remeshed(mesh, eta)
    for axis, side in ((0, W), (1, H)):
        image = finer.points.copy()
        image[:, axis] = side - image[:, axis]
        order, other = (np.lexsort(np.round(p, 9).T) for p in (finer.points, image))
        np.testing.assert_allclose(image[other], finer.points[order], atol=1e-15)
    size = np.sqrt(finer.areas)
    near = np.linalg.norm(centres(finer), axis=1) < 0.01
    assert size[near].mean() < 0.6 * size.mean()


def test_sizes_shrink_by_a_bounded_ratio_and_grow_gently(mesh):
    eta = np.full(len(mesh.triangles), 1e-6)
    eta[np.argmin(np.linalg.norm(centres(mesh), axis=1))] = 1e6
    field = new_sizes(mesh, eta, 2.2, 2.0)
    old = np.sqrt(mesh.areas * 4 / np.sqrt(3))
    assert field.sizes.min() >= old.min() * 2.2**-SHRINKAGE * 0.999
    edges = field.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    rise = np.abs(np.diff(field.sizes[edges], axis=1)[:, 0])
    length = np.linalg.norm(np.diff(field.points[edges], axis=1)[:, 0], axis=1)
    assert (rise <= GRADATION * length * (1 + 1e-9)).all()


def test_gradation_lowers_only_what_is_too_steep():
    x = np.linspace(0.0, 1.0, 11)
    points = np.vstack([np.column_stack([x, 0 * x]), np.column_stack([x, 0 * x + 0.1])])
    lower = np.array([(i, i + 1, i + 11) for i in range(10)])
    upper = np.array([(i + 1, i + 12, i + 11) for i in range(10)])
    grade = Gradation(points, np.vstack([lower, upper]), 0.5)
    gentle = 0.2 + 0.3 * points[:, 0]
    np.testing.assert_allclose(grade(gentle), gentle, rtol=1e-14)
    steep = np.where(points[:, 0] == 0.0, 0.1, 9.0)
    assert grade(steep)[:11] == pytest.approx(0.1 + 0.5 * x)


def test_meshes_without_symmetry_are_refused(mesh):
    points = mesh.points.copy()
    points[np.argmin(np.linalg.norm(points - (0.02, 0.05), axis=1))] += 1e-3
    with pytest.raises(ValueError, match="not symmetric"):
        mirror_images(Triangulation(points, mesh.triangles, mesh.edges))


def test_equal_sizes_give_equal_meshes(mesh):
    eta = np.linspace(1.0, 2.0, len(mesh.triangles))
    first, second = (remeshed(mesh, eta) for _ in range(2))
    assert np.array_equal(first.points, second.points)
    assert np.array_equal(first.triangles, second.triangles)


@pytest.mark.parametrize("wrong", [0.0, -1.0, np.nan])
def test_sizes_must_be_positive(mesh, wrong):
    field = SizeField(mesh.points, mesh.triangles, np.full(len(mesh.points), wrong))
    with pytest.raises(CaseError, match="positive length"):
        rectangle_by_sizes(W, H, field)
