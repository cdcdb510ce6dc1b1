"""New element sizes from the error indicators of the cells of a mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from ..mesh import SizeField, Triangulation

Array = NDArray[np.float64]

#: Increase of the element size per distance, at most; of elements of high order it may be this
#: multiple of the order, up to the steepest.
GRADATION, OVER_ORDER, STEEPEST = 0.3, 0.125, 0.5
#: Largest ratio of a new size to the old one; the least one is growth^-1.15. At the corners, where
#: the error falls slowly, any ratio is asked for; a small one leaves Newton's method in the dark.
LARGEST_RATIO, SHRINKAGE = 2.0, 1.15
#: Area of an equilateral triangle over its squared side.
_EQUILATERAL = np.sqrt(3.0) / 4.0


def new_sizes(mesh: Triangulation, indicators: Array, growth: float, order: float) -> SizeField:
    r"""Sizes with which the error is smallest for `growth` times as many cells.

    An indicator scales as :math:`\eta\propto h^{p+1}` with the size h of its cell, p the order of
    the error in energy norm. The sum of squares is smallest for a given number of cells where all
    are equal, so with the same τ everywhere

    .. math:: h' = h\,(\tau/\eta)^{1/(p+1)}

    Then sizes are lowered until they grow by no more than :func:`gradation` per distance.

    Parameters
    ----------
    mesh
        Mesh of the rectangle from the origin to its farthest corner, symmetric about both of its
        mid-lines.
    indicators
        η of each cell, shape (m,): parts of the error in energy norm, in any unit. Of a cell and
        its mirror images the largest counts.
    growth
        Number of new cells over that of the mesh.
    order
        p.

    Returns
    -------
    SizeField
        Sizes on the lower left quarter.
    """
    quarter, images = mirror_images(mesh)
    points, triangles = mesh.points, mesh.triangles[quarter]
    areas = mesh.areas[quarter]
    eta = indicators[images].max(axis=1)
    eta = np.maximum(eta, 1e-12 * eta.max(initial=0.0)) if eta.any() else np.ones_like(eta)
    used, index = np.unique(triangles, return_inverse=True)
    points, triangles = points[used], index.reshape(-1, 3)
    size = np.sqrt(areas / _EQUILATERAL)
    grade = Gradation(points, triangles, gradation(order))
    ratios = growth**-SHRINKAGE, LARGEST_RATIO

    def graded(log_tau: float) -> Array:
        ratio = (np.exp(log_tau) / eta) ** (1.0 / (order + 1.0))
        wanted = np.log(size * np.clip(ratio, *ratios))
        return grade(np.exp(grade.at_points(wanted)))

    def excess(log_tau: float) -> float:
        return float(np.log(count(areas, graded(log_tau)[triangles]) / (growth * len(areas))))

    logs = np.log(eta)
    low, high = (
        float(log + (order + 1.0) * np.log(ratio))
        for log, ratio in zip((logs.min(), logs.max()), ratios, strict=True)
    )
    if excess(low) <= 0.0:  # more cells than the ratios allow
        return SizeField(points, triangles, graded(low))
    return SizeField(points, triangles, graded(brentq(excess, low, high, xtol=1e-3)))


def gradation(order: float) -> float:
    """Increase of the element size per distance that suits elements of an order."""
    return min(max(GRADATION, OVER_ORDER * order), STEEPEST)


def count(areas: Array, sizes: Array) -> float:
    """Number of cells that sizes ask for.

    Parameters
    ----------
    areas
        Of the triangles on which the sizes are given, shape (m,).
    sizes
        At their corners, shape (m, 3).
    """
    return float(areas @ (sizes**-2.0).mean(axis=1)) / _EQUILATERAL


def mirror_images(mesh: Triangulation) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Cells in the lower left quarter (n,), and these with their mirror images (n, 4).

    Raises
    ------
    ValueError
        If the mesh is not symmetric about both mid-lines of its rectangle.
    """
    centres = mesh.points[mesh.triangles].mean(axis=1)
    sides = mesh.points.max(axis=0)
    quarter = np.flatnonzero((centres < sides / 2).all(axis=1))
    tree = cKDTree(centres)
    x, y = centres[quarter].T
    images = []
    for px, py in ((x, y), (sides[0] - x, y), (x, sides[1] - y), (sides[0] - x, sides[1] - y)):
        distance, cell = tree.query(np.column_stack([px, py]))
        if distance.max() > 1e-9 * sides.max():
            raise ValueError("the mesh is not symmetric about the mid-lines of its rectangle")
        images.append(cell)
    if 4 * len(quarter) != len(centres):
        raise ValueError("the mesh has cells across a mid-line of its rectangle")
    return quarter, np.column_stack(images)


class Gradation:
    """Sizes at the points of a triangulation that grow by at most a share of the distance."""

    def __init__(
        self,
        points: Array,
        triangles: NDArray[np.int64],
        steepest: float = GRADATION,
    ) -> None:
        n = len(points)
        edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        edges = np.unique(np.sort(edges, axis=1), axis=0)
        self._rise = steepest * np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
        self._edges = edges
        self._corners = triangles.ravel()
        self._cells_of = np.bincount(self._corners, minlength=n)

    def __call__(self, sizes: Array) -> Array:
        """The largest sizes, none above those given, that do not grow too fast; shape (n,)."""
        # A size is a distance from a source that is joined to each point by an edge as long as the
        # size asked for there.
        n = len(sizes)
        source = np.full(n, n)
        rows = np.concatenate([self._edges[:, 0], source])
        columns = np.concatenate([self._edges[:, 1], np.arange(n)])
        lengths = np.concatenate([self._rise, sizes])
        graph = coo_array((lengths, (rows, columns)), shape=(n + 1, n + 1)).tocsr()
        return dijkstra(graph, directed=False, indices=n)[:n]

    def at_points(self, of_cells: Array) -> Array:
        """Mean over the cells around each point, shape (n,)."""
        sums = np.bincount(self._corners, np.repeat(of_cells, 3), minlength=len(self._cells_of))
        return sums / self._cells_of
