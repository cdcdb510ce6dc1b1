"""A net of nodes and springs in the reference configuration, as plain arrays."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Turns:
    """Rotational springs that keep two links of a fibre in a row; straight at rest.

    Attributes
    ----------
    links
        Numbers of the two links, in the order along the fibre, shape (k, 2).
    stiffness
        b of (1) and (19), shape (k,), N m.
    """

    links: IntArray
    stiffness: Array


@dataclass(frozen=True, eq=False)
class Walls:
    """Rotational springs that hold links in their reference direction, turned with an end.

    Attributes
    ----------
    links
        Numbers of the links, shape (w,).
    stiffness
        b, shape (w,), N m.
    ends
        Which end holds each, as a place in the order of :attr:`Net.ends`, shape (w,).
    """

    links: IntArray
    stiffness: Array
    ends: IntArray


@dataclass(frozen=True, eq=False)
class Pivots:
    """Rotational springs between links of different fibres, at right angles at rest.

    Attributes
    ----------
    links
        A link of the first family and one of the second, shape (p, 2).
    stiffness
        b₃ of (19), shape (p,), N m.
    exponent, regularisation
        γ, and δ (rad), which γ = 2 does not need.
    """

    links: IntArray
    stiffness: Array
    exponent: float = 2.0
    regularisation: float = 0.0


@dataclass(frozen=True, eq=False)
class End:
    """Nodes that move as one rigid body: a grip of a lattice or an end of a chain.

    Attributes
    ----------
    nodes
        Numbers of the held nodes.
    centre
        Reference point, m; moments are taken about its current place.
    components
        The components of the displacement that are held: (0, 1), or one of them for a roller.
    """

    nodes: IntArray
    centre: tuple[float, float]
    components: tuple[int, ...] = (0, 1)

    @property
    def entries(self) -> tuple[IntArray, IntArray]:
        """Index of what it holds in nodal arrays of shape (n, 2)."""
        return self.nodes[:, None], np.array([self.components])


@dataclass(frozen=True, eq=False)
class Net:
    """The reference configuration and the springs; an effect that is absent has no arrays.

    Attributes
    ----------
    nodes
        Places, shape (n, 2), m.
    links
        First and second node of each, along +D of its family, shape (m, 2).
    family
        Fibre family of each link, 0 or 1, shape (m,).
    ends
        What is held, by name.
    stiffness
        k of (1) and (19), shape (m,), N/m; 0 for links of a family that does not resist.
    turns, walls, pivots
        Rotational springs.
    ground
        Stiffness of the foundation under each node, shape (n,), N/m.
    """

    nodes: Array
    links: IntArray
    family: IntArray
    ends: dict[str, End] = field(default_factory=dict)
    stiffness: Array | None = None
    turns: Turns | None = None
    walls: Walls | None = None
    pivots: Pivots | None = None
    ground: Array | None = None

    @property
    def size(self) -> int:
        """Number of nodes."""
        return len(self.nodes)

    @property
    def extent(self) -> float:
        """Diagonal of the bounding box, m."""
        return float(np.hypot(*np.ptp(self.nodes, axis=0)))

    @property
    def held(self) -> NDArray[np.bool_]:
        """Whether each component of the displacement of each node is held, shape (n, 2)."""
        held = np.zeros((self.size, 2), dtype=bool)
        for end in self.ends.values():
            held[end.entries] = True
        return held

    def around(self, nodes: IntArray) -> Net:
        """The same net without the rotational springs that exert nothing on these nodes.

        The gradient and the second derivatives of the energy in the rows of these nodes are
        those of the whole net.
        """
        own = np.zeros(self.size, dtype=bool)
        own[nodes] = True
        touching = own[self.links].any(axis=1)
        turns, walls, pivots = self.turns, self.walls, self.pivots
        if turns is not None:
            keep = touching[turns.links].any(axis=1)
            turns = Turns(turns.links[keep], turns.stiffness[keep])
        if walls is not None:
            keep = touching[walls.links]
            walls = Walls(walls.links[keep], walls.stiffness[keep], walls.ends[keep])
        if pivots is not None:
            keep = touching[pivots.links].any(axis=1)
            pivots = replace(pivots, links=pivots.links[keep], stiffness=pivots.stiffness[keep])
        return replace(self, turns=turns, walls=walls, pivots=pivots)
