r"""Energy (31) with the displacement alone, and with the auxiliary gradient of the paper.

Slots of both have the fibres' derivatives of the displacement, :math:`\partial_\alpha\mathbf u =
\mathbf a_\alpha - \mathbf D_\alpha`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from discretised_energy import Array, Density, DiscretisedEnergy, Operator, VectorField
from sheet_material import Material
from skfem import Basis, Element, ElementTriP1, ElementTriP2, ElementTriP3, Mesh

#: Directions of the two families.
DIRECTIONS = np.array([[1.0, 1.0], [-1.0, 1.0]]) * np.sqrt(0.5)
#: c of the term that gives wrinkles of u their bending stiffness, as in pantograph_fem.
GAP_STIFFNESS = 4.0
#: Continuous elements by their degree.
LAGRANGE = {1: ElementTriP1(), 2: ElementTriP2(), 3: ElementTriP3()}


def c1_scheme(
    mesh: Mesh, material: Material, element: Element, order: int, *, forms: bool
) -> DiscretisedEnergy:
    """Displacement alone, in elements with a continuous gradient; order of the quadrature."""
    basis = Basis(mesh, element, intorder=order)
    field = VectorField(basis, (_along(0), _twice_along(0), _along(1), _twice_along(1)))

    def density(values: Array) -> Density:
        a = [values[2 * i] + _direction(i) for i in range(2)]
        terms = [((0, 2), material.stretch_and_shear(*a))]
        terms += [
            ((2 * i, 2 * i + 1), material.bending_of(a[i], values[2 * i + 1])) for i in (0, 1)
        ]
        return _sum(terms, values)

    return DiscretisedEnergy([field], density, forms=forms)


def micromorphic_scheme(
    mesh: Mesh, material: Material, degree: int, order: int, *, forms: bool
) -> DiscretisedEnergy:
    r"""The paper's: u in P(degree), the auxiliary gradient H and its multiplier in one degree less.

    H and the multiplier are taken along the fibres, :math:`\mathbf h_\alpha = \mathbf H\mathbf
    D_\alpha`.

    .. math:: W_1(\nabla\mathbf u) + W_2(\mathbf h_\alpha, \partial_\alpha\mathbf h_\alpha)
        + \sum_\alpha \boldsymbol\lambda_\alpha\cdot\mathbf g_\alpha
        + \frac{c K_b}{2h^2}\|\mathbf g_\alpha\|^2,
        \quad \mathbf g_\alpha = \partial_\alpha\mathbf u - \mathbf h_\alpha
    """
    basis = Basis(mesh, LAGRANGE[degree], intorder=order)
    tensors = Basis(mesh, LAGRANGE[degree - 1], quadrature=basis.quadrature)
    fields = [VectorField(basis, (_along(0), _along(1)))]
    fields += [VectorField(tensors, (np.asarray, _along(i))) for i in range(2)]
    fields += [VectorField(tensors, (np.asarray,)) for _ in range(2)]
    penalty = GAP_STIFFNESS * material.bending / _cell_size(mesh)[:, None] ** 2
    identity = np.eye(2)[..., None, None]

    def density(values: Array) -> Density:
        terms = [((0, 1), material.stretch_and_shear(*(values[i] + _direction(i) for i in (0, 1))))]
        for i in range(2):
            h, dh = 2 + 2 * i, 3 + 2 * i
            terms.append(((h, dh), material.bending_of(values[h] + _direction(i), values[dh])))
        total = _sum(terms, values)
        energy, gradient, hessian = total.energy, total.gradient, dict(total.hessian)
        one = np.broadcast_to(identity, (2, 2, *energy.shape))
        for i in range(2):
            h, m = 2 + 2 * i, 6 + i
            gap = values[i] - values[h]
            force = values[m] + penalty * gap
            energy = energy + ((values[m] + 0.5 * penalty * gap) * gap).sum(axis=0)
            gradient[i] += force
            gradient[h] -= force
            gradient[m] += gap
            for s, t, factor in ((i, i, penalty), (h, h, penalty), (i, h, -penalty)):
                hessian[s, t] = hessian.get((s, t), 0.0) + factor * one
            hessian[i, m], hessian[h, m] = one, -one
        return Density(energy, gradient, hessian)

    return DiscretisedEnergy(fields, density, forms=forms)


def _sum(terms: Any, values: Array) -> Density:
    gradient, hessian = np.zeros_like(values), {}
    for slots, response in terms:
        for i, s in enumerate(slots):
            gradient[s] += response.gradient[i]
            for j, t in enumerate(slots):
                hessian[s, t] = hessian.get((s, t), 0.0) + response.hessian[i, :, j]
    return Density(sum(response.energy for _, response in terms), gradient, hessian)


def _direction(family: int) -> Array:
    return DIRECTIONS[family][:, None, None]


def _along(family: int) -> Operator:
    x, y = DIRECTIONS[family]
    return lambda N: x * N.grad[0] + y * N.grad[1]


def _twice_along(family: int) -> Operator:
    x, y = DIRECTIONS[family]
    return lambda N: x * x * N.hess[0, 0] + 2 * x * y * N.hess[0, 1] + y * y * N.hess[1, 1]


def _cell_size(mesh: Mesh) -> Array:
    """Longest side of each triangle."""
    p = mesh.p[:, mesh.t]
    return np.sqrt(((p - np.roll(p, 1, axis=1)) ** 2).sum(axis=0).max(axis=0))
