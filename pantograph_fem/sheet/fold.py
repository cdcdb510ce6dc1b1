"""Sheets that are folded: states that look like equilibria and are none of a sheet."""

from __future__ import annotations

import numpy as np
import ufl
from numpy.typing import NDArray

from dolfinx import mesh

from .. import dolfinx_api as api
from ..schemes import Discretisation

Array = NDArray[np.float64]

#: A fibre shorter than this share of its length has collapsed.
_SHORTEST = 0.05


class FoldCheck:
    r"""Finds cells whose fibres have collapsed, or crossed each other.

    Energy (31) lets a fibre shrink to a point, at the price of ½ K_e, and come back the other way
    round; and the pivots of (31) let the families pass through each other, at the price of
    :math:`\tfrac12 K_p (\pi/2)^\gamma`. A long step of Newton's method can end there. As

    .. math:: \det\mathbf F = \mathbf a_1\times\mathbf a_2 = \rho_1\rho_2\cos\psi,

    a positive determinant is the same as a shear angle below π/2.

    The turn of a fibre from one cell to the next needs no check of its own. Along the edge between
    them both have the same derivative of the placement; with positive determinants they place what
    is beside the edge on the same side of it, so that the fibre turns by less than π.
    """

    def __init__(self, discretisation: Discretisation, domain: mesh.Mesh) -> None:
        """Compile the fibres at the points where the energy is integrated; a collective call."""
        self._domain = domain
        self._points = api.quadrature_points(domain, discretisation.quadrature_degree)
        a, b = discretisation.fibres
        self._expression = api.expression(ufl.as_vector([*a, *b]), self._points)
        owned = domain.topology.index_map(2).size_local
        self._cells = np.arange(owned, dtype=np.int32)

    def __call__(self) -> str:
        """Where the present state is folded, as a reason; empty if it is not. Collective."""
        values = api.evaluate(self._expression, self._domain, self._cells).reshape(-1, 4)
        a, b = values[:, :2], values[:, 2:]
        shortest = np.sqrt(np.minimum((a**2).sum(axis=1), (b**2).sum(axis=1)))
        det = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        det_worst, det_at = self._worst(det)
        if not det_worst > 0.0:
            return (
                f"the two families of fibres would cross at {_text(det_at)} m, "
                f"where det F = {det_worst:.3g}: the sheet is folded there"
            )
        stretch_worst, stretch_at = self._worst(shortest)
        if not stretch_worst > _SHORTEST:
            return (
                f"a fibre would be shortened to {stretch_worst:.3g} of its length at "
                f"{_text(stretch_at)} m: it has collapsed there"
            )
        return ""

    def _worst(self, values: Array) -> tuple[float, Array]:
        """The least value of all processes, and its reference position."""
        least, place = np.inf, np.zeros(2)
        if len(values):
            row = int(np.argmin(values))  # of a NaN, if there is one
            least, place = float(values[row]), self._position(row)
        return min(self._domain.comm.allgather((least, place)), key=lambda one: one[0])

    def _position(self, row: int) -> Array:
        cell, point = divmod(row, len(self._points))
        corners = self._domain.geometry.x[api.cell_vertices(self._domain)[cell], :2]
        share = self._points[point]
        return corners[0] + share @ (corners[1:] - corners[0])


def _text(place: Array) -> str:
    return f"({place[0]:.4g}, {place[1]:.4g})"
