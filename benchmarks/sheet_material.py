r"""Energy (31) at a point of the sheet, with its first and second derivatives by hand.

Everything is a function of the fibre vectors :math:`\mathbf a_\alpha = \mathbf F\mathbf D_\alpha`
and of their rates along their own fibre :math:`\mathbf b_\alpha = \partial_\alpha\mathbf
a_\alpha`. Arrays have the components in front and the points behind, shape (2, ...), as in
scikit-fem. With R the quarter turn, the direction φ of a fibre has

.. math:: \nabla\varphi = \frac{R\mathbf a}{\rho^2}, \qquad
    \nabla\nabla\varphi = -\frac{R\mathbf a\otimes\mathbf a + \mathbf a\otimes R\mathbf a}{\rho^4}.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Response:
    """Energy density, shape (...), its gradient, (n, 2, ...), and Hessian, (n, 2, n, 2, ...).

    The n arguments are vectors; their order is that of the function that returns the response.
    """

    energy: Array
    gradient: Array
    hessian: Array


@dataclass(frozen=True)
class Material:
    r"""Constants of the bias extension test, cases/a_bias_extension.toml.

    Attributes
    ----------
    stretch, bending, shear
        K_e (N/m), K_b (N m) and K_p (N/m).
    exponent, regularisation
        γ and the angle δ (rad) below which :math:`|\psi|^\\gamma` is rounded off.
    """

    stretch: float = 1.34e5
    bending: float = 1.92e-2
    shear: float = 1.59e2
    exponent: float = 1.36
    regularisation: float = 1e-4

    def stretch_and_shear(self, a1: Array, a2: Array) -> Response:
        """First and third term of (31), as a function of a1 and a2."""
        K_p, gamma, delta = self.shear, self.exponent, self.regularisation
        psi = np.arctan2(_dot(a1, a2), _cross(a1, a2))
        s = psi**2 + delta**2
        slope = 0.5 * K_p * gamma * psi * s ** (gamma / 2 - 1)
        bend = 0.5 * K_p * gamma * (s + (gamma - 2) * psi**2) * s ** (gamma / 2 - 2)
        energy = 0.5 * K_p * (s ** (gamma / 2) - delta**gamma)
        gradient = np.empty((2, *a1.shape))
        turns = np.empty_like(gradient)
        hessian = np.empty((2, 2, *gradient.shape))
        for i, (a, sign) in enumerate(((a1, 1.0), (a2, -1.0))):
            rho = np.sqrt(_dot(a, a))
            e = a / rho
            turns[i] = sign * _turned(e) / rho
            energy = energy + 0.5 * self.stretch * (rho - 1.0) ** 2
            gradient[i] = self.stretch * (rho - 1.0) * e + slope * turns[i]
            turned = _outer(_turned(e), e)
            hessian[i, :, i] = (
                self.stretch * ((1.0 - 1.0 / rho) * _identity(a) + _outer(e, e) / rho)
                - slope * sign * (turned + turned.swapaxes(0, 1)) / rho**2
            )
        hessian[0, :, 1] = hessian[1, :, 0] = 0.0
        hessian += bend * turns[:, :, None, None] * turns[None, None]
        return Response(energy, gradient, hessian)

    def bending_of(self, a: Array, b: Array) -> Response:
        r"""Second term of (31) of one family, ½ K_b κ², as a function of a and b.

        .. math:: \kappa = \frac{\mathbf a\times\mathbf b}{\rho^2}
        """
        square = _dot(a, a)
        kappa = _cross(a, b) / square
        Ra, Rb = _turned(a) / square, _turned(b) / square
        c = a / square
        rate = np.stack([-Rb - 2.0 * kappa * c, Ra])
        second = np.zeros((2, 2, *rate.shape))
        mixed = _outer(Rb, c)
        second[0, :, 0] = (
            2.0 * (mixed + mixed.swapaxes(0, 1))
            + 8.0 * kappa * _outer(c, c)
            - 2.0 * kappa / square * _identity(a)
        )
        # ∂²κ/∂a∂b: R transposed, as the row belongs to a
        second[0, :, 1] = -_turn_matrix(a) / square - 2.0 * _outer(c, Ra)
        second[1, :, 0] = second[0, :, 1].swapaxes(0, 1)
        hessian = rate[:, :, None, None] * rate[None, None] + kappa * second
        K_b = self.bending
        return Response(0.5 * K_b * kappa**2, K_b * kappa * rate, K_b * hessian)


def _dot(a: Array, b: Array) -> Array:
    return a[0] * b[0] + a[1] * b[1]


def _cross(a: Array, b: Array) -> Array:
    return a[0] * b[1] - a[1] * b[0]


def _turned(a: Array) -> Array:
    return np.stack([-a[1], a[0]])


def _outer(a: Array, b: Array) -> Array:
    return a[:, None] * b[None]


def _identity(a: Array) -> Array:
    return np.eye(2).reshape(2, 2, *(1,) * (a.ndim - 1))


def _turn_matrix(a: Array) -> Array:
    return np.array([[0.0, -1.0], [1.0, 0.0]]).reshape(2, 2, *(1,) * (a.ndim - 1))
