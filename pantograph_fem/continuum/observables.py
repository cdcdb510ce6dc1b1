"""Fields that a user looks at, whatever the continuum."""

from __future__ import annotations

from ..physics.kinematics import Expr
from ..schemes import Discretisation


def energy_observables(discretisation: Discretisation) -> dict[str, Expr]:
    """Energy density, and that of each effect, J/m² of a sheet or J/m of a beam."""
    densities = discretisation.densities
    shown = {"energy_density": sum(densities.values())}
    return shown | {f"energy_density_{name}": w for name, w in densities.items()}
