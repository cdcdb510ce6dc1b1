"""Which part of a sheet each node and each link of a lattice stands for."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def strip_widths(
    places: Array, direction: Array, width: float, height: float, spacing: float
) -> Array:
    """Widths of the strips of sheet for which fibres in one direction stand, m.

    A strip reaches half a spacing to either side. Where a fibre runs along the sides of the
    rectangle it ends there, so a fibre on the edge has half a strip. At other angles every strip
    is whole: what is missing beyond the ends of some links is found beside others.

    Parameters
    ----------
    places
        A point of each fibre, shape (m, 2), m.
    direction
        Of the fibres, shape (2,).
    width, height
        Sides of the rectangle, m.
    spacing
        ε, m.
    """
    across = np.flatnonzero(np.abs(direction) < 1e-9)
    if len(across) == 0:
        return np.full(len(places), spacing)
    coordinate = places[:, across[0]]
    side = (width, height)[across[0]]
    half = 0.5 * spacing
    return np.minimum(coordinate, half) + np.minimum(side - coordinate, half)


def square_areas(
    places: Array, direction: Array, width: float, height: float, spacing: float
) -> Array:
    """Areas within a rectangle of squares around points, m², shape (n,).

    Parameters are those of :func:`strip_widths`; the squares have sides of length ε along the
    direction and across it.
    """
    along = 0.5 * spacing * direction
    across = np.array([-along[1], along[0]])
    corners = np.array([along + across, across - along, -along - across, along - across])
    areas = np.full(len(places), spacing**2)
    reach = np.abs(corners).max(axis=0)
    inside = (places >= reach) & (places <= np.array([width, height]) - reach)
    for place in np.flatnonzero(~inside.all(axis=1)):
        areas[place] = clipped_area(places[place] + corners, width, height)
    return areas


def clipped_area(polygon: Array, width: float, height: float) -> float:
    """Area of a convex polygon (corners anticlockwise, shape (n, 2)) within [0, W] x [0, H]."""
    points = [(float(x), float(y)) for x, y in polygon]
    for axis, bound, sign in ((0, 0.0, 1), (0, width, -1), (1, 0.0, 1), (1, height, -1)):
        points = _clip(points, axis, bound, sign)
    if len(points) < 3:
        return 0.0
    x, y = np.array(points).T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def _clip(
    points: list[tuple[float, float]], axis: int, bound: float, sign: int
) -> list[tuple[float, float]]:
    """The part of a convex polygon where sign * (coordinate - bound) >= 0."""
    depth = [sign * (point[axis] - bound) for point in points]
    kept = []
    for here, a, b in zip(range(len(points)), depth, depth[1:] + depth[:1], strict=True):
        p, q = points[here], points[(here + 1) % len(points)]
        if a >= 0:
            kept.append(p)
        if (a >= 0) != (b >= 0):
            t = a / (a - b)
            kept.append((p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])))
    return kept
