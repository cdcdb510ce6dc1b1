"""Beams that are folded: states that look like equilibria and are none of the path."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .. import dolfinx_api as api
from ..schemes import Discretisation
from .domain import Axis

#: Turn from one point of an element to the next, or across a joint, that no element resolves, rad.
_SHARPEST = np.pi / 2


class FoldCheck:
    """Finds where the axis turns back on itself within an element or where two meet.

    Energy (16) lets a beam that is squeezed to zero stretch come back in the other direction
    without bending. A long step of Newton's method can end there; a path does not lead there.
    """

    def __init__(self, discretisation: Discretisation, axis: Axis) -> None:
        """Compile the direction of the axis at the ends and middles of elements; collective."""
        domain = axis.mesh
        (a,) = discretisation.fibres
        nodes = api.functionspace(domain, api.lagrange(2, (), domain))
        self._points = api.interpolation_points(nodes)
        self._expression = api.expression(a, self._points)
        self._domain = domain
        owned = domain.topology.index_map(1).size_local
        self._cells = np.arange(owned, dtype=np.int32)
        ends = domain.geometry.x[api.cell_vertices(domain)[:owned], 0]
        self._abscissae = ends[:, :1] + (ends[:, 1:] - ends[:, :1]) * self._points[:, 0]

    def __call__(self) -> str:
        """Where the present state is folded, as a reason; empty if it is not. Collective."""
        values = api.evaluate(self._expression, self._domain, self._cells)
        a = values.reshape(-1, 2)
        S, x, y = self._gathered(np.column_stack([self._abscissae.reshape(-1), a]))
        turns = np.diff(np.unwrap(np.arctan2(y, x)))
        sharpest = int(np.abs(turns).argmax())
        if abs(turns[sharpest]) <= _SHARPEST:
            return ""
        return (
            f"the beam would turn by {np.degrees(abs(turns[sharpest])):.0f} degrees at once at "
            f"S = {S[sharpest]:.4g} m: it is folded there, or its elements are too long"
        )

    def _gathered(self, rows: NDArray[np.float64]) -> NDArray[np.float64]:
        """Columns of all processes' rows, from left to right; of equal abscissae, element wise."""
        own = rows.reshape(len(self._cells), len(self._points), 3)
        elements = np.concatenate(self._domain.comm.allgather(own))
        # The nodes of an element from left to right, and the elements by their middles.
        order = np.argsort(elements[:, :, 0], axis=1)
        elements = np.take_along_axis(elements, order[:, :, None], axis=1)
        return elements[np.argsort(elements[:, 1, 0])].reshape(-1, 3).T
