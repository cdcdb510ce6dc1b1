"""Spacings of square lattices that fit a rectangle."""

from __future__ import annotations

import math

#: Angles (degrees) and lengths (relative) that differ by less are the same.
_ANGLE, _LENGTH = 1e-9, 1e-6


def period(fibre_angle: float, spacing: float) -> float | None:
    """Distance along the sides after which a square lattice repeats itself, m.

    That is the spacing where fibres run along the sides, √2 of it where they run at 45° to them,
    and None at other angles (degrees).
    """
    turns = fibre_angle / 45.0
    if abs(turns - round(turns)) * 45.0 > _ANGLE:
        return None
    return spacing * (math.sqrt(2.0) if round(turns) % 2 else 1.0)


def fits(width: float, height: float, fibre_angle: float, spacing: float) -> bool:
    """Whether both sides are whole numbers of periods, so that nodes lie on all of them."""
    length = period(fibre_angle, spacing)
    return length is not None and all(
        round(side / length) >= 1 and abs(side / (round(side / length) * length) - 1.0) <= _LENGTH
        for side in (width, height)
    )


def fitted_spacing(width: float, height: float, fibre_angle: float, spacing: float) -> float:
    """The spacing nearest to the given one with which the lattice fits, or the given one.

    Parameters
    ----------
    width, height
        Sides of the rectangle, m.
    fibre_angle
        From x to the first family, degrees.
    spacing
        Wanted, m. It is returned as it is where it fits, where no lattice with the same number of
        periods along the width fits the height as well, or where the fibres run at other angles
        to the sides than multiples of 45 degrees.
    """
    length = period(fibre_angle, spacing)
    if length is None or fits(width, height, fibre_angle, spacing):
        return spacing
    count = round(width / length)
    if count < 1:
        return spacing
    fitted = spacing * width / (count * length)
    return fitted if fits(width, height, fibre_angle, fitted) else spacing
