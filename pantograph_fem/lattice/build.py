"""From a case to a net of springs, the motions of its ends and its loads."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..case import ChainCase, LatticeCase
from ..case.grips import Grip
from ..physics.rigid_motion import RigidMotion
from .chain import chain, winkler
from .cut import cut
from .end_load import EndLoad
from .grid import directions
from .net import Net
from .tributary import square_areas

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class NetProblem:
    """A net and what is done to it.

    Attributes
    ----------
    net
        The net.
    motions
        Motion of each end by name.
    loads
        Dead loads on free ends.
    parts
        Part of the continuum that each node stands for, shape (n,), m² or m.
    """

    net: Net
    motions: dict[str, RigidMotion]
    parts: Array
    loads: list[EndLoad] = field(default_factory=list)


def build_lattice(case: LatticeCase) -> NetProblem:
    """Cut the lattice from the sheet, with the constants (30)."""
    sheet, material, grips, lattice = case.sheet, case.material, case.grips, case.lattice
    ends = {"bottom": grips.bottom, "top": grips.top}
    net = cut(
        sheet.width,
        sheet.height,
        sheet.fibre_angle,
        lattice.spacing,
        stretch=material.stretch_pair,
        bending=material.bending_pair,
        shear=material.shear,
        exponent=material.shear_exponent,
        regularisation=lattice.shear_regularisation,
        pivots=lattice.pivots,
        clamped=[name for name, grip in ends.items() if grip.hold == "clamp"],
    )
    D1 = directions(sheet.fibre_angle)[0]
    areas = square_areas(net.nodes, D1, sheet.width, sheet.height, lattice.spacing)
    motions = {
        name: _grip_motion(grip, sheet.width, sheet.height if name == "top" else 0.0)
        for name, grip in ends.items()
    }
    return NetProblem(net, motions, areas)


def _grip_motion(grip: Grip, width: float, y: float) -> RigidMotion:
    pivots = {"left": (0.0, y), "right": (width, y), "centre": (0.5 * width, y)}
    pivot = pivots[grip.pivot] if isinstance(grip.pivot, str) else grip.pivot
    return RigidMotion.from_degrees(grip.translation, grip.rotation, pivot)


def build_chain(case: ChainCase) -> NetProblem:
    """The chain that stands for the beam, with the constants (15)."""
    length, spacing, material = case.beam.length, case.chain.spacing, case.material
    pieces = material.pieces(length)
    ends = {"left": case.ends.left, "right": case.ends.right}
    net = chain(
        length,
        spacing,
        stretch=material.stretch,
        bending=material.bending,
        supports={name: end.support for name, end in ends.items()},
        ground=winkler(length, spacing, pieces) if pieces else None,
    )
    places = {"left": (0.0, 0, 0), "right": (length, net.size - 1, len(net.links) - 1)}
    motions, loads = {}, []
    for name, end in ends.items():
        x, node, link = places[name]
        if name in net.ends:
            motions[name] = RigidMotion.from_degrees(
                end.translation, end.rotation, end.pivot or (x, 0.0)
            )
        if end.moment or any(end.force):
            loads.append(EndLoad(name, node, link, end.force, end.moment))
    parts = np.full(net.size, spacing)
    parts[[0, -1]] *= 0.5
    return NetProblem(net, motions, parts, loads)
