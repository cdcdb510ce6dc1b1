r"""Displacement alone, for an energy without bending.

.. math:: \Pi(\mathbf u) = \int_\Omega W_0(\mathbf u) + W_1(\nabla\boldsymbol\chi)\,d\Omega
"""

from __future__ import annotations

import ufl

from dolfinx import fem, mesh

from .. import dolfinx_api as api
from ..physics.energy import FibreEnergy
from .discretisation import Discretisation, Scales, integration
from .field import fields_of
from .stiff import near, stretching


def first_gradient(
    domain: mesh.Mesh,
    energy: FibreEnergy,
    scales: Scales,
    *,
    degree: int,
    quadrature_degree: int,
) -> Discretisation:
    """Discretise an energy without curvature; the only unknown is u in P(degree)."""
    space = api.functionspace(domain, api.lagrange(degree, (2,), domain))
    u = fem.Function(space, name="state")
    F = energy.reference + ufl.grad(u)
    densities = energy.displacement_densities(u) | energy.first_gradient_densities(F)
    dx = integration("dx", quadrature_degree)
    stored = {name: density * dx for name, density in densities.items()}
    return Discretisation(
        state=u,
        fields=fields_of(space, {"displacement": scales.length}),
        functional=sum(stored.values()),
        stored=stored,
        stiff=tuple(stretching(energy, F, dx)),
        energy=energy,
        densities=densities,
        displacement=u,
        bent_gradient=None,
        degree=degree,
        curvature_degree=0,
        quadrature_degree=quadrature_degree,
        scales=scales,
        near=near(scales),
    )
