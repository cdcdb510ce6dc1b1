r"""Displacement alone, for an energy without bending.

.. math:: \Pi(\mathbf u) = \int_\Omega W_1(\mathbf I + \nabla\mathbf u)\,d\Omega
"""

from __future__ import annotations

import ufl

from dolfinx import fem, mesh

from .. import dolfinx_api as api
from ..physics.energy import SheetEnergy
from .discretisation import Discretisation, Scales, integration
from .field import fields_of


def first_gradient(
    domain: mesh.Mesh,
    energy: SheetEnergy,
    scales: Scales,
    *,
    degree: int,
    quadrature_degree: int,
) -> Discretisation:
    """Discretise an energy that depends on F alone; the only unknown is u in P(degree)."""
    space = api.functionspace(domain, api.lagrange(degree, (2,)))
    u = fem.Function(space, name="state")
    densities = energy.first_gradient_densities(ufl.Identity(2) + ufl.grad(u))
    dx = integration(quadrature_degree)
    return Discretisation(
        state=u,
        fields=fields_of(space, {"displacement": scales.length}),
        functional=sum(densities.values()) * dx,
        energy=energy,
        densities=densities,
        displacement=u,
        curvatures=None,
        measure=dx,
        scales=scales,
    )
