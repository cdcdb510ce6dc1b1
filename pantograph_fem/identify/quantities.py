"""What kind of thing each measured column is, and in which units a figure shows it."""

from __future__ import annotations

from dataclasses import dataclass

from ..case import SheetCase
from .responses import FORCES


@dataclass(frozen=True)
class Quantity:
    """A kind of column.

    Attributes
    ----------
    name
        What it is.
    unit
        SI unit; empty for pure numbers.
    factor, shown
        Factor on SI values in figures, and the unit there.
    """

    name: str
    unit: str
    factor: float = 1.0
    shown: str = ""

    @property
    def label(self) -> str:
        """Name and unit, for an axis."""
        return f"{self.name} ({self.shown or self.unit})"


FORCE = Quantity("force", "N")
ANGLE = Quantity("angle", "rad")
ELONGATION = Quantity("elongation", "", 100.0, "%")
WIDTH = Quantity("width", "m", 1e3, "mm")
POSITION = Quantity("position", "m", 1e3, "mm")

_KINDS = {
    "marker": POSITION,
    "angle": ANGLE,
    "shear_angle": ANGLE,
    "elongation": ELONGATION,
    "width": WIDTH,
}


def quantities_of(case: SheetCase) -> dict[str, Quantity]:
    """The kind of each column that data can be compared with."""
    found = dict.fromkeys(FORCES, FORCE)
    for name, measurement in case.measurements.items():
        found |= dict.fromkeys(measurement.columns(name), _KINDS[measurement.kind])
    return found
