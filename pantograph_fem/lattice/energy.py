"""Energy of a net with exact first and second derivatives.

Every spring but the ground's depends on the length of a link or on the directions of one or two
links. So the gradient is a force per link, and the second derivatives are blocks of shape (2, 2)
per link and per pair of links.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from .couples import RotationalSprings
from .links import LinkState, link_state
from .net import Net
from .springs import Response, extension, ground

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Blocks(NamedTuple):
    """Second derivatives of the energy, N/m.

    Attributes
    ----------
    links
        Block S of each link, shape (m, 2, 2): it enters as S at (p, p) and (q, q) and as -S at
        (p, q) and (q, p), with p and q the nodes of the link.
    pairs
        Block C of each pair of links, shape (k, 2, 2): it enters at (node of the first link,
        node of the second link) with the product of the signs of the nodes, - for a first node
        and + for a second one, and transposed at the transposed places.
    nodes
        Block of each node, shape (n, 2, 2), or (0, 2, 2) without a foundation.
    """

    links: Array
    pairs: Array
    nodes: Array


class NetEnergy:
    """Energies (1) and (19) of a net.

    Displacements u have the shape (n, 2), m. `rotations` has the angle of each end of the net,
    in the order of :attr:`Net.ends`, rad: it turns the walls. `loads` are couples (m,) that act
    on links from outside, N m: their potential -load·φ counts too.
    """

    def __init__(self, net: Net) -> None:
        self.net = net
        self.rotational = RotationalSprings(net)
        self._rest = link_state(net.nodes, net.links).length
        links = np.arange(len(net.links))
        signs, nodes = np.repeat([-1.0, 1.0], len(links)), net.links.T.ravel()
        self._gather = sp.csr_matrix(
            (signs, (nodes, np.tile(links, 2))), shape=(net.size, len(links))
        )

    @property
    def pairs(self) -> IntArray:
        """Pairs of links with a spring between them, shape (k, 2)."""
        return self.rotational.pairs

    def state(self, u: Array) -> LinkState:
        """The links where the nodes are displaced by u."""
        return link_state(self.net.nodes + u, self.net.links)

    def energies(self, u: Array, rotations: Array) -> dict[str, float]:
        """Stored energy of each effect there is, J; walls count as bending."""
        return {name: float(e.sum()) for name, e in self.nodal_energies(u, rotations).items()}

    def nodal_energies(self, u: Array, rotations: Array) -> dict[str, Array]:
        """Stored energy of each effect there is at each node, shape (n,), J.

        A link's energy is halved between its nodes, a rotational spring's is that of the node
        where its links meet, a wall's that of the held node.
        """
        net, state, rotational = self.net, self.state(u), self.rotational
        found: dict[str, Array] = {}

        def add(effect: str, response: Response | None, nodes: IntArray, share: float) -> None:
            if response is not None:
                found.setdefault(effect, np.zeros(net.size))
                found[effect] += np.bincount(nodes, share * response.energy, net.size)

        if net.stiffness is not None:
            stretched = extension(state.length, self._rest, net.stiffness)
            for nodes in net.links.T:
                add("stretch", stretched, nodes, 0.5)
        if net.turns is not None:
            joints = net.links[net.turns.links[:, 0], 1]
            add("bending", rotational.turns(state), joints, 1.0)
        if net.walls is not None:
            holders = net.held.any(axis=1)[net.links[net.walls.links]].argmax(axis=1)
            held = net.links[net.walls.links, holders]
            add("bending", rotational.walls(state, rotations), held, 1.0)
        if net.pivots is not None:
            meeting = _common_nodes(net.links[net.pivots.links])
            add("shear", rotational.pivots(state), meeting, 1.0)
        if net.ground is not None:
            add("foundation", ground(u, net.ground), np.arange(net.size), 1.0)
        return found

    def gradient(self, u: Array, rotations: Array, loads: Array | None = None) -> Array:
        """Derivative of the energy with respect to u, shape (n, 2), N."""
        state = self.state(u)
        moment = self.rotational.couples(state, rotations).moment
        if loads is not None:
            moment = moment - loads
        forces = (moment / state.length)[:, None] * state.normal
        if self.net.stiffness is not None:
            axial = extension(state.length, self._rest, self.net.stiffness)
            forces += axial.first[:, None] * state.tangent
        gradient = self._gather @ forces
        if self.net.ground is not None:
            gradient += ground(u, self.net.ground).first
        return gradient

    def couple_forces(self, u: Array, couples: Array) -> Array:
        """Forces on nodes (n, 2) that do the work of couples (m,) on links, N."""
        state = self.state(u)
        return self._gather @ ((couples / state.length)[:, None] * state.normal)

    def wall_couples(self, u: Array, rotations: Array) -> tuple[Array, Array]:
        """First and second derivatives of the energy with respect to the angles of held links.

        Shape (w,) each, N m. A wall acts on its link with the opposite of the first one.
        """
        response = self.rotational.walls(self.state(u), rotations)
        if response is None:
            return np.empty(0), np.empty(0)
        return response.first, response.second

    def blocks(self, u: Array, rotations: Array, loads: Array | None = None) -> Blocks:
        """Second derivatives with respect to u."""
        state = self.state(u)
        couples = self.rotational.couples(state, rotations)
        moment = couples.moment if loads is None else couples.moment - loads
        t, turning = state.tangent, state.normal / state.length[:, None]  # dl and dφ by dx
        mixed = _outer(t, turning)
        squares = couples.stiffness
        links = -_times(moment / state.length, mixed + mixed.transpose(0, 2, 1))
        if self.net.stiffness is not None:
            axial = extension(state.length, self._rest, self.net.stiffness)
            squares = squares + axial.first * state.length
            links += _times(axial.second, _outer(t, t))
        links += _times(squares, _outer(turning, turning))
        first, second = self.pairs.T
        pairs = -_times(couples.pairs, _outer(turning[first], turning[second]))
        k = np.empty(0) if self.net.ground is None else ground(u, self.net.ground).second
        return Blocks(links, pairs, _times(k, np.broadcast_to(np.eye(2), (len(k), 2, 2))))


def _common_nodes(pairs: IntArray) -> IntArray:
    """The node that two links share, from their nodes (p, 2 links, 2 ends)."""
    first, second = pairs[:, 0], pairs[:, 1]
    shared = (first[:, :, None] == second[:, None, :]).any(axis=2)
    return first[np.arange(len(first)), shared.argmax(axis=1)]


def _outer(a: Array, b: Array) -> Array:
    return a[:, :, None] * b[:, None, :]


def _times(factors: Array, blocks: Array) -> Array:
    return factors[:, None, None] * blocks
