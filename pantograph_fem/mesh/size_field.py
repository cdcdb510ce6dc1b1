"""Element sizes as a field on a triangulation, for gmsh to follow."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import ModuleType

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class SizeField:
    """Sizes at points, linear on the triangles between them.

    Parameters
    ----------
    points
        Coordinates, shape (n, 2).
    triangles
        Indices of the corners, shape (m, 3); they cover what is to be meshed.
    sizes
        Element size asked for at each point, shape (n,), in the unit of the points.
    """

    points: NDArray[np.float64]
    triangles: NDArray[np.int64]
    sizes: NDArray[np.float64]

    def scaled(self, factor: float) -> SizeField:
        """The same field in another unit of length."""
        return SizeField(self.points * factor, self.triangles, self.sizes * factor)

    @contextmanager
    def in_gmsh(self, gmsh: ModuleType) -> Iterator[int]:
        """Yield the tag of a mesh size field of gmsh, which is gone afterwards."""
        view = gmsh.view.add("element sizes")
        try:
            corners = self.points[self.triangles]
            places = np.zeros((len(corners), 3, 3))
            places[:, :, :2] = corners
            # A triangle is x, x, x, y, y, y, z, z, z and its three values.
            rows = np.hstack([places.transpose(0, 2, 1).reshape(-1, 9), self.sizes[self.triangles]])
            gmsh.view.addListData(view, "ST", len(rows), rows.ravel())
            tag = gmsh.model.mesh.field.add("PostView")
            gmsh.model.mesh.field.setNumber(tag, "ViewTag", view)
            yield tag
        finally:
            gmsh.view.remove(view)
