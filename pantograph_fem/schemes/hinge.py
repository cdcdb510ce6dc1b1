r"""Displacement alone, with a hinge between elements: interior penalty in the fibre angle.

The direction φ of a fibre jumps where it crosses from one element to the next. The jump is the turn
of a hinge, which is closed by the mean bending moment m = K_b κ and by a spring:

.. math:: \Pi(\mathbf u) = \int_\Omega W_0 + W_1 + W_2\ d\Omega + \sum_\alpha \int_{\Gamma}
    \{m\}\,q\,J + \tfrac12 K_b\,s\,q^2 J^2\ d\Gamma, \qquad
    J = \varphi^- - \varphi^+,\quad q = \mathbf D_\alpha\cdot\mathbf n^+

on all edges Γ inside. It is consistent: for a smooth solution J = 0 and the mean moment is what
integration by parts asks for. The spring is the rotational spring of (1), Hencky's hinge. Jumps of
the stretch cost nothing, as in (31).

The stiffness s makes the tangent positive wherever the state is stable, on any mesh, without a
number to tune: see :func:`hinge_stiffness`.
"""

from __future__ import annotations

import ufl

from dolfinx import fem, mesh

from .. import dolfinx_api as api
from ..physics.energy import FibreEnergy
from ..physics.kinematics import Expr, angle_between, fibre
from .discretisation import Discretisation, Scales, integration
from .field import fields_of
from .stiff import StiffEnergy, bending, stretching

#: Errors up to which an old factor serves. Farther off, its steps leave angles at the hinges whose
#: moments, the larger the smaller the elements, spoil the tangent that extrapolates them.
_NEAR = 1e-4


def trace_constant(domain: mesh.Mesh, degree: int) -> Expr:
    r"""Constant c of the trace inequality, 1/m.

    On an element T with the side F, a polynomial v of the degree k has

    .. math:: \int_F v^2 \le c \int_T v^2, \qquad
        c = \frac{(k+1)(k+2)}{2}\frac{|F|}{|T|} \text{ (triangle)}, \quad
        c = \frac{(k+1)^2}{|T|} \text{ (interval)}

    (Warburton and Hesthaven, 2003).
    """
    if domain.topology.dim == 1:
        return (degree + 1) ** 2 / api.cell_size(domain)
    sides = ufl.FacetArea(domain) / ufl.CellVolume(domain)
    return (degree + 1) * (degree + 2) / 2 * sides


def hinge_stiffness(domain: mesh.Mesh, curvature_degree: int) -> Expr:
    r"""Stiffness s of a hinge at the boundary, in units of K_b; 1/m. Inside, its mean.

    With the moment :math:`m = K_b\kappa` of an element whose N sides share its bending energy,

    .. math:: \int_F m\,q\,J \le \int_F \frac{K_b\kappa^2}{2Nc} + \frac{K_b}{2} N c\,q^2 J^2
        \le \frac{1}{2N}\int_T K_b\kappa^2 + \int_F \frac{K_b}{2} N c\,q^2 J^2,

    so s = N c leaves the sum of both energies positive, even if all sides are at the boundary;
    inside, where an element gives half of the mean moment, half of the bending energy is left.
    """
    return (domain.topology.dim + 1) * trace_constant(domain, curvature_degree)


def hinge(
    domain: mesh.Mesh,
    energy: FibreEnergy,
    scales: Scales,
    *,
    degree: int,
    quadrature_degree: int,
) -> Discretisation:
    """Discretise (31) or (16) with u in P(degree) alone; stable states are minima."""
    space = api.functionspace(domain, api.lagrange(degree, (2,), domain))
    u = fem.Function(space, name="state")
    F = energy.reference + ufl.grad(u)
    densities = (
        energy.displacement_densities(u)
        | energy.first_gradient_densities(F)
        | energy.second_gradient_densities(F)
    )
    dx, dS = (integration(kind, quadrature_degree) for kind in ("dx", "dS"))
    stored = {name: density * dx for name, density in densities.items()}
    stiffness = ufl.avg(hinge_stiffness(domain, degree - 2))
    n = ufl.FacetNormal(domain)
    kappas = energy.curvatures(F)
    stiff = [*stretching(energy, F, dx), *bending(energy, F, dx)]
    for family, K_b in energy.bending:
        D = energy.directions[family]
        a = fibre(F, D)
        J = angle_between(a("+"), a("-"))
        q = ufl.dot(D, n("+"))
        kappa = ufl.avg(kappas[family])
        closing = K_b * kappa * q * J + 0.5 * K_b * stiffness * (q * J) ** 2
        stored["bending"] += closing * dS
        rows = ((None, K_b * q), (K_b * q, K_b * stiffness * q**2))
        stiff.append(StiffEnergy((kappa, J), rows, dS))
    return Discretisation(
        state=u,
        fields=fields_of(space, {"displacement": scales.length}),
        functional=sum(stored.values()),
        stored=stored,
        stiff=tuple(stiff),
        energy=energy,
        densities=densities,
        displacement=u,
        bent_gradient=F,
        degree=degree,
        curvature_degree=degree - 2,
        quadrature_degree=quadrature_degree,
        scales=scales,
        near=_NEAR,
    )
