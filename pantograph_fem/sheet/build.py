"""From a case to the discrete problem: mesh, energy, scheme and grips."""

from __future__ import annotations

import math

from mpi4py import MPI

from dolfinx import fem

from ..case import SheetCase
from ..case.grips import Grip as GripCase
from ..mesh import Triangulation, read_mesh, rectangle
from ..parallel import at_root
from ..physics.energy import FibreEnergy, sheet_energy
from ..physics.rigid_motion import RigidMotion
from ..schemes import Discretisation, Scales, discretise
from .domain import GRIPS, Domain, distribute
from .grip import Grip


def build_domain(
    case: SheetCase, comm: MPI.Comm, triangulation: Triangulation | None = None
) -> Domain:
    """Mesh the sheet, or read its mesh, and distribute it; a collective call.

    A `triangulation` on rank 0 takes the place of the one that the case asks for.
    """
    return distribute(comm, at_root(comm, lambda: triangulation or triangulate(case)))


def triangulate(case: SheetCase) -> Triangulation:
    """The mesh that the case asks for."""
    options = case.mesh
    if options.file is not None:
        return read_mesh(options.file)
    # The case has filled in these.
    assert options.size is not None
    assert options.corner_size is not None
    assert options.growth is not None
    return rectangle(
        case.sheet.width,
        case.sheet.height,
        options.size,
        options.corner_size,
        (options.grip_size, options.grip_size),
        options.growth,
    )


def build_energy(case: SheetCase, domain: Domain) -> FibreEnergy:
    """Energy (31) of the effects that the case names, with coefficients that can change."""
    material = case.material
    return sheet_energy(
        constant=lambda value: fem.Constant(domain.mesh, float(value)),
        fibre_angle=math.radians(case.sheet.fibre_angle),
        stretch=material.stretch_pair,
        bending=material.bending_pair,
        shear=material.shear if material.has_shear else None,
        exponent=material.shear_exponent,
        regularisation=case.discretisation.shear_regularisation,
    )


def discretise_sheet(case: SheetCase, domain: Domain) -> Discretisation:
    """Energy (31) by the scheme of the case."""
    options = case.discretisation
    return discretise(
        domain.mesh,
        build_energy(case, domain),
        _scales(case, domain),
        scheme=options.scheme,
        degree=options.degree,
        auxiliary_degree=options.auxiliary_degree,
        quadrature_degree=options.quadrature_degree,
    )


def build_grips(case: SheetCase, domain: Domain) -> list[Grip]:
    """Both grips, in the order of :data:`GRIPS`."""
    return [_grip(getattr(case.grips, name), domain, name) for name in GRIPS]


def _grip(grip: GripCase, domain: Domain, name: str) -> Grip:
    left, right = domain.ends[name]
    centre = (left + right) / 2
    pivots = {"left": left, "right": right, "centre": centre}
    pivot = pivots[grip.pivot] if isinstance(grip.pivot, str) else grip.pivot
    place = float(pivot[0]), float(pivot[1])
    return Grip(
        tags=domain.tags,
        tag=GRIPS.index(name),
        motion=RigidMotion.from_degrees(grip.translation, grip.rotation, place),
        clamp=grip.hold == "clamp",
        centre=(float(centre[0]), float(centre[1])),
    )


def _scales(case: SheetCase, domain: Domain) -> Scales:
    """Extent of the sheet, and its stiffnesses in N/m."""
    material = case.material
    stretch = max(material.stretch_pair or (0.0,))
    bending = max(material.bending_pair or (0.0,)) / domain.extent**2
    return Scales.of(domain.extent, 2, stretch, max(material.shear or 0.0, bending))
