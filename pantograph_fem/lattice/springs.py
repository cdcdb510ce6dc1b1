r"""Energies of single springs, with their first and second derivatives.

All functions are vectorised over springs.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Response(NamedTuple):
    """Energy (J) of springs and its derivatives with respect to what deforms them.

    That is a length (m), an angle (rad) or a displacement (m).
    """

    energy: Array
    first: Array
    second: Array


def extension(length: Array, rest: Array, k: Array) -> Response:
    r"""A link, first sums of (1) and (19): :math:`\tfrac12 k(\ell-\ell_0)^2`, k in N/m."""
    elongation = length - rest
    return Response(0.5 * k * elongation**2, k * elongation, k)


def turn(angle: Array, b: Array) -> Response:
    r"""Two links in a row, second sums of (1) and (19): :math:`b(\cos\vartheta+1)`, b in N m.

    The angle is the turn :math:`\theta = \pi - \vartheta` from the first link to the second one,
    so the energy is :math:`b(1-\cos\theta) = 2b\sin^2(\theta/2)`.
    """
    return Response(2.0 * b * np.sin(0.5 * angle) ** 2, b * np.sin(angle), b * np.cos(angle))


def quadratic_pivot(psi: Array, b3: Array) -> Response:
    r"""A pivot that is a linear spring, last sum of (19) with γ = 2: ½ b₃ ψ²; b₃ in N m."""
    return Response(0.5 * b3 * psi**2, b3 * psi, b3)


def pivot(psi: Array, b3: Array, gamma: float, delta: float) -> Response:
    r"""A pivot, last sum of (19): :math:`\tfrac12 b_3|\psi|^\gamma`, smoothed at ψ = 0.

    .. math:: \tfrac12 b_3\left[(\psi^2+\delta^2)^{\gamma/2} - \delta^\gamma\right],
        \qquad \psi = \tfrac\pi2 - \vartheta^3

    The smoothing is the sheet's: δ > 0 (rad) bounds the second derivative, which stays positive.
    """
    s = psi**2 + delta**2
    power = s ** (0.5 * gamma - 2.0)
    return Response(
        0.5 * b3 * (power * s**2 - delta**gamma),
        0.5 * gamma * b3 * power * s * psi,
        0.5 * gamma * b3 * power * (delta**2 + (gamma - 1.0) * psi**2),
    )


def ground(u: Array, k: Array) -> Response:
    r"""A Winkler foundation lumped at nodes: :math:`\tfrac12 k|u|^2`; u of shape (n, 2), k N/m.

    The derivatives are with respect to each component of u.
    """
    return Response(0.5 * k * (u**2).sum(axis=1), k[:, None] * u, k)
