"""Instruments: each makes numbers of the current positions of its material points.

Positions are arrays of shape (points, 2), m, in the order of the `places` of the case's
measurement. Gradients have the shape (columns, points, 2).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..case.measurements import Elongation, Marker, Measurement, ShearAngle, Width

Array = NDArray[np.float64]


class Instrument(Protocol):
    """What a measurement reads."""

    def values(self, x: Array) -> Array:
        """The reading of each column, for points at x."""

    def gradient(self, x: Array) -> Array:
        """Its derivative with respect to the positions."""


class Position:
    """A point's place, m."""

    def values(self, x: Array) -> Array:
        """The coordinates x and y."""
        return x[0]

    def gradient(self, x: Array) -> Array:
        """Unit vectors."""
        return np.eye(2)[:, None, :]


class Opening:
    """Angle from the line of the first two points to that of the last two, in (-π, π], rad."""

    def values(self, x: Array) -> Array:
        """The angle."""
        a, b = x[1] - x[0], x[3] - x[2]
        return np.array([np.arctan2(a[0] * b[1] - a[1] * b[0], a @ b)])

    def gradient(self, x: Array) -> Array:
        """Each line turns by what its ends move across it, over its length."""
        a, b = _turn(x[1] - x[0]), _turn(x[3] - x[2])
        return np.array([[a, -a, -b, b]])


class Shear(Opening):
    """By how much that angle is less than π/2, as a smooth function of the positions, rad."""

    def values(self, x: Array) -> Array:
        """The shear angle."""
        a, b = x[1] - x[0], x[3] - x[2]
        return np.array([np.arctan2(a @ b, a[0] * b[1] - a[1] * b[0])])

    def gradient(self, x: Array) -> Array:
        """That of the angle, with the other sign."""
        return -super().gradient(x)


@dataclass(frozen=True)
class Stretching:
    """Relative elongation of the chord between two points; `length` is the reference's, m."""

    length: float

    def values(self, x: Array) -> Array:
        """The elongation."""
        return np.array([np.linalg.norm(x[1] - x[0]) / self.length - 1.0])

    def gradient(self, x: Array) -> Array:
        """Along the chord."""
        chord = x[1] - x[0]
        along = chord / (np.linalg.norm(chord) * self.length)
        return np.array([[-along, along]])


class Span:
    """Horizontal distance from the first point to the second, m."""

    def values(self, x: Array) -> Array:
        """The distance."""
        return x[1, :1] - x[0, :1]

    def gradient(self, x: Array) -> Array:
        """Along x."""
        return np.array([[[-1.0, 0.0], [1.0, 0.0]]])


def instrument(measurement: Measurement, X: Array) -> Instrument:
    """What a case's measurement reads, with its points at X in the reference."""
    if isinstance(measurement, Marker):
        return Position()
    if isinstance(measurement, ShearAngle):
        return Shear()
    if isinstance(measurement, Elongation):
        return Stretching(float(np.linalg.norm(X[1] - X[0])))
    return Span() if isinstance(measurement, Width) else Opening()


def _turn(line: Array) -> Array:
    """Rate of a line's direction angle as its last point moves."""
    return np.array([-line[1], line[0]]) / (line @ line)
