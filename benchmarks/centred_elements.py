"""Elements of scikit-fem with powers of the distance from the middle of each cell.

Those of scikit-fem are powers of the coordinates themselves. Of a cell much smaller than its
distance from the origin, such as one at the corner of a graded mesh, they cannot be told apart in
double precision, and the matrix that makes shape functions of them is singular.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from skfem import ElementQuadBFS, ElementTriArgyris, Mesh


class _Centred:
    """Shifts the origin of each cell to its middle."""

    def gbasis(self, mapping: Any, X: Any, i: int, tind: Any = None) -> Any:
        """Shape function i at the points X of the cells `tind`."""
        mesh: Mesh = mapping.mesh
        middle = mesh.p[:, mesh.t].mean(axis=1)

        def place(X: Any, tind: Any = None) -> Any:
            return (
                mapping.F(X, tind=tind) - (middle if tind is None else middle[:, tind])[..., None]
            )

        return super().gbasis(SimpleNamespace(mesh=mesh, F=place), X, i, tind)  # type: ignore[misc]

    def gdof(self, F: Any, w: dict[str, Any], i: int) -> Any:
        """Degree of freedom i of the powers F."""
        middle = w["v"].mean(axis=0)
        return super().gdof(F, w | {"v": w["v"] - middle, "e": w["e"] - middle}, i)  # type: ignore[misc]


class CentredArgyris(_Centred, ElementTriArgyris):
    """Argyris' triangle, P5, with continuous gradient."""


class CentredBFS(_Centred, ElementQuadBFS):
    """The rectangle of Bogner, Fox and Schmit, Q3, with continuous gradient."""
