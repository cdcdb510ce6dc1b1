"""What a scheme makes of an energy: fields, and a functional that is stationary at equilibrium."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import ufl

from dolfinx import fem

from ..physics.energy import SheetEnergy
from ..physics.kinematics import Expr, fibre, shear_angle, stretch
from .field import Field


@dataclass(frozen=True)
class Scales:
    """Sizes by which solvers measure the unknowns: a length (m) and a stiffness (N/m)."""

    length: float
    stiffness: float

    @property
    def energy(self) -> float:
        """Energy that goes with them, J."""
        return self.stiffness * self.length**2


@dataclass(frozen=True)
class Discretisation:
    """A discrete equilibrium problem without its boundary conditions.

    Attributes
    ----------
    state
        All unknowns in one function.
    fields
        The unknown fields.
    functional
        Form whose first variation vanishes at equilibrium, J.
    energy
        The continuum energy that was discretised.
    densities
        Energy density of each effect, J/m².
    displacement
        Displacement as a function of the state, m.
    curvatures
        Fibre curvatures as functions of the state, 1/m; None where no effect sees them.
    measure
        Integration measure, with its quadrature degree.
    scales
        Sizes by which solvers measure the unknowns.
    """

    state: fem.Function
    fields: tuple[Field, ...]
    functional: ufl.Form
    energy: SheetEnergy
    densities: dict[str, Expr]
    displacement: Expr
    curvatures: tuple[Expr, Expr] | None
    measure: ufl.Measure
    scales: Scales

    def field(self, name: str) -> Field | None:
        """The field of that name, or None where the scheme has no use for it."""
        return next((field for field in self.fields if field.name == name), None)

    @property
    def multiplier_dofs(self) -> int:
        """Negative pivots that a stable state has: one per multiplier dof."""
        return sum(field.size for field in self.fields if field.multiplier)

    def observables(self) -> dict[str, Expr]:
        """Fields that a user looks at, by name; scalars, in SI units."""
        F = ufl.Identity(2) + ufl.grad(self.displacement)
        a1, a2 = (fibre(F, D) for D in self.energy.directions)
        shown = {
            "shear_angle": shear_angle(a1, a2),
            "stretch_1": stretch(a1),
            "stretch_2": stretch(a2),
        }
        if self.curvatures is not None:
            shown["curvature_1"], shown["curvature_2"] = self.curvatures
        shown["energy_density"] = sum(self.densities.values())
        shown.update({f"energy_density_{name}": w for name, w in self.densities.items()})
        return shown

    def typical_sizes(self) -> np.ndarray:
        """Typical size of every local dof of the state, shape (dofs,), ghosts included."""
        sizes = np.empty_like(self.state.x.array)
        for field in self.fields:
            sizes[field.dofs.ravel()] = field.typical
        return sizes


def integration(quadrature_degree: int) -> ufl.Measure:
    """Measure with a fixed quadrature degree: UFL's own estimate for (31) is absurdly high."""
    return ufl.Measure("dx", metadata={"quadrature_degree": quadrature_degree})
