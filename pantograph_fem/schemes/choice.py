"""The scheme that a case asks for, as far as its energy needs one."""

from __future__ import annotations

from typing import Literal

from dolfinx import mesh

from ..physics.energy import FibreEnergy
from .discretisation import Discretisation, Scales
from .first_gradient import first_gradient
from .hinge import hinge
from .micromorphic import micromorphic

SchemeName = Literal["micromorphic", "hinge"]


def discretise(
    domain: mesh.Mesh,
    energy: FibreEnergy,
    scales: Scales,
    *,
    scheme: SchemeName,
    degree: int,
    auxiliary_degree: int | None,
    quadrature_degree: int,
) -> Discretisation:
    """The scheme applied to the energy; without bending the displacement is all there is."""
    degrees = {"degree": degree, "quadrature_degree": quadrature_degree}
    if not energy.second_gradient:
        return first_gradient(domain, energy, scales, **degrees)
    if scheme == "hinge":
        return hinge(domain, energy, scales, **degrees)
    return micromorphic(
        domain, energy, scales, auxiliary_degree=auxiliary_degree or degree - 1, **degrees
    )
