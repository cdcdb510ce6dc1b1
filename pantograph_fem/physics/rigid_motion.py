"""Rigid motion of a grip as a function of the load factor."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: A quarter turn anticlockwise.
QUARTER_TURN: Array = np.array([[0.0, -1.0], [1.0, 0.0]])


@dataclass(frozen=True)
class RigidMotion:
    r"""At load factor t: rotation by t·angle about a pivot, then translation by t·translation.

    .. math:: \chi(X) = P + t\,d + R(t\theta)(X - P)

    Attributes
    ----------
    translation
        d, m.
    angle
        θ, rad, anticlockwise.
    pivot
        P, reference position, m.
    """

    translation: tuple[float, float] = (0.0, 0.0)
    angle: float = 0.0
    pivot: tuple[float, float] = (0.0, 0.0)

    @classmethod
    def from_degrees(
        cls, translation: tuple[float, float], rotation: float, pivot: tuple[float, float]
    ) -> RigidMotion:
        """The motion of a case file, whose rotation is in degrees."""
        return cls(translation, math.radians(rotation), pivot)

    def rotation(self, load: float) -> Array:
        """R at the load factor, shape (2, 2)."""
        c, s = np.cos(load * self.angle), np.sin(load * self.angle)
        return np.array([[c, -s], [s, c]])

    def rotation_rate(self, load: float) -> Array:
        """dR/dt, shape (2, 2)."""
        return self.angle * QUARTER_TURN @ self.rotation(load)

    def displacement(self, X: Array, load: float) -> Array:
        """Displacement of reference points X of shape (n, 2), m."""
        arm = X - np.asarray(self.pivot)
        return load * np.asarray(self.translation) + arm @ (self.rotation(load) - np.eye(2)).T

    def displacement_rate(self, X: Array, load: float) -> Array:
        """Derivative of the displacement with respect to the load factor, shape (n, 2), m."""
        arm = X - np.asarray(self.pivot)
        return np.asarray(self.translation) + arm @ self.rotation_rate(load).T
