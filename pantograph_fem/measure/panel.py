"""All instruments of a case, with their material points in one array."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..case.measurements import Measurement
from ..case.sheet import Sheet
from .instruments import Instrument, instrument

Array = NDArray[np.float64]


class InstrumentPanel:
    """The measurements of a case as functions of the displacements of their points.

    Attributes
    ----------
    columns
        Names of the readings, in the order of the case file.
    points
        Reference positions of all points, shape (points, 2), m.
    keys
        For each point the key of the case file that asks for it.
    """

    def __init__(self, measurements: Mapping[str, Measurement], sheet: Sheet) -> None:
        self.columns: tuple[str, ...] = ()
        self.keys: tuple[str, ...] = ()
        places: list[tuple[float, float]] = []
        self._parts: list[tuple[slice, Instrument]] = []
        for name, measurement in measurements.items():
            mine = measurement.places(sheet)
            X = np.array([place.point for place in mine])
            part = slice(len(places), len(places) + len(mine))
            self._parts.append((part, instrument(measurement, X)))
            self.columns += measurement.columns(name)
            self.keys += tuple(f"measurements.{name}.{place.key}" for place in mine)
            places += [place.point for place in mine]
        self.points: Array = np.array(places, dtype=float).reshape(-1, 2)

    def values(self, u: Array) -> Array:
        """Readings for displacements of shape (points, 2), m; shape (columns,)."""
        x = self.points + u
        return np.concatenate([device.values(x[part]) for part, device in self._parts])

    def rates(self, u: Array, v: Array) -> Array:
        """Derivative of the readings at the displacements u in the direction v."""
        x = self.points + u
        return np.concatenate(
            [np.tensordot(device.gradient(x[part]), v[part], 2) for part, device in self._parts]
        )
