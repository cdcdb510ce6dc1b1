"""Fields of a beam that a user looks at."""

from __future__ import annotations

from ..continuum.observables import energy_observables
from ..physics.kinematics import Expr, stretch
from ..schemes import Discretisation

#: Names of the components of the current vector of the axis.
AXIS = ("axis_x", "axis_y")


def beam_observables(discretisation: Discretisation) -> dict[str, Expr]:
    """Scalar fields by name: 1, N, 1/m, N m and J/m.

    The axial force K_e(ρ - 1) acts along the current axis. The axis itself is there by its
    components :data:`AXIS`, of which means can be taken, as of angles they cannot.
    """
    energy = discretisation.energy
    (a,) = discretisation.fibres
    rho = stretch(a)
    shown = {"stretch": rho, AXIS[0]: a[0], AXIS[1]: a[1]}
    if energy.stretch:
        ((_, K_e),) = energy.stretch
        shown["axial_force"] = K_e * (rho - 1)
    if energy.bending:
        ((_, K_b),) = energy.bending
        (kappa,) = discretisation.curvatures
        shown |= {"curvature": kappa, "bending_moment": K_b * kappa}
    return shown | energy_observables(discretisation)
