"""A straight chain of links, energy (1), as the discrete beam."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ..case.ends import HELD
from ..errors import CaseError
from .net import End, Net, Turns, Walls

Array = NDArray[np.float64]


def chain(
    length: float,
    spacing: float,
    *,
    stretch: float | None = None,
    bending: float | None = None,
    supports: Mapping[str, str] | None = None,
    ground: Array | None = None,
) -> Net:
    r"""The chain of (1) along x from the origin, with the constants (15) of a beam.

    .. math:: k = K_e/\varepsilon, \qquad b = K_b/\varepsilon

    An end that clamps holds the direction of its link by a spring of the constant
    :math:`2K_b/\varepsilon`: the trapezoidal rule gives the end half the weight of a node inside,
    and the curvature there is the angle over half a link. So the energy stays of second order.

    Parameters
    ----------
    length
        L, m.
    spacing
        ε, m; the number of links is the integer next to L/ε.
    stretch, bending
        K_e (N) and K_b (N m²) of the beam; an effect that is None or 0 is left out.
    supports
        How "left" and "right" are held, by a key of :data:`.HELD`; free ends need no mention.
        A roller holds the displacement along y.
    ground
        Stiffness of the foundation under each node, N/m; see :func:`winkler`.

    Raises
    ------
    CaseError
        Where the spacing leaves fewer than two links.
    """
    count = links_of(length, spacing)
    epsilon = length / count
    nodes = np.column_stack([np.linspace(0.0, length, count + 1), np.zeros(count + 1)])
    number = np.arange(count)
    places = {"left": (0, 0), "right": (count, count - 1)}
    ends: dict[str, End] = {}
    walls: list[tuple[int, int]] = []
    for name, (node, link) in places.items():
        support = (supports or {}).get(name, "free")
        if components := HELD[support]:
            if support == "clamped":
                walls.append((link, len(ends)))
            ends[name] = End(np.array([node]), (float(nodes[node, 0]), 0.0), components)
    turns = held = None
    if bending:
        joints = np.column_stack([number[:-1], number[1:]])
        turns = Turns(joints, np.full(len(joints), bending / epsilon))
        if walls:
            links, holders = np.array(walls).T
            held = Walls(links, np.full(len(links), 2.0 * bending / epsilon), holders)
    return Net(
        nodes=nodes,
        links=np.column_stack([number, number + 1]),
        family=np.zeros(count, dtype=np.int64),
        ends=ends,
        stiffness=np.full(count, stretch / epsilon) if stretch else None,
        turns=turns,
        walls=held,
        ground=ground,
    )


def winkler(length: float, spacing: float, pieces: Sequence[tuple[float, float]]) -> Array:
    """A foundation, constant in pieces, as a stiffness under each node of a chain, N/m.

    Each node takes what lies within half a link of it.

    Parameters
    ----------
    length, spacing
        As of :func:`chain`.
    pieces
        Where each piece ends, m, in increasing order, and its K_w, N/m².
    """
    stops, values = np.array(pieces, dtype=float).T
    bounds = np.concatenate([[0.0], stops])
    total = np.concatenate([[0.0], np.cumsum(np.diff(bounds) * values)])
    count = links_of(length, spacing)
    middles = length * (np.arange(count) + 0.5) / count
    return np.diff(np.interp(np.concatenate([[0.0], middles, [length]]), bounds, total))


def links_of(length: float, spacing: float) -> int:
    """Number of links of a chain: the integer next to length/spacing.

    Raises
    ------
    CaseError
        Where there are fewer than two.
    """
    count = round(length / spacing)
    if count < 2:
        raise CaseError(
            f"A spacing of {spacing:g} m is too large for a chain of {length:g} m: "
            f"it must be at most {length / 1.5:.4g} m, for two links."
        )
    return count
