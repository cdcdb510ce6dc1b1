"""Fields of a sheet that a user looks at."""

from __future__ import annotations

from ..continuum.observables import energy_observables
from ..physics.kinematics import Expr, shear_angle, stretch
from ..schemes import Discretisation


def sheet_observables(discretisation: Discretisation) -> dict[str, Expr]:
    """Scalar fields by name: rad, 1, 1/m and J/m²."""
    a1, a2 = discretisation.fibres
    shown = {
        "shear_angle": shear_angle(a1, a2),
        "stretch_1": stretch(a1),
        "stretch_2": stretch(a2),
    }
    shown.update({f"curvature_{i}": k for i, k in enumerate(discretisation.curvatures, 1)})
    return shown | energy_observables(discretisation)
