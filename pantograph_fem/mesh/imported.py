"""Meshes made elsewhere, with their grips labelled."""

from __future__ import annotations

import contextlib
import io
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from pantograph_fem.errors import CaseError
from pantograph_fem.mesh.checks import anticlockwise, flat, position
from pantograph_fem.mesh.triangulation import Triangulation, boundary_edges, edge_keys

if TYPE_CHECKING:
    import meshio

GRIPS = ("bottom", "top")


def read_mesh(path: str | Path) -> Triangulation:
    """Read a mesh of first-order triangles with groups of boundary lines "bottom" and "top".

    Any format that meshio reads with named groups will do; gmsh's .msh 2.2 and 4.1 are tested.
    Points that belong to no triangle are dropped. A constant z is ignored.

    Raises
    ------
    CaseError
        If the file cannot be read, is not a flat, connected, non-overlapping sheet of
        triangles, or lacks a grip. The message says which file, what, where, and what is allowed.
    """
    path = Path(path)
    try:
        return _sheet(_read(path))
    except CaseError as error:
        raise CaseError(f"mesh file {path}: {error}") from error.__cause__


def _read(path: Path) -> meshio.Mesh:
    import meshio

    if not path.is_file():
        raise CaseError("there is no such file")
    # On a file that it cannot read, meshio prints the cause, if it knows it, and ends the process.
    printed = io.StringIO()
    try:
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(io.StringIO()):
            return meshio.read(path)
    except (Exception, SystemExit) as error:
        cause = printed.getvalue() if isinstance(error, SystemExit) else str(error)
        first_line = cause.strip().partition("\n")[0].rstrip(".")
        raise CaseError(
            f"cannot be read (meshio: {first_line or 'not a file of the kind its name says'}); "
            "use a gmsh .msh file, version 2.2 or 4.1, with every saved cell in a physical group"
        ) from error


def _sheet(mesh: meshio.Mesh) -> Triangulation:
    counts = Counter[str]()
    for block in mesh.cells:
        counts[block.type] += len(block.data)
    others = {kind: n for kind, n in counts.items() if kind not in ("triangle", "line", "vertex")}
    if others:
        found = ", ".join(f"{n} {kind}" for kind, n in others.items())
        raise CaseError(
            f"has cells that are not allowed: {found}; allowed are first-order triangles for the "
            "sheet and first-order lines for its grips"
        )
    # A point that is missing from a .msh file has the number -1.
    if any(((b.data < 0) | (b.data >= len(mesh.points))).any() for b in mesh.cells):
        raise CaseError("has cells with corners that are not among its points")
    if counts["triangle"] == 0:
        raise CaseError(
            "has no triangles; label the surface of the sheet as well as the grips (in gmsh: a "
            "physical surface), or it is not saved"
        )
    triangles = _distinct([block.data for block in mesh.cells if block.type == "triangle"])
    used = np.unique(triangles)
    number = np.full(len(mesh.points), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    points = flat(np.asarray(mesh.points, dtype=np.float64)[used])
    triangles = anticlockwise(points, number[triangles])

    boundary = boundary_edges(triangles)
    # The lines of the file count points as the file does.
    boundary_keys = edge_keys(used[boundary], len(mesh.points))
    edges = {}
    for grip in GRIPS:
        lines = _lines(mesh, grip)
        keys = edge_keys(lines, len(mesh.points))
        inside = ~np.isin(keys, boundary_keys)
        if inside.any():
            middle = mesh.points[lines[inside][0]].mean(axis=0)
            raise CaseError(
                f'lines of group "{grip}" that are not on the boundary of the sheet: '
                f"{inside.sum()} of {len(lines)}, the first at {position(middle)}; each must be "
                "an edge of exactly one triangle"
            )
        edges[grip] = boundary[np.isin(boundary_keys, keys)]
    common = np.intersect1d(edges["bottom"], edges["top"])
    if len(common):
        raise CaseError(
            f'groups "bottom" and "top" meet at {position(points[common[0]])}; the grips must '
            "have no point in common"
        )
    return Triangulation(points, triangles, edges)


def _distinct(blocks: list[NDArray[np.int64]]) -> NDArray[np.int64]:
    """Rows of all blocks, once each: .msh 2.2 repeats a cell in each of its groups."""
    rows = np.vstack(blocks).astype(np.int64)
    _, first = np.unique(np.sort(rows, axis=1), axis=0, return_index=True)
    return rows[np.sort(first)]


def _lines(mesh: meshio.Mesh, grip: str) -> NDArray[np.int64]:
    """Lines of a grip as pairs of points, numbered as in the file."""
    groups = _groups(mesh)
    kinds = {
        name: sorted({b.type for b, rows in zip(mesh.cells, members, strict=True) if len(rows)})
        for name, members in groups.items()
    }
    if grip not in groups:
        listed = ", ".join(
            f'"{name}" ({", ".join(kinds[name]) or "empty"})' for name in sorted(groups)
        )
        raise CaseError(
            f'has no group "{grip}"; its groups: {listed or "none"}; the lines of the {grip} grip '
            f'must be in a group "{grip}" (in gmsh: a physical curve)'
        )
    if "line" not in kinds[grip]:
        held = f"only cells of kind {', '.join(kinds[grip])}" if kinds[grip] else "it is empty"
        raise CaseError(
            f'group "{grip}" has no lines ({held}); it must hold the lines of the {grip} grip'
        )
    members = zip(mesh.cells, groups[grip], strict=True)
    return _distinct([block.data[rows] for block, rows in members if block.type == "line"])


def _groups(mesh: meshio.Mesh) -> dict[str, list[NDArray[np.int64]]]:
    """Named groups: for each block of cells of the mesh, the rows that belong to the group."""
    nothing = np.zeros(0, dtype=np.int64)
    groups = {
        name: [nothing if rows is None else np.asarray(rows, dtype=np.int64) for rows in members]
        for name, members in mesh.cell_sets.items()
        if not name.startswith("gmsh:")
    }
    # .msh 2.2 has numbered groups and a table of names instead.
    if "gmsh:physical" in mesh.cell_data:
        tags = mesh.cell_data["gmsh:physical"]
        for name, (tag, dim) in mesh.field_data.items():
            groups.setdefault(
                name,
                [
                    np.flatnonzero(block_tags == tag) if block.dim == dim else nothing
                    for block, block_tags in zip(mesh.cells, tags, strict=True)
                ],
            )
    return groups
