"""Section ``[sheet]``: the reference rectangle and its fibres."""

from __future__ import annotations

from pydantic import Field

from .part import Part


class Sheet(Part):
    """Reference rectangle [0, width] x [0, height] and direction of its fibres.

    Attributes
    ----------
    width, height
        Sides along x and y, m.
    fibre_angle
        Angle from x to the first family, degrees anticlockwise; the second is 90 degrees further.
    """

    width: float = Field(gt=0)
    height: float = Field(gt=0)
    fibre_angle: float = 45.0
