"""Which is which among the same things in two orders.

How dolfinx numbers nodes depends on the number of processes and on when their messages arrive.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

#: Distance, over the extent of the points along each axis, within which two are the same.
_ROUND_OFF = 1e-8


def same_points(points: NDArray[np.float64], known: NDArray[np.float64]) -> NDArray[np.int64]:
    """Row of `points` that is each row of `known`; both have the shape (n, d).

    Raises
    ------
    ValueError
        If they are not the same points, each once.
    """
    if points.shape != known.shape:
        raise ValueError(f"{len(known)} points are known, and {len(points)} are there")
    if not len(known):  # a process may have none
        return np.empty(0, dtype=np.int64)
    extent = np.ptp(known, axis=0)
    extent[extent == 0.0] = np.abs(known).max() or 1.0
    if np.abs((points - known) / extent).max() < _ROUND_OFF:
        return np.arange(len(points))
    distances, rows = cKDTree(points / extent).query(known / extent)
    if distances.max() > _ROUND_OFF or len(np.unique(rows)) < len(rows):
        raise ValueError("the points are not where they were")
    return np.asarray(rows, dtype=np.int64)


def same_cells(cells: NDArray[np.integer], known: NDArray[np.integer]) -> NDArray[np.int64]:
    """Row of `cells` that has the nodes of each row of `known`, in whatever order.

    Raises
    ------
    ValueError
        If they are not the same cells.
    """
    if cells.shape == known.shape:
        rows, known_rows = (np.sort(one, axis=1) for one in (cells, known))
        order, known_order = np.lexsort(rows.T), np.lexsort(known_rows.T)
        if np.array_equal(rows[order], known_rows[known_order]):
            same = np.empty(len(rows), dtype=np.int64)
            same[known_order] = order
            return same
    raise ValueError("the points are joined otherwise")
