r"""Kinematics of families of fibres that move in the plane, as pure UFL functions.

A fibre of family :math:`\alpha` has the unit reference direction :math:`\mathbf D_\alpha`; the
placement gradient :math:`\mathbf F = \nabla\boldsymbol\chi` takes it to
:math:`\mathbf a_\alpha = \mathbf F\mathbf D_\alpha`, shape (2,). A sheet has two families and F of
shape (2, 2); a beam is one fibre, D of shape (1,) and F of shape (2, 1).
"""

from __future__ import annotations

from typing import Any

import ufl

from ..dolfinx_api import atan2

Expr = Any  # UFL has no useful static types


def cross(a: Expr, b: Expr) -> Expr:
    """Out-of-plane component of a × b."""
    return a[0] * b[1] - a[1] * b[0]


def fibre(F: Expr, D: Expr) -> Expr:
    r"""Current fibre vector :math:`\mathbf a = \mathbf F\mathbf D`."""
    return ufl.dot(F, D)


def fibre_gradient(F: Expr, D: Expr) -> Expr:
    r"""Rate of the fibre vector along its own fibre.

    .. math:: \partial_D\mathbf a = (\nabla\mathbf F\,|\,\mathbf D\otimes\mathbf D)
    """
    return ufl.dot(ufl.grad(fibre(F, D)), D)


def stretch(a: Expr) -> Expr:
    r"""Fibre stretch :math:`\rho = \|\mathbf a\|`."""
    return ufl.sqrt(ufl.dot(a, a))


def curvature(a: Expr, da: Expr) -> Expr:
    r"""Rate of the direction angle φ of a fibre along the fibre, 1/m.

    .. math:: \kappa = \partial_D\varphi = \frac{\mathbf a\times\partial_D\mathbf a}{\rho^2}

    In the plane its square is exactly the bracket of (31), and of (16) for a beam.
    """
    return cross(a, da) / ufl.dot(a, a)


def angle_between(a: Expr, b: Expr) -> Expr:
    """Angle from a to b, in (-π, π]."""
    return atan2(cross(a, b), ufl.dot(a, b))


def direction_angle(a: Expr) -> Expr:
    """Angle φ from x to a fibre vector, in (-π, π]."""
    return atan2(a[1], a[0])


def shear_angle(a1: Expr, a2: Expr) -> Expr:
    r"""Decrease of the angle between the fibres from π/2, rad.

    .. math:: \psi = \frac{\pi}{2} - \angle(\mathbf a_1, \mathbf a_2)
        = \operatorname{atan2}(\mathbf a_1\cdot\mathbf a_2,\ \mathbf a_1\times\mathbf a_2)

    The value is that of the arccos of (31) with a sign, and it is smooth where the arccos is not.
    """
    return atan2(ufl.dot(a1, a2), cross(a1, a2))
