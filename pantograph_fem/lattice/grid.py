"""Nodes and links of a square lattice within a rectangle that is held along two edges."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..case.lattice_spacing import fits

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Distances, in diagonals of the rectangle, that count as none; the second where a lattice fits.
_TOLERANCE, _FIT = 1e-9, 2e-6
#: Links to a grip that would be shorter, in spacings, are left out.
_SHORTEST = 0.05
#: Sines of angles that count as none.
_PARALLEL = 1e-9


@dataclass(frozen=True, eq=False)
class Grid:
    """Crossings of fibres, and where fibres end at a grip.

    Attributes
    ----------
    nodes
        Shape (n, 2), m; from bottom to top.
    crossing
        Whether a node is a crossing of both families, shape (n,).
    links
        First and second node along +D of the family, shape (m, 2).
    family
        0 or 1, shape (m,).
    grips
        Nodes held at the edges "bottom" and "top".
    """

    nodes: Array
    crossing: NDArray[np.bool_]
    links: IntArray
    family: IntArray
    grips: dict[str, IntArray]


def directions(fibre_angle: float) -> Array:
    """D1 and D2, shape (2, 2), from the angle of D1 to x in degrees."""
    c, s = math.cos(math.radians(fibre_angle)), math.sin(math.radians(fibre_angle))
    return np.array([[c, s], [-s, c]])


def cut_grid(width: float, height: float, fibre_angle: float, spacing: float) -> Grid:
    """The lattice within [0, W] x [0, H].

    It has a node at the corner (0, 0) where the spacing fits the rectangle, and in the middle of
    it where it does not, so that it is as symmetric as the sheet. A fibre that leaves through the
    bottom or the top goes on from its last crossing to a node on that edge, or is held at the
    last crossing where this is nearer than 0.05 ε. What goes beyond the last crossing to a free
    side carries nothing and is left out.
    """
    D = directions(fibre_angle)
    sides = np.array([width, height])
    fitting = fits(width, height, fibre_angle, spacing)
    tolerance = (_FIT if fitting else _TOLERANCE) * math.hypot(width, height)
    origin = np.zeros(2) if fitting else sides / 2
    reach = math.ceil(math.hypot(width, height) / spacing) + 1
    steps = np.arange(-reach, reach + 1)
    places = origin + spacing * (steps[:, None, None] * D[0] + steps[None, :, None] * D[1])
    within = ((places >= -tolerance) & (places <= sides + tolerance)).all(axis=2)
    number = np.full(within.shape, -1)
    number[within] = np.arange(np.count_nonzero(within))
    nodes = np.clip(places[within], 0.0, sides)

    held = {"bottom": np.zeros(len(nodes), dtype=bool), "top": np.zeros(len(nodes), dtype=bool)}
    links: list[tuple[IntArray, IntArray, int]] = []
    tails: list[tuple[IntArray, Array, int, int, str]] = []
    for family, sign in ((0, 1), (0, -1), (1, 1), (1, -1)):
        # The nodes along the border of `number` are outside, so nothing wraps around.
        neighbour = np.roll(number, -sign, axis=family)[within]
        if sign > 0:
            first = np.flatnonzero(neighbour >= 0)
            links.append((first, neighbour[first], family))
        last = np.flatnonzero(neighbour < 0)
        step = sign * D[family]
        if abs(step[1]) < _PARALLEL:
            continue
        grip = "top" if step[1] > 0 else "bottom"
        distance = ((height if step[1] > 0 else 0.0) - nodes[last, 1]) / step[1]
        ends = nodes[last] + distance[:, None] * step
        leaves = (ends[:, 0] >= -tolerance) & (ends[:, 0] <= width + tolerance)
        near = distance < _SHORTEST * spacing
        held[grip][last[leaves & near]] = True
        far = leaves & ~near
        tails.append((last[far], np.clip(ends[far], 0.0, sides), family, sign, grip))

    count = len(nodes)
    grips = {name: [np.flatnonzero(mask)] for name, mask in held.items()}
    places_on_edge = [nodes]
    anywhere = held["bottom"] | held["top"]
    for base, ends, family, sign, grip in tails:
        free = ~anywhere[base]
        added = count + np.arange(np.count_nonzero(free))
        count += len(added)
        places_on_edge.append(ends[free])
        grips[grip].append(added)
        pair = (base[free], added) if sign > 0 else (added, base[free])
        links.append((*pair, family))
    all_nodes = np.concatenate(places_on_edge)
    return _ordered(
        Grid(
            nodes=all_nodes,
            crossing=np.arange(count) < len(nodes),
            links=np.concatenate([np.column_stack([p, q]) for p, q, _ in links]),
            family=np.concatenate([np.full(len(p), family) for p, _, family in links]),
            grips={name: np.concatenate(parts) for name, parts in grips.items()},
        ),
        tolerance,
    )


def _ordered(grid: Grid, tolerance: float) -> Grid:
    """Without nodes that no link meets, and the others numbered row by row from the bottom."""
    met = np.unique(grid.links)
    x, y = np.round(grid.nodes[met] / (10 * tolerance)).T
    order = met[np.lexsort((x, y))]
    number = np.full(len(grid.nodes), -1)
    number[order] = np.arange(len(order))
    return Grid(
        nodes=grid.nodes[order],
        crossing=grid.crossing[order],
        links=number[grid.links],
        family=grid.family,
        grips={
            name: np.sort(number[nodes[number[nodes] >= 0]]) for name, nodes in grid.grips.items()
        },
    )
