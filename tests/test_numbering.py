"""What was numbered in one way is found again in another."""

import numpy as np
import pytest

from pantograph_fem.numbering import same_cells, same_points


def points(scale: float = 1.0) -> np.ndarray:
    """Of two components, 0 and 7, at the nodes of a grid."""
    x, y = np.meshgrid(np.linspace(0, 1, 9), np.linspace(0, 3, 7))
    grid = scale * np.column_stack([x.ravel(), y.ravel()])
    return np.vstack([np.column_stack([np.full(len(grid), c), grid]) for c in (0.0, 7.0)])


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_points_are_found_in_any_order(scale: float) -> None:
    known, rng = points(scale), np.random.default_rng(0)
    order = rng.permutation(len(known))
    round_off = 1 + 1e-14 * rng.standard_normal(known.shape)
    assert (order[same_points(known[order] * round_off, known)] == np.arange(len(known))).all()


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_points_elsewhere_are_not_the_same(axis: int) -> None:
    known = points(1e-3)
    other = known.copy()
    other[5, axis] += 1e-5 * np.ptp(known[:, axis])
    for moved in (other, other[::-1]):
        with pytest.raises(ValueError, match="not where they were"):
            same_points(moved, known)


def test_a_point_that_stands_for_two_is_refused() -> None:
    known = points()
    twice = known[::-1].copy()
    twice[3] = twice[4]
    with pytest.raises(ValueError, match="not where they were"):
        same_points(known, twice)


def test_fewer_points_are_told() -> None:
    with pytest.raises(ValueError, match="126 points are known, and 125 are there"):
        same_points(points()[1:], points())


def test_cells_are_found_whatever_the_order_of_their_nodes() -> None:
    known = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2]])
    assert same_cells(np.array([[2, 4, 3], [2, 1, 3], [0, 1, 2]]), known).tolist() == [2, 1, 0]
    for others in ([[0, 1, 2], [1, 3, 2], [3, 4, 1]], [[0, 1, 2], [1, 3, 2]]):
        with pytest.raises(ValueError, match="joined otherwise"):
            same_cells(np.array(others), known)
