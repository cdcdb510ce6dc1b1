"""Meshes of the paper's sheet that nobody would want."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

_WIDTH, _HEIGHT = 0.068, 0.204

Array = NDArray[np.float64]


def slivers(path: Path) -> None:
    """Write a mesh of triangles ten times as wide as high or more, in bands across the sheet."""
    x = np.linspace(0.0, _WIDTH, 7)
    # bands of 1 mm between bands of 11 mm
    heights = np.tile([0.011, 0.001], 17)
    y = np.concatenate([[0.0], np.cumsum(heights)])
    _write(path, *_grid(x, _HEIGHT / y[-1] * y))


def shaken(path: Path) -> None:
    """Write a grid whose inner points are moved at random, by up to 0.45 of a cell.

    Angles come down to a few degrees.
    """
    columns, rows = 8, 24
    points, triangles = _grid(
        np.linspace(0.0, _WIDTH, columns + 1), np.linspace(0.0, _HEIGHT, rows + 1)
    )
    cell = np.array([_WIDTH / columns, _HEIGHT / rows])
    way = np.random.default_rng(5).uniform(-0.45, 0.45, points.shape) * cell
    inside = (points > 1e-9).all(axis=1) & (points < np.array([_WIDTH, _HEIGHT]) - 1e-9).all(axis=1)
    moved = points + np.where(inside[:, None], way, 0.0)
    while (turned := _areas(moved, triangles) <= 0.02 * cell.prod()).any():
        # back by half where triangles would be turned round
        back = np.unique(triangles[turned])
        moved[back] = 0.5 * (moved[back] + points[back])
    _write(path, moved, triangles)


def _grid(x: Array, y: Array) -> tuple[Array, NDArray[np.int64]]:
    X, Y = np.meshgrid(x, y)
    n = len(x)
    corner = (np.arange(len(y) - 1)[:, None] * n + np.arange(n - 1)).ravel()
    lower = np.column_stack([corner, corner + 1, corner + n + 1])
    upper = np.column_stack([corner, corner + n + 1, corner + n])
    return np.column_stack([X.ravel(), Y.ravel()]), np.concatenate([lower, upper])


def _areas(points: Array, triangles: NDArray[np.int64]) -> Array:
    a, b, c = points[triangles].transpose(1, 0, 2)
    return np.asarray(0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]))


def _write(path: Path, points: Array, triangles: NDArray[np.int64]) -> None:
    import meshio

    sides = []
    for y in (0.0, _HEIGHT):
        row = np.flatnonzero(np.abs(points[:, 1] - y) < 1e-9)
        row = row[np.argsort(points[row, 0])]
        sides.append(np.column_stack([row[:-1], row[1:]]))
    lines = np.concatenate(sides)
    groups = [np.repeat([1, 2], [len(side) for side in sides]), np.full(len(triangles), 3)]
    mesh = meshio.Mesh(
        np.column_stack([points, np.zeros(len(points))]),
        [("line", lines), ("triangle", triangles)],
        cell_data={"gmsh:physical": groups, "gmsh:geometrical": groups},
        field_data={
            "bottom": np.array([1, 1]),
            "top": np.array([2, 1]),
            "sheet": np.array([3, 2]),
        },
    )
    mesh.write(path, file_format="gmsh22", binary=False)
