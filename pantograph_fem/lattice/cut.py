"""A pantographic lattice cut from a rectangle, energy (19), as the discrete sheet."""

from __future__ import annotations

from collections.abc import Collection
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..errors import CaseError
from .grid import Grid, cut_grid, directions
from .net import End, Net, Pivots, Turns, Walls
from .quadrants import averaged_quadrants, links_at_nodes, literal_quadrants
from .tributary import square_areas, strip_widths

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

PivotRule = Literal["averaged", "literal"]


def cut(
    width: float,
    height: float,
    fibre_angle: float,
    spacing: float,
    *,
    stretch: tuple[float, float] | None = None,
    bending: tuple[float, float] | None = None,
    shear: float | None = None,
    exponent: float = 2.0,
    regularisation: float = 1e-4,
    pivots: PivotRule = "averaged",
    clamped: Collection[str] = (),
) -> Net:
    r"""The lattice of (19) within [0, W] x [0, H] with the constants (30) of a sheet.

    .. math:: k = K_e\frac{w}{\ell}, \qquad b = K_b\frac{2w}{\ell_1+\ell_2}, \qquad
        b_3 = K_p\varepsilon^2

    Links of the length ε in strips of the width w = ε have k = K_e and b = K_b, which is (30).
    Only links that end at a grip are shorter, and only strips along a side are narrower: see
    :func:`.grid.cut_grid` and :func:`.tributary.strip_widths`. A clamp holds the directions of
    the fibres that end at its grip, each by a spring of the constant 2 K_b w/ℓ.

    Parameters
    ----------
    width, height
        W and H, m.
    fibre_angle
        From x to the first family, degrees.
    spacing
        ε, m.
    stretch, bending
        K_e (N/m) and K_b (N m) of both families; an effect that is None or 0 is left out.
    shear, exponent, regularisation
        K_p (N/m), γ and δ (rad).
    pivots
        "literal": (19) as it is printed, a spring on the quadrant between +D1 and +D2 of each
        node. "averaged": the mean over the quadrants that a node has, times K_p and the part of
        the sheet that is nearest to the node; a node without a quadrant hands its part to its
        neighbours. The energy of a homogeneous deformation is then that of the sheet, up to what
        lies nearest to a crossing outside of a rectangle that the spacing does not fit.
    clamped
        Which of the grips "bottom" and "top" hold directions as well.

    Raises
    ------
    CaseError
        Where the spacing leaves a grip nothing to hold, or nothing free between them.
    """
    grid = cut_grid(width, height, fibre_angle, spacing)
    held = np.zeros(len(grid.nodes), dtype=bool)
    for nodes in grid.grips.values():
        held[nodes] = True
    if held.all() or any(len(nodes) == 0 for nodes in grid.grips.values()):
        raise CaseError(
            f"A spacing of {spacing:g} m is too large for a lattice of {width:g} m by "
            f"{height:g} m: it must be at most half the shorter side."
        )
    D = directions(fibre_angle)
    span = grid.nodes[grid.links[:, 1]] - grid.nodes[grid.links[:, 0]]
    length = np.hypot(span[:, 0], span[:, 1])
    strip = np.empty(len(length))
    for family in (0, 1):
        of = grid.family == family
        points = grid.nodes[grid.links[of, 0]]
        strip[of] = strip_widths(points, D[family], width, height, spacing)
    at = links_at_nodes(grid.links, grid.family, len(grid.nodes))
    turns = walls = springs = None
    if bending and any(bending):
        stiffness = np.asarray(bending)[grid.family] * strip
        turns = _turns(at, stiffness, length)
        walls = _walls(grid, clamped, held, 2.0 * stiffness / length)
    if shear:
        if pivots == "literal":
            pairs = literal_quadrants(at)
            areas = np.full(len(pairs), spacing**2)
        else:
            squares = square_areas(grid.nodes, D[0], width, height, spacing)
            pairs, areas = averaged_quadrants(grid.links, at, np.where(grid.crossing, squares, 0.0))
        springs = Pivots(pairs, shear * areas, exponent, regularisation)
    return Net(
        nodes=grid.nodes,
        links=grid.links,
        family=grid.family,
        ends={
            name: End(nodes, (0.5 * width, height if name == "top" else 0.0))
            for name, nodes in grid.grips.items()
        },
        stiffness=(
            np.asarray(stretch)[grid.family] * strip / length if stretch and any(stretch) else None
        ),
        turns=turns,
        walls=walls,
        pivots=springs,
    )


def _turns(at: IntArray, stiffness: Array, length: Array) -> Turns:
    """A spring wherever a fibre of a family that resists goes on; `stiffness` is K_b w."""
    before, after = at[:, 0].ravel(), at[:, 1].ravel()
    on = (before >= 0) & (after >= 0)
    on &= stiffness[before] > 0
    links = np.column_stack([before[on], after[on]])
    return Turns(links, stiffness[links[:, 0]] / length[links].mean(axis=1))


def _walls(
    grid: Grid, clamped: Collection[str], held: NDArray[np.bool_], stiffness: Array
) -> Walls | None:
    """A spring on each link that leads from a clamp to a node that is free to move."""
    links: list[IntArray] = []
    ends: list[IntArray] = []
    for place, (name, nodes) in enumerate(grid.grips.items()):
        if name not in clamped:
            continue
        gripped = np.isin(grid.links, nodes).any(axis=1)
        leading = gripped & ~held[grid.links].all(axis=1) & (stiffness > 0)
        links.append(np.flatnonzero(leading))
        ends.append(np.full(len(links[-1]), place))
    if not links:
        return None
    numbers = np.concatenate(links)
    return Walls(numbers, stiffness[numbers], np.concatenate(ends))
