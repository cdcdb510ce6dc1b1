r"""Constants as the coordinates in which they are looked for.

A constant c in (o, ∞) has the coordinate

.. math:: q = \ln\frac{c - o}{c_0 - o} \quad\text{("log")}, \qquad
    q = \frac{c - c_0}{c_0 - o} \quad\text{("linear")},

with its start c₀ at q = 0. The origin o is 0 for stiffnesses and 1 for γ, below which an energy
(31) makes no sense.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Symbol and unit by the name in ``[material]``.
SYMBOLS = {
    "stretch": ("K_e", "N/m"),
    "bending": ("K_b", "N m"),
    "shear": ("K_p", "N/m"),
    "shear_exponent": ("γ", ""),
}


@dataclass(frozen=True)
class Parameter:
    """One constant that is looked for.

    Attributes
    ----------
    name
        Key of ``[material]``.
    start, lower, upper
        Where the search starts, and bounds; SI units.
    logarithmic
        Whether the coordinate is a logarithm.
    """

    name: str
    start: float
    lower: float
    upper: float
    logarithmic: bool = True

    @property
    def origin(self) -> float:
        """Infimum of what is possible."""
        return 1.0 if self.name == "shear_exponent" else 0.0

    @property
    def symbol(self) -> str:
        """Its symbol."""
        return SYMBOLS[self.name][0]

    @property
    def unit(self) -> str:
        """Its SI unit; empty for γ."""
        return SYMBOLS[self.name][1]

    def coordinate(self, value: float) -> float:
        """Coordinate of a value."""
        ratio = (value - self.origin) / (self.start - self.origin)
        return math.log(ratio) if self.logarithmic else ratio - 1.0

    def value(self, q: float) -> float:
        """The value at a coordinate; infinite beyond the largest float."""
        size = self.start - self.origin
        if self.logarithmic:
            return self.origin + size * (math.exp(q) if q < 700.0 else math.inf)
        return self.origin + size * (1.0 + q)

    def slope(self, q: float) -> float:
        """Derivative of the value with respect to the coordinate."""
        size = self.start - self.origin
        return self.value(q) - self.origin if self.logarithmic else size

    def text(self, value: float) -> str:
        """A value with its unit."""
        return f"{value:.4g} {self.unit}".rstrip()


def values_of(parameters: Sequence[Parameter], q: Array) -> dict[str, float]:
    """Constants by name at a point of the coordinates, shape (constants,)."""
    return {p.name: p.value(float(qi)) for p, qi in zip(parameters, q, strict=True)}


def slopes_of(parameters: Sequence[Parameter], q: Array) -> Array:
    """Derivative of each constant with respect to its coordinate, shape (constants,)."""
    return np.array([p.slope(float(qi)) for p, qi in zip(parameters, q, strict=True)])


def bounds_of(parameters: Sequence[Parameter]) -> tuple[Array, Array]:
    """Coordinates of the lower and of the upper bounds, each of shape (constants,)."""
    lower = np.array([p.coordinate(p.lower) for p in parameters])
    return lower, np.array([p.coordinate(p.upper) for p in parameters])
