"""Rotational springs of a net: what they store, and the couples with which they act on links."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .links import LinkState, angle_between, link_state
from .net import Net
from .springs import Response, pivot, quadratic_pivot, turn

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Couples:
    """Derivatives of the rotational energy with respect to direction angles of links, N m.

    Attributes
    ----------
    moment
        First derivatives, shape (m,).
    pairs
        Second derivatives with respect to the angle between the links of each pair, shape (k,).
    stiffness
        Second derivatives with respect to the angle of each link, shape (m,).
    """

    moment: Array
    pairs: Array
    stiffness: Array


class RotationalSprings:
    """Turns, walls and pivots of a net; their responses are None where there are none.

    `rotations` has the angle of each end in the order of :attr:`Net.ends`, rad: it turns walls.
    """

    def __init__(self, net: Net) -> None:
        self._net = net
        groups = [group.links for group in (net.turns, net.pivots) if group is not None]
        #: Links between which there is a spring: those of turns, then those of pivots, (k, 2).
        self.pairs: IntArray = np.concatenate([np.empty((0, 2), dtype=np.int64), *groups])
        if net.walls is not None:
            self._held = link_state(net.nodes, net.links[net.walls.links])

    def turns(self, state: LinkState) -> Response | None:
        """Turns: derivatives with respect to the angle from the first link to the second."""
        turns = self._net.turns
        if turns is None:
            return None
        first, second = turns.links.T
        return turn(angle_between(state.tangent[first], state.tangent[second]), turns.stiffness)

    def walls(self, state: LinkState, rotations: Array) -> Response | None:
        """Walls: derivatives with respect to the angle from the wall to its link."""
        walls = self._net.walls
        if walls is None:
            return None
        angle = rotations[walls.ends, None]
        direction = np.cos(angle) * self._held.tangent + np.sin(angle) * self._held.normal
        return turn(angle_between(direction, state.tangent[walls.links]), walls.stiffness)

    def pivots(self, state: LinkState) -> Response | None:
        """Pivots: derivatives with respect to ψ, by which the angle between fibres decreases."""
        pivots = self._net.pivots
        if pivots is None:
            return None
        psi = shear_angles(state, pivots.links)
        if pivots.exponent == 2.0:
            return quadratic_pivot(psi, pivots.stiffness)
        return pivot(psi, pivots.stiffness, pivots.exponent, pivots.regularisation)

    def couples(self, state: LinkState, rotations: Array) -> Couples:
        """All of them together."""
        turns, pivots = self.turns(state), self.pivots(state)
        firsts, seconds = [np.empty(0)], [np.empty(0)]
        if turns is not None:
            firsts.append(turns.first)
            seconds.append(turns.second)
        if pivots is not None:
            firsts.append(-pivots.first)  # ψ decreases with the angle between the links
            seconds.append(pivots.second)
        first, second = np.concatenate(firsts), np.concatenate(seconds)
        size = len(self._net.links)
        a, b = self.pairs.T
        moment = _sums(b, first, size) - _sums(a, first, size)
        stiffness = _sums(b, second, size) + _sums(a, second, size)
        walls = self.walls(state, rotations)
        if walls is not None:
            moment += self.on_links(walls.first)
            stiffness += self.on_links(walls.second)
        return Couples(moment, second, stiffness)

    def on_links(self, walls: Array) -> Array:
        """Sum what belongs to each wall (w,) over the links they hold, shape (m,)."""
        assert self._net.walls is not None
        return _sums(self._net.walls.links, walls, len(self._net.links))


def shear_angles(state: LinkState, pairs: IntArray) -> Array:
    """ψ of pairs (p, 2) of a link of the first family and one of the second, rad."""
    first, second = pairs.T
    # To a quarter turn ahead of the first link it is ψ from the second one.
    return angle_between(state.tangent[second], state.normal[first])


def _sums(places: IntArray, values: Array, size: int) -> Array:
    return np.bincount(places, values, size).astype(np.float64, copy=False)
