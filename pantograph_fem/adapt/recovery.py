"""Fields that jump between elements, and the continuous ones nearest to them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import ufl
from numpy.typing import NDArray

from dolfinx import fem, mesh

from .. import dolfinx_api as api
from ..continuum.weights import cell_sizes
from ..physics.kinematics import Expr

Array = NDArray[np.float64]


class Recovery:
    """Values of some expressions at the nodes of quadratic cells, and their means at each node.

    What an element says at a node, less the mean over the elements around, tells how far the
    field is from continuous (Zienkiewicz and Zhu, 1987). Each element weighs as its area.

    Attributes
    ----------
    mean
        Function of as many components as expressions, with the means last computed.
    areas
        Area of each owned cell, m².
    """

    def __init__(self, domain: mesh.Mesh, expressions: Sequence[Expr]) -> None:
        """Compile the expressions, which must be scalars; a collective call."""
        self._domain = domain
        self._components = len(expressions)
        space = api.functionspace(domain, api.lagrange(2, (len(expressions),), domain))
        self.mean = fem.Function(space)
        self._expression = api.expression(
            ufl.as_vector(list(expressions)), api.interpolation_points(space)
        )
        self.areas = cell_sizes(domain)
        self._cells = np.arange(len(self.areas), dtype=np.int32)
        self._dofs = api.cell_dofs(space)[self._cells]
        self._weights = self._sums(np.ones((*self._dofs.shape, len(expressions))))

    def evaluate(self) -> tuple[Array, Array]:
        """Own values and means at the nodes of each owned cell, shape (cells, 6, components).

        The means go into :attr:`mean` as well, ghosts included. A collective call.
        """
        raw = api.evaluate(self._expression, self._domain, self._cells)
        own = raw.reshape(*self._dofs.shape, self._components)
        means = self._sums(own) / self._weights
        self.mean.x.array[:] = means.ravel()
        return own, means[self._dofs]

    def _sums(self, values: Array) -> Array:
        """Sums over the cells around every local node, weighted by area, ghosts included."""
        vector = self.mean.x
        sums = vector.array.reshape(-1, values.shape[2])
        sums[:] = 0.0
        np.add.at(sums, self._dofs, values * self.areas[:, None, None])
        api.scatter_reverse_add(vector)
        vector.scatter_forward()
        return sums.copy()
