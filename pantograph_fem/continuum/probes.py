"""Displacement of single material points."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dolfinx import fem, mesh

from .. import dolfinx_api as api
from ..errors import CaseError
from ..schemes import Discretisation

Array = NDArray[np.float64]


class Probes:
    """Material points whose cells are found once.

    Raises
    ------
    CaseError
        If a point lies outside the sheet.
    """

    def __init__(
        self,
        discretisation: Discretisation,
        domain: mesh.Mesh,
        points: Sequence[tuple[float, float]] | Array,
        keys: Sequence[str] | None = None,
    ) -> None:
        """Find the points; a collective call.

        `keys` are those of the case file that ask for each point, for what is said of one that is
        outside: by default ``output.probes[i]``.
        """
        field = discretisation.field("displacement")
        assert field is not None  # every scheme has one
        self._field = field
        self._state = discretisation.state
        self._points = np.array(points, dtype=float).reshape(-1, 2)
        self._comm = domain.comm
        cells = api.containing_cells(domain, self._points)
        # The lowest rank that holds a point reports it.
        self._owner = self._comm.allgather(cells >= 0)
        missing = ~np.any(self._owner, axis=0)
        if missing.any():
            i = int(np.flatnonzero(missing)[0])
            key, what = (f"output.probes[{i}]", "a probe") if keys is None else (keys[i], "it")
            raise CaseError(
                f"{key}: {self._points[i].tolist()} is outside the sheet; "
                f"{what} is a reference point of the sheet, in m"
            )
        self._cells = cells
        self._displacement = fem.Function(field.space)

    def displacements(self) -> Array:
        """Displacements in the present state on every rank, shape (points, 2), m; collective."""
        if not len(self._points):
            return self._points
        self._displacement.x.array[:] = self._state.x.array[self._field.dofs.ravel()]
        mine = self._cells >= 0
        values = np.zeros_like(self._points)
        if mine.any():
            padded = np.zeros((int(mine.sum()), 3))
            padded[:, :2] = self._points[mine]
            values[mine] = self._displacement.eval(padded, self._cells[mine]).reshape(-1, 2)
        everywhere = np.array(self._comm.allgather(values))
        return everywhere[np.argmax(self._owner, axis=0), np.arange(len(self._points))]
