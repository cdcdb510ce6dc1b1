"""A triangulated sheet and the edges that its grips hold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Triangulation:
    """First-order triangles in the plane.

    Parameters
    ----------
    points
        Coordinates, shape (n, 2), in the unit of length of the case.
    triangles
        Indices of the corners, anticlockwise, shape (m, 3).
    edges
        The edges of each grip, "bottom" and "top", shape (k, 2) each: indices of their ends,
        ordered with the sheet on the left.
    """

    points: NDArray[np.float64]
    triangles: NDArray[np.int64]
    edges: dict[str, NDArray[np.int64]]

    @property
    def areas(self) -> NDArray[np.float64]:
        """Area of each triangle, shape (m,)."""
        return signed_areas(self.points, self.triangles)

    @property
    def area(self) -> float:
        """Area of the sheet."""
        return float(self.areas.sum())

    @property
    def edge_lengths(self) -> NDArray[np.float64]:
        """Lengths of the three edges of each triangle, shape (m, 3)."""
        return edge_lengths(self.points, self.triangles)

    @property
    def quality(self) -> NDArray[np.float64]:
        r"""Shape of each triangle, shape (m,): 1 if equilateral, towards 0 if flat.

        .. math:: q = 4\sqrt{3}\,A / (l_1^2 + l_2^2 + l_3^2)
        """
        return 4.0 * np.sqrt(3.0) * self.areas / (self.edge_lengths**2).sum(axis=1)

    @property
    def boundary_edges(self) -> NDArray[np.int64]:
        """Edges of a single triangle, with the sheet on the left, shape (k, 2)."""
        return boundary_edges(self.triangles)


def signed_areas(points: NDArray[np.float64], triangles: NDArray[np.int64]) -> NDArray[np.float64]:
    """Areas, shape (m,), positive for anticlockwise triangles."""
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    ab, ac = b - a, c - a
    return 0.5 * (ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0])


def edge_lengths(points: NDArray[np.float64], triangles: NDArray[np.int64]) -> NDArray[np.float64]:
    """Lengths of the three edges of each triangle, shape (m, 3)."""
    ends = points[directed_edges(triangles)]
    return np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).reshape(-1, 3)


def directed_edges(triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    """Edges of all triangles in their sense of rotation, three rows a triangle, shape (3m, 2)."""
    return triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)


def edge_keys(edges: NDArray[np.int64], n_points: int) -> NDArray[np.int64]:
    """One number for each edge, shape (k,), the same in both directions."""
    return edges.min(axis=1) * n_points + edges.max(axis=1)


def boundary_edges(triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    """Edges of a single triangle in its sense of rotation, shape (k, 2)."""
    directed = directed_edges(triangles)
    keys = edge_keys(directed, int(triangles.max()) + 1)
    _, edge, count = np.unique(keys, return_inverse=True, return_counts=True)
    return directed[count[edge] == 1]
