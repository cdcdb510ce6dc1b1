"""Fields of a beam that a user looks at."""

from __future__ import annotations

from ..continuum.observables import energy_observables
from ..physics.kinematics import Expr, direction_angle, stretch
from ..schemes import Discretisation


def beam_observables(discretisation: Discretisation) -> dict[str, Expr]:
    """Scalar fields by name: 1, rad, N, 1/m, N m and J/m.

    The axial force K_e(ρ - 1) acts along the current axis; the angle is in (-π, π].
    """
    energy = discretisation.energy
    (a,) = discretisation.fibres
    rho = stretch(a)
    shown = {"stretch": rho, "angle": direction_angle(a)}
    if energy.stretch:
        ((_, K_e),) = energy.stretch
        shown["axial_force"] = K_e * (rho - 1)
    if energy.bending:
        ((_, K_b),) = energy.bending
        (kappa,) = discretisation.curvatures
        shown |= {"curvature": kappa, "bending_moment": K_b * kappa}
    return shown | energy_observables(discretisation)
