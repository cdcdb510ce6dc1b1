"""What a scheme makes of an energy: fields, and a functional that is stationary at equilibrium."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import ufl

from dolfinx import fem, mesh

from ..physics.energy import FibreEnergy
from ..physics.kinematics import Expr, fibre
from .field import Field
from .stiff import StiffEnergy


@dataclass(frozen=True)
class Scales:
    """Sizes by which solvers measure the unknowns.

    Attributes
    ----------
    length
        Extent of the body, m.
    stiffness
        Largest stiffness, N/m of a sheet or N of a beam.
    dimension
        Dimension of the body: 2 for a sheet, 1 for a beam.
    softness
        Stiffness of what resists where fibres do not stretch, over that of their stretch.
    """

    length: float
    stiffness: float
    dimension: int
    softness: float = 1.0

    @classmethod
    def of(cls, length: float, dimension: int, stretch: float, others: float) -> Scales:
        """Scales of fibres that resist stretch, and of the largest of what else resists."""
        softness = others / stretch if stretch else 1.0
        return cls(length, max(stretch, others), dimension, softness)

    @property
    def energy(self) -> float:
        """Energy that goes with them, J."""
        return self.stiffness * self.length**self.dimension


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
    stored
        Stored energy of each effect as it is discretised, J.
    stiff
        The parts of it whose stresses a tangent extrapolates.
    energy
        The continuum energy that was discretised.
    densities
        Energy density of each effect, J/m² of a sheet or J/m of a beam.
    displacement
        Displacement as a function of the state, m.
    bent_gradient
        The placement gradient whose derivative is the curvature, shape (2, d); None where no
        effect sees curvature.
    degree
        Degree of the displacement.
    curvature_degree
        Degree of the curvatures, as far as they are polynomials.
    quadrature_degree
        Degree that is integrated exactly.
    scales
        Sizes by which solvers measure the unknowns.
    near
        Errors of the unknowns, in typical sizes, up to which the factor of an old tangent serves.
    """

    state: fem.Function
    fields: tuple[Field, ...]
    functional: ufl.Form
    stored: dict[str, ufl.Form]
    stiff: tuple[StiffEnergy, ...]
    energy: FibreEnergy
    densities: dict[str, Expr]
    displacement: Expr
    bent_gradient: Expr | None
    degree: int
    curvature_degree: int
    quadrature_degree: int
    scales: Scales
    near: float

    def field(self, name: str) -> Field | None:
        """The field of that name, or None where the scheme has no use for it."""
        return next((field for field in self.fields if field.name == name), None)

    @property
    def multiplier_dofs(self) -> int:
        """Negative pivots that a stable state has: one per multiplier dof."""
        return sum(field.size for field in self.fields if field.multiplier)

    @property
    def fibres(self) -> tuple[Expr, ...]:
        """Current vector of each fibre family, shape (2,)."""
        F = self.energy.reference + ufl.grad(self.displacement)
        return tuple(fibre(F, D) for D in self.energy.directions)

    @property
    def curvatures(self) -> tuple[Expr, ...]:
        """Curvature of each fibre family, 1/m; none where no effect sees them."""
        return () if self.bent_gradient is None else self.energy.curvatures(self.bent_gradient)

    def typical_sizes(self) -> np.ndarray:
        """Typical size of every local dof of the state, shape (dofs,), ghosts included."""
        sizes = np.empty_like(self.state.x.array)
        for field in self.fields:
            sizes[field.dofs.ravel()] = field.typical
        return sizes

    def unknowns(self) -> np.ndarray:
        """What every local dof of the state is, however it is numbered, shape (dofs, 3).

        A number for its component of its field, and the reference position of its node, m.
        """
        unknowns = np.empty((len(self.state.x.array), 3))
        components = [(field, dofs) for field in self.fields for dofs in field.dofs.T]
        for number, (field, dofs) in enumerate(components):
            unknowns[dofs, 0] = number
            unknowns[dofs, 1:] = field.coordinates
        return unknowns


def integration(
    kind: str,
    quadrature_degree: int,
    domain: mesh.Mesh | None = None,
    facets: mesh.MeshTags | None = None,
) -> ufl.Measure:
    """Measure "dx", "dS" or "ds" with a fixed quadrature degree.

    UFL's own estimate of the degree is absurdly high for (31).
    """
    metadata = {"quadrature_degree": quadrature_degree}
    return ufl.Measure(kind, domain=domain, subdomain_data=facets, metadata=metadata)
