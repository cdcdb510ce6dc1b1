r"""The paper's scheme: an auxiliary gradient tied to ∇u by a Lagrange multiplier.

.. math:: \Pi(\mathbf u, \mathbf H, \boldsymbol\Lambda) = \int_\Omega
    W_0(\mathbf u) + W_1(\mathbf F_0 + \nabla\mathbf u) + W_2(\mathbf F_0 + \mathbf H)
    + \boldsymbol\Lambda : (\nabla\mathbf u - \mathbf H)\ d\Omega

F0 is the gradient of the reference placement. W0 holds a foundation, W1 stretch and shear, W2
bending, which takes one derivative of H instead of two of u.

H and Λ share one continuous space: bending stiffens only :math:`\partial_\alpha(\mathbf H\mathbf
D_\alpha)`, so every dof of H needs a multiplier to hold it, and a poorer Λ leaves the system
singular. Stretch and shear take ∇u, which keeps the system stable where bending is weak.

The multiplier closes the gap :math:`\nabla\mathbf u - \mathbf H` only as far as its own space
reaches. What it misses are wrinkles of u at the scale of the elements, which would cost no bending:
under compression they make a stable sheet look unstable, the more so the finer the mesh. So the
functional is augmented by

.. math:: \int_\Omega \sum_\alpha \frac{c\,K_b^\alpha}{2h^2}
    \,\|(\nabla\mathbf u - \mathbf H)\,\mathbf D_\alpha\|^2\ d\Omega

which gives wrinkles the bending stiffness of their own wavelength, vanishes for the exact solution,
and leaves the number of negative pivots of a stable state as it is.
"""

from __future__ import annotations

import ufl

from dolfinx import fem, mesh

from .. import dolfinx_api as api
from ..physics.energy import FibreEnergy
from .discretisation import Discretisation, Scales, integration
from .field import fields_of
from .stiff import near, stretching

#: c of the augmentation. With 1 to 20 the buckling load of upright fibres is exact on any mesh, and
#: the force of the bias test changes by less than 1e-4; with 0 it is missed by up to 70 %.
GAP_STIFFNESS = 4.0


def micromorphic(
    domain: mesh.Mesh,
    energy: FibreEnergy,
    scales: Scales,
    *,
    degree: int,
    auxiliary_degree: int,
    quadrature_degree: int,
) -> Discretisation:
    """Discretise (31) or (16) with u in P(degree), H and Λ in P(auxiliary_degree).

    The stationary point is a saddle: as many negative pivots as multiplier dofs at a stable state.
    """
    tensor = api.lagrange(auxiliary_degree, (2, domain.geometry.dim), domain)
    vector = api.lagrange(degree, (2,), domain)
    space = api.functionspace(domain, api.mixed([vector, tensor, tensor]))
    state = fem.Function(space, name="state")
    u, H, Lambda = ufl.split(state)
    F, bent = energy.reference + ufl.grad(u), energy.reference + H
    densities = (
        energy.displacement_densities(u)
        | energy.first_gradient_densities(F)
        | energy.second_gradient_densities(bent)
    )
    gap = ufl.grad(u) - H
    h = api.cell_size(domain)
    # Counted as bending, so that the stored energy is the work of the grips on any mesh.
    densities["bending"] += sum(
        0.5 * GAP_STIFFNESS * K_b / h**2 * ufl.dot(gap_of_fibre, gap_of_fibre)
        for K_b, gap_of_fibre in ((K_b, gap * energy.directions[i]) for i, K_b in energy.bending)
    )
    dx = integration("dx", quadrature_degree)
    stored = {name: density * dx for name, density in densities.items()}
    return Discretisation(
        state=state,
        fields=fields_of(
            space,
            {"displacement": scales.length, "gradient": 1.0, "multiplier": scales.stiffness},
            multipliers=("multiplier",),
        ),
        functional=(sum(densities.values()) + ufl.inner(Lambda, gap)) * dx,
        stored=stored,
        stiff=tuple(stretching(energy, F, dx)),
        energy=energy,
        densities=densities,
        displacement=u,
        bent_gradient=bent,
        degree=degree,
        curvature_degree=auxiliary_degree - 1,
        quadrature_degree=quadrature_degree,
        scales=scales,
        near=near(scales),
    )
