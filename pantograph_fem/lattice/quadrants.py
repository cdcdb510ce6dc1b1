"""The springs of pivots: which links they join, and how much of the sheet they stand for."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Between which links at a node a quadrant lies: 1 along +D1 or +D2, 0 along -D1 or -D2.
_QUADRANTS = ((1, 1), (0, 1), (0, 0), (1, 0))


def links_at_nodes(links: IntArray, family: IntArray, nodes: int) -> IntArray:
    """Number of the link of a family along -D (0) and +D (1) of a node, -1 without one.

    The shape is (2 families, 2 sides, n nodes); links (m, 2) run along +D of their family (m,).
    """
    at = np.full((2, 2, nodes), -1)
    for side, end in ((0, 1), (1, 0)):
        at[family, side, links[:, end]] = np.arange(len(links))
    return at


def literal_quadrants(at: IntArray) -> IntArray:
    """Pairs of links (p, 2) along +D1 and +D2 of each node that has both, as (19) has it."""
    pairs, _ = _pairs(at, (1, 1))
    return pairs


def all_quadrants(at: IntArray) -> tuple[IntArray, IntArray]:
    """Pairs of links (p, 2) of all quadrants at all nodes, and the node of each (p,)."""
    found = [_pairs(at, quadrant) for quadrant in _QUADRANTS]
    return (
        np.concatenate([links for links, _ in found]),
        np.concatenate([nodes for _, nodes in found]),
    )


def averaged_quadrants(links: IntArray, at: IntArray, areas: Array) -> tuple[IntArray, Array]:
    """Pairs of links (p, 2) of all quadrants at all nodes, and the area of each (p,), m².

    The area of a node (n,) is shared equally by its quadrants. Where it has none, its neighbours
    take an equal share each.
    """
    pairs, nodes = all_quadrants(at)
    quadrants = np.bincount(nodes, minlength=len(areas))
    degree = np.bincount(links.ravel(), minlength=len(areas))
    given = np.where(quadrants == 0, areas, 0.0)
    shares = given / degree
    received = np.zeros(len(areas))
    for giver, taker in ((0, 1), (1, 0)):
        received += np.bincount(links[:, taker], shares[links[:, giver]], minlength=len(areas))
    total = areas + received
    return pairs, total[nodes] / quadrants[nodes]


def _pairs(at: IntArray, quadrant: tuple[int, int]) -> tuple[IntArray, IntArray]:
    """Links on both sides of a quadrant, and the node, wherever there are both."""
    first, second = at[0, quadrant[0]], at[1, quadrant[1]]
    nodes = np.flatnonzero((first >= 0) & (second >= 0))
    return np.column_stack([first[nodes], second[nodes]]), nodes
