"""Kinematics of links: lengths, directions, and the angles between directions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..physics.rigid_motion import QUARTER_TURN

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class LinkState:
    r"""Links in some configuration.

    With the unit tangent t and the normal n, a quarter turn anticlockwise from it, the length l
    and the direction angle φ of a link from node p to node q have the derivatives

    .. math:: \partial_q l = t = -\partial_p l, \qquad \partial_q\varphi = n/l
        = -\partial_p\varphi

    and, with the pattern (+, -; -, +) over the two nodes, the second derivatives
    :math:`n\otimes n/l` and :math:`-(t\otimes n + n\otimes t)/l^2`.

    Attributes
    ----------
    length
        Shape (m,), m.
    tangent
        Shape (m, 2).
    """

    length: Array
    tangent: Array

    @property
    def normal(self) -> Array:
        """A quarter turn anticlockwise from the tangent, shape (m, 2)."""
        return self.tangent @ QUARTER_TURN.T


def link_state(places: Array, links: IntArray) -> LinkState:
    """Links (m, 2) between nodes at the places (n, 2), m."""
    span = places[links[:, 1]] - places[links[:, 0]]
    length = np.hypot(span[:, 0], span[:, 1])
    return LinkState(length, span / length[:, None])


def angle_between(first: Array, second: Array) -> Array:
    """Angle from the first vectors to the second ones, shape (k, 2) each; rad in (-π, π]."""
    cross = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    return np.arctan2(cross, (first * second).sum(axis=1))
