"""What makes a triangulation a sheet: each check raises a CaseError that says what and where."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pantograph_fem.errors import CaseError
from pantograph_fem.mesh.triangulation import (
    directed_edges,
    edge_keys,
    edge_lengths,
    signed_areas,
)

#: Area over squared longest edge below which a triangle has no shape to compute with.
MIN_AREA_RATIO = 1e-12
#: Distance over the diagonal of the sheet below which two points are one.
COINCIDENCE = 1e-9


def flat(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Drop z from points of shape (n, 2) or (n, 3).

    Raises
    ------
    CaseError
        If a coordinate is not finite or z is not constant.
    """
    _refuse(
        "points with a coordinate that is not a finite number",
        np.any(~np.isfinite(points), axis=1),
        points,
        "every point needs x and y",
    )
    if points.shape[1] > 2:
        low, high = points[np.argmin(points[:, 2])], points[np.argmax(points[:, 2])]
        if high[2] - low[2] > COINCIDENCE * _diagonal(points):
            raise CaseError(
                f"the points are not in one plane: z = {low[2]:.6g} at {position(low)} and "
                f"{high[2]:.6g} at {position(high)}; the sheet must lie in a plane z = constant"
            )
    return points[:, :2].copy()


def anticlockwise(points: NDArray[np.float64], triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    """Check that the triangles make one plain sheet; return them anticlockwise.

    A mesh whose triangles all turn clockwise is turned round: that is a convention only.
    Overlaps of parts that share no edge are not looked for.

    Raises
    ------
    CaseError
        If points coincide, triangles are degenerate or overlap, or the sheet is not in one piece.
    """
    centres = points[triangles].mean(axis=1)
    _refuse(
        "points that coincide with another point",
        coincident(points),
        points,
        "the mesh is not connected there; merge them (in gmsh: Coherence, or "
        "removeDuplicateNodes; a cut needs a width)",
    )
    areas = signed_areas(points, triangles)
    longest = edge_lengths(points, triangles).max(axis=1)
    _refuse(
        f"degenerate triangles (area below {MIN_AREA_RATIO:g} of the squared longest edge)",
        np.abs(areas) <= MIN_AREA_RATIO * longest**2,
        centres,
        "move their points apart or mesh again",
    )
    directed = directed_edges(triangles)
    middles = points[directed].mean(axis=1)
    keys = edge_keys(directed, len(points))
    _refuse(
        "edges of more than two triangles",
        _multiplicity(keys) > 2,
        middles,
        "an edge belongs to one triangle on the boundary and to two inside",
        each=keys,
    )
    clockwise = areas < 0.0
    if clockwise.all():
        triangles = triangles[:, ::-1].copy()
    elif clockwise.any():
        _refuse(
            "triangles that turn against the others",
            clockwise if 2 * clockwise.sum() <= len(clockwise) else ~clockwise,
            centres,
            "the sheet folds over itself there, or its surfaces are oriented differently (in "
            "gmsh: reverse the curve loop of one); all must turn the same way",
        )
    # Now that all turn the same way, neighbours run through their common edge in opposite senses.
    keys = directed[:, 0] * len(points) + directed[:, 1]
    _refuse(
        "edges with both triangles on the same side",
        _multiplicity(keys) > 1,
        middles,
        "triangles overlap there; they must lie on either side",
        each=keys,
    )
    part = _parts(triangles)
    sizes = np.bincount(part)
    if len(sizes) > 1:
        smallest = int(np.argmin(sizes))
        raise CaseError(
            f"the sheet falls into {len(sizes)} parts that have no edge in common; one has "
            f"{sizes[smallest]} of the {len(part)} triangles, at "
            f"{position(centres[part == smallest][0])}; it must be in one piece"
        )
    return triangles


def coincident(points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which points lie on an earlier one.

    Points are sorted into square boxes, four times with shifted boxes so that no pair is
    always on two sides of a wall.
    """
    boxes = (points - points.min(axis=0)) / (2.0 * COINCIDENCE * _diagonal(points))
    found = np.zeros(len(points), dtype=bool)
    for shift in ((0.0, 0.0), (0.0, 0.5), (0.5, 0.0), (0.5, 0.5)):
        column, row = np.floor(boxes + shift).astype(np.int64).T
        _, first = np.unique(column * 2**31 + row, return_index=True)
        repeated = np.ones(len(points), dtype=bool)
        repeated[first] = False
        found |= repeated
    return found


def position(point: NDArray[np.float64]) -> str:
    """Coordinates as text."""
    return "(" + ", ".join(f"{x:.6g}" for x in point) + ")"


def _refuse(
    what: str,
    bad: NDArray[np.bool_],
    positions: NDArray[np.float64],
    remedy: str,
    each: NDArray[np.int64] | None = None,
) -> None:
    """Raise if any is bad; those with equal keys in `each` are one thing and count once."""
    if bad.any():
        count = bad.sum() if each is None else len(np.unique(each[bad]))
        raise CaseError(f"{what}: {count}, the first at {position(positions[bad][0])}; {remedy}")


def _diagonal(points: NDArray[np.float64]) -> float:
    """Diagonal of the box around the points; 1 if they are all one."""
    return float(np.linalg.norm(np.ptp(points, axis=0))) or 1.0


def _multiplicity(keys: NDArray[np.int64]) -> NDArray[np.int64]:
    """How often each key occurs."""
    _, inverse, counts = np.unique(keys, return_inverse=True, return_counts=True)
    return counts[inverse]


def _parts(triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    """Part that each triangle belongs to, as a number; parts are connected through edges."""
    keys = edge_keys(directed_edges(triangles), int(triangles.max()) + 1)
    order = np.argsort(keys, kind="stable")
    shared = np.flatnonzero(np.diff(keys[order]) == 0)
    one, other = order[shared], order[shared + 1]
    # Across each of its edges a triangle has a neighbour, or on the boundary itself.
    neighbour = np.repeat(np.arange(len(triangles)), 3)
    neighbour[one], neighbour[other] = neighbour[other], neighbour[one]
    neighbour = neighbour.reshape(-1, 3)
    label = np.arange(len(triangles))
    while True:
        lowest = np.minimum(label, label[neighbour].min(axis=1))
        # A label is itself a triangle of the part, with a label that is no higher.
        lowest = lowest[lowest]
        if np.array_equal(lowest, label):
            return np.unique(label, return_inverse=True)[1]
        label = lowest
