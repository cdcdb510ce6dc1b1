r"""Energy densities of (31) and (16), and their sum over the effects that a sheet or beam has.

A beam is one family of fibres in one dimension: its densities are per reference length, J/m, those
of a sheet per reference area, J/m².
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import ufl

from .kinematics import Expr, curvature, fibre, fibre_gradient, shear_angle, stretch


def stretch_density(rho: Expr, K_e: Expr) -> Expr:
    r"""Stretching of a fibre family, first term of (31) and (16): ½ K_e (ρ - 1)²."""
    return 0.5 * K_e * (rho - 1) ** 2


def bending_density(kappa: Expr, K_b: Expr) -> Expr:
    r"""Bending of a fibre family, second term of (31) and (16): ½ K_b κ²."""
    return 0.5 * K_b * kappa**2


def quadratic_shear_density(psi: Expr, K_p: Expr) -> Expr:
    r"""Pivots that are linear springs, third term of (31) with γ = 2: ½ K_p ψ²."""
    return 0.5 * K_p * psi**2


def shear_density(psi: Expr, K_p: Expr, gamma: Expr, delta: Expr) -> Expr:
    r"""Pivots, third term of (31): :math:`\tfrac12 K_p|\psi|^\gamma`, smoothed at ψ = 0.

    .. math:: \tfrac12 K_p\left[(\psi^2+\delta^2)^{\gamma/2} - \delta^\gamma\right]

    For 1 < γ < 2 the tangent of :math:`|\psi|^\gamma` is infinite in the undeformed state; δ > 0
    (rad) bounds it by :math:`\tfrac12\gamma K_p\delta^{\gamma-2}`.
    """
    return 0.5 * K_p * ((psi**2 + delta**2) ** (gamma / 2) - delta**gamma)


def foundation_density(u: Expr, K_w: Expr) -> Expr:
    r"""Winkler springs that hold a beam in both directions, §3.1: ½ K_w ‖u‖²."""
    return 0.5 * K_w * ufl.dot(u, u)


@dataclass(frozen=True)
class FibreEnergy:
    """Energy (31) of a sheet or (16) of a beam as a sum of the effects that have a stiffness.

    With d the dimension of the reference configuration, 2 or 1:

    Attributes
    ----------
    reference
        Gradient of the reference placement, shape (2, d).
    directions
        Unit reference direction of each family, shape (d,).
    stretch, bending
        (family index, stiffness) of each family that has one; N/m and N m for a sheet, N and
        N m² for a beam.
    shear
        Stiffness of the pivots, N/m, or None.
    exponent, regularisation
        γ and δ of the pivots; None where γ = 2, which needs neither.
    foundation
        Stiffness of the foundation, N/m² for a beam, or None.
    """

    reference: Expr
    directions: tuple[Expr, ...]
    stretch: tuple[tuple[int, Expr], ...] = ()
    bending: tuple[tuple[int, Expr], ...] = ()
    shear: Expr | None = None
    exponent: Expr | None = None
    regularisation: Expr | None = None
    foundation: Expr | None = None

    @property
    def second_gradient(self) -> bool:
        """Whether the energy depends on ∇F, by bending."""
        return bool(self.bending)

    def displacement_densities(self, u: Expr) -> dict[str, Expr]:
        """Density of the foundation, by name of the effect; u has shape (2,)."""
        return (
            {}
            if self.foundation is None
            else {"foundation": foundation_density(u, self.foundation)}
        )

    def first_gradient_densities(self, F: Expr) -> dict[str, Expr]:
        """Densities of stretch and shear, by name of the effect; F has shape (2, d)."""
        densities: dict[str, Expr] = {}
        if self.stretch:
            densities["stretch"] = sum(
                stretch_density(stretch(fibre(F, self.directions[family])), K_e)
                for family, K_e in self.stretch
            )
        if self.shear is not None:
            psi = shear_angle(*(fibre(F, D) for D in self.directions))
            densities["shear"] = (
                quadratic_shear_density(psi, self.shear)
                if self.exponent is None
                else shear_density(psi, self.shear, self.exponent, self.regularisation)
            )
        return densities

    def second_gradient_densities(self, F: Expr) -> dict[str, Expr]:
        """Density of bending; F has shape (2, d) and a gradient that is square integrable."""
        if not self.bending:
            return {}
        kappas = self.curvatures(F)
        return {
            "bending": sum(bending_density(kappas[family], K_b) for family, K_b in self.bending)
        }

    def curvatures(self, F: Expr) -> tuple[Expr, ...]:
        """Curvature of each family, 1/m."""
        return tuple(curvature(fibre(F, D), fibre_gradient(F, D)) for D in self.directions)


def sheet_energy(
    *,
    constant: Callable[[float], Expr],
    fibre_angle: float,
    stretch: tuple[float, float] | None = None,
    bending: tuple[float, float] | None = None,
    shear: float | None = None,
    exponent: float = 2.0,
    regularisation: float = 1e-4,
) -> FibreEnergy:
    """Energy (31) from numbers; an effect that is None or has no stiffness is left out.

    `constant` makes a coefficient of a number, so that another number needs no other form.
    `fibre_angle` (rad) is the angle from x to D1; D2 is a quarter turn ahead of D1.
    """
    c, s = constant(math.cos(fibre_angle)), constant(math.sin(fibre_angle))
    power = bool(shear) and exponent != 2.0

    def families(stiffness: tuple[float, float] | None) -> tuple[tuple[int, Expr], ...]:
        return tuple((family, constant(K)) for family, K in enumerate(stiffness or ()) if K)

    return FibreEnergy(
        reference=ufl.Identity(2),
        directions=(ufl.as_vector((c, s)), ufl.as_vector((-s, c))),
        stretch=families(stretch),
        bending=families(bending),
        shear=constant(shear) if shear else None,
        exponent=constant(exponent) if power else None,
        regularisation=constant(regularisation) if power else None,
    )


def beam_energy(
    *,
    constant: Callable[[float], Expr],
    stretch: float | None = None,
    bending: float | None = None,
    foundation: Expr | None = None,
) -> FibreEnergy:
    """Energy (16) of a beam along x from numbers; an effect that is None or 0 is left out.

    `foundation` (N/m²) may vary along the beam.
    """
    return FibreEnergy(
        reference=ufl.as_matrix(((1.0,), (0.0,))),
        directions=(ufl.as_vector((1.0,)),),
        stretch=((0, constant(stretch)),) if stretch else (),
        bending=((0, constant(bending)),) if bending else (),
        foundation=foundation,
    )
