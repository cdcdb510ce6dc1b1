"""Graded, symmetric meshes of a rectangle."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from pantograph_fem.case.mesh import GROWTH
from pantograph_fem.errors import CaseError
from pantograph_fem.mesh.gmsh_session import gmsh_model
from pantograph_fem.mesh.size_field import SizeField
from pantograph_fem.mesh.triangulation import Triangulation, boundary_edges

#: Adds a size field to the current model of gmsh; the value is its tag, valid in the context.
AddField = Callable[[ModuleType], AbstractContextManager[int]]


def rectangle(
    width: float,
    height: float,
    size: float,
    corner_size: float,
    grip_size: tuple[float | None, float | None] = (None, None),
    growth: float = GROWTH,
) -> Triangulation:
    r"""Mesh the rectangle [0, width] x [0, height], finer at its corners and, if asked, its grips.

    The element size asked for is

    .. math:: h = \min(h_{size},\; h_{corner} + g\,r,\; h_{grip} + g\,d)

    with r the distance to the nearest corner, d the distance to the grip, and g the growth. The
    mesh is symmetric to round-off about x = width/2, and about y = height/2 if the two grips have
    the same size. Equal arguments give equal meshes; all lengths times c give c times the mesh.

    Parameters
    ----------
    width, height
        Sides of the sheet, in any unit of length.
    size
        Element size inside.
    corner_size
        Element size at the four corners.
    grip_size
        Element size along the bottom edge and along the top edge; None asks for nothing.
    growth
        g.

    Raises
    ------
    CaseError
        If a length or the growth is not a positive number.
    """
    _check_lengths(width, height, size, corner_size, grip_size, growth)
    # Gmsh has absolute tolerances: it gets a problem whose longer side is 1. Rounding makes the
    # problem the same to the last bit whatever the unit of length.
    unit = max(width, height)
    w, h, inside, corner = (_rounded(v / unit) for v in (width, height, size, corner_size))
    bottom, top = (None if v is None else _rounded(v / unit) for v in grip_size)

    mirrored_in_y = bottom == top
    to_corner = "Sqrt(x*x+y*y)"
    if not mirrored_in_y:
        to_corner = f"Min({to_corner},Sqrt(x*x+({h}-y)*({h}-y)))"
    field = f"Min({inside},{corner}+{growth}*{to_corner})"
    if bottom is not None:
        field = f"Min({field},{bottom}+{growth}*y)"
    if top is not None and not mirrored_in_y:
        field = f"Min({field},{top}+{growth}*({h}-y))"

    points, triangles = _mesh_box(w / 2, h / 2 if mirrored_in_y else h, _formula(field))
    points *= (width / 2, height / 2 if mirrored_in_y else height)
    points, triangles = _mirror(points, triangles, 0, width / 2)
    if mirrored_in_y:
        points, triangles = _mirror(points, triangles, 1, height / 2)
    return _sheet(points, triangles, height)


def rectangle_by_sizes(width: float, height: float, sizes: SizeField) -> Triangulation:
    """Mesh the rectangle [0, width] x [0, height] with sizes given on its lower left quarter.

    The other quarters are mirror images of that one, to round-off. Equal arguments give equal
    meshes.

    Parameters
    ----------
    width, height
        Sides of the sheet, in any unit of length.
    sizes
        Element sizes on [0, width/2] x [0, height/2], in the same unit.

    Raises
    ------
    CaseError
        If a size is not a positive number.
    """
    if not (np.isfinite(sizes.sizes).all() and (sizes.sizes > 0.0).all()):
        raise CaseError("mesh: every element size must be a positive length")
    unit = max(width, height)
    box = width / unit / 2, height / unit / 2
    points, triangles = _mesh_box(*box, sizes.scaled(1.0 / unit).in_gmsh)
    points *= (width / 2, height / 2)
    points, triangles = _mirror(points, triangles, 0, width / 2)
    points, triangles = _mirror(points, triangles, 1, height / 2)
    return _sheet(points, triangles, height)


def _sheet(
    points: NDArray[np.float64], triangles: NDArray[np.int64], height: float
) -> Triangulation:
    """The mesh with its grips, the edges at y = 0 and at y = height."""
    boundary = boundary_edges(triangles)
    y = points[boundary, 1]
    edges = {
        "bottom": boundary[(y == 0.0).all(axis=1)],
        "top": boundary[(y == height).all(axis=1)],
    }
    return Triangulation(points, triangles, edges)


def _check_lengths(
    width: float,
    height: float,
    size: float,
    corner_size: float,
    grip_size: tuple[float | None, float | None],
    growth: float,
) -> None:
    lengths = {
        "width": width,
        "height": height,
        "size": size,
        "corner_size": corner_size,
        "grip_size of the bottom": grip_size[0],
        "grip_size of the top": grip_size[1],
    }
    for name, value in lengths.items():
        if value is not None and not (math.isfinite(value) and value > 0.0):
            raise CaseError(f"mesh: {name} = {value}: must be a positive length")
    if not (math.isfinite(growth) and growth > 0.0):
        raise CaseError(f"mesh: growth = {growth}: must be a positive number")


def _rounded(value: float) -> float:
    """Value to 12 significant digits: more than a mesh needs, fewer than round-off reaches."""
    return float(f"{value:.12g}")


def _formula(formula: str) -> AddField:
    """The size field of a formula in x and y."""

    @contextmanager
    def add(gmsh: ModuleType) -> Iterator[int]:
        tag = gmsh.model.mesh.field.add("MathEval")
        gmsh.model.mesh.field.setString(tag, "F", formula)
        yield tag

    return add


def _mesh_box(
    width: float, height: float, field: AddField
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Mesh [0, width] x [0, height] with a size field; points in fractions of the two sides."""
    with gmsh_model() as gmsh, field(gmsh) as tag:
        gmsh.model.occ.addRectangle(0.0, 0.0, 0.0, width, height)
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.field.setAsBackgroundMesh(tag)
        gmsh.model.mesh.generate(2)
        node_tags, coordinates, _ = gmsh.model.mesh.getNodes()
        _, corner_tags = gmsh.model.mesh.getElementsByType(
            gmsh.model.mesh.getElementType("triangle", 1)
        )
        # Copies: gmsh frees its arrays.
        node_tags = np.array(node_tags, dtype=np.int64)
        points = np.array(coordinates).reshape(-1, 3)[:, :2] / (width, height)
        triangles = np.array(corner_tags, dtype=np.int64).reshape(-1, 3)

    for side in (0.0, 1.0):
        points[np.abs(points - side) < 1e-9] = side
    index = np.zeros(node_tags.max() + 1, dtype=np.int64)
    index[node_tags] = np.arange(len(node_tags))
    return points, index[triangles]


def _mirror(
    points: NDArray[np.float64], triangles: NDArray[np.int64], axis: int, position: float
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Add the mirror image about the line where coordinate `axis` equals `position`."""
    on_line = points[:, axis] == position
    image = points[~on_line].copy()
    image[:, axis] = 2.0 * position - image[:, axis]
    index = np.where(on_line, np.arange(len(points)), len(points) + np.cumsum(~on_line) - 1)
    # A reflection turns the triangles round: reversing their corners turns them back.
    return np.vstack([points, image]), np.vstack([triangles, index[triangles][:, ::-1]])
