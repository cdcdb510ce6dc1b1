"""Meshes of the sheet for scikit-fem."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from skfem import MeshQuad, MeshTri

#: Sides of the sheet, m.
WIDTH, HEIGHT = 0.068, 0.204
#: Increase of the element size per distance from a corner, as in pantograph_fem.
GROWTH = 0.25


def uniform_triangles(size: float) -> MeshTri:
    """Squares of about `size` (m), each cut in two."""
    return MeshTri.init_tensor(_uniform(WIDTH, size), _uniform(HEIGHT, size))


def triangles_of_file(path: Path) -> MeshTri:
    """The mesh of an .npz file with `points`, shape (n, 2), and `triangles`, shape (m, 3)."""
    stored = np.load(path)
    return MeshTri(*(np.ascontiguousarray(stored[key].T) for key in ("points", "triangles")))


def rectangles(size: float, corner_size: float | None) -> MeshQuad:
    """Rows and columns that are narrower towards the corners, if `corner_size` (m) is given."""
    if corner_size is None:
        return MeshQuad.init_tensor(_uniform(WIDTH, size), _uniform(HEIGHT, size))
    return MeshQuad.init_tensor(*(_graded(side, size, corner_size) for side in (WIDTH, HEIGHT)))


def _uniform(side: float, size: float) -> NDArray[np.float64]:
    return np.linspace(0.0, side, max(1, round(side / size)) + 1)


def _graded(side: float, size: float, end_size: float) -> NDArray[np.float64]:
    places = [0.0]
    while places[-1] < side / 2:
        places.append(places[-1] + min(size, end_size + GROWTH * places[-1]))
    half = np.array(places) * (side / 2 / places[-1])
    return np.concatenate([half, side - half[-2::-1]])
