"""What the instruments of a case read on a discretised sheet."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dolfinx import mesh

from ..case import SheetCase
from ..continuum.probes import Probes
from ..measure import InstrumentPanel
from ..schemes import Discretisation

Array = NDArray[np.float64]


class SheetMeasurements:
    """The measurements of a case; where their points are in the mesh is found once.

    Attributes
    ----------
    columns
        Names of the readings: columns of ``history.csv``.

    Raises
    ------
    CaseError
        If a point lies outside the sheet; the message names the key.
    """

    def __init__(self, case: SheetCase, discretisation: Discretisation, domain: mesh.Mesh) -> None:
        self._panel = InstrumentPanel(case.measurements, case.sheet)
        self._probes = Probes(discretisation, domain, self._panel.points, self._panel.keys)
        self.columns = self._panel.columns

    def values(self) -> Array:
        """Readings in the present state on every rank, shape (columns,); a collective call."""
        return self._panel.values(self._probes.displacements())

    def read(self) -> dict[str, float]:
        """The same by column; a collective call."""
        return dict(zip(self.columns, self.values().tolist(), strict=True))

    def displacements(self) -> Array:
        """Those of the points in the present state, shape (points, 2), m; a collective call."""
        return self._probes.displacements()

    def rates(self, u: Array, v: Array) -> Array:
        """Derivative of the readings at displacements u in the direction v of the points."""
        return self._panel.rates(u, v)
