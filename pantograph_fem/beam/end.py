r"""Ends of a beam: held points, held directions and dead loads.

A clamp holds the direction φ of the beam but not its stretch, which no linear condition on the
gradient does. So it acts as a hinge whose turn J = φ - θ against the imposed direction θ is closed
by its own moment (Nitsche's method). With the moment m = K_b κ and the outward sign n = ±1 it adds

.. math:: -m\,n\,J + \frac{\eta K_b}{2h}\,J^2

to the stored energy, which vanishes with the mesh size. The clamp's moment is
:math:`\partial\Pi/\partial\theta = m n - \eta K_b J/h`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import ufl
from numpy.typing import NDArray

from mpi4py import MPI

from dolfinx import fem

from .. import dolfinx_api as api
from ..physics.kinematics import Expr, cross, direction_angle, fibre
from ..physics.reaction import Reaction
from ..physics.rigid_motion import RigidMotion
from ..schemes import Discretisation
from .domain import ENDS, Axis

Array = NDArray[np.float64]


@dataclass(frozen=True)
class EndConditions:
    """What holds, moves and loads an end.

    Attributes
    ----------
    name
        "left" or "right".
    held
        Components of the displacement that are held: 0 for x, 1 for y.
    clamp
        Whether the direction is held, too.
    motion
        Motion of what holds it, with the load factor.
    force, moment
        Dead loads at load factor 1, N and N m.
    """

    name: str
    held: tuple[int, ...]
    clamp: bool
    motion: RigidMotion
    force: tuple[float, float] = (0.0, 0.0)
    moment: float = 0.0


def hinge_penalty(auxiliary_degree: int) -> float:
    """η: twice what the trace inequality asks for.

    κ being of degree p - 1 on an element, κ² at its end is at most p²/h times its integral; so the
    hinge and the bending of the element are positive together for η > p².
    """
    return 2.0 * auxiliary_degree**2


class EndSupport:
    """One end. Implements :class:`pantograph_fem.continuum.support.Support`."""

    def __init__(
        self,
        conditions: EndConditions,
        discretisation: Discretisation,
        axis: Axis,
        penalty: float,
    ) -> None:
        self._conditions = conditions
        self._comm = axis.mesh.comm
        tag = ENDS.index(conditions.name)
        field = discretisation.field("displacement")
        assert field is not None  # every scheme has one
        blocks = field.blocks_on(axis.tags.find(tag))
        components = np.array(conditions.held, dtype=int)
        self.dofs = field.dofs[blocks][:, components].ravel()
        # The blocks of a process that does not see the end are none.
        self._held = np.tile(components, len(blocks))
        self._X = np.array([[axis.length * tag, 0.0]])

        measure = ufl.Measure("ds", domain=axis.mesh, subdomain_data=axis.tags)(tag)
        self._load = fem.Constant(axis.mesh, 0.0)
        self._direction = fem.Constant(axis.mesh, np.array([1.0, 0.0]))
        self.stored: dict[str, ufl.Form] = {}
        self.potential: ufl.Form | None = None
        self.pull: ufl.Form | None = None
        self._moment: fem.Form | None = None
        if conditions.clamp:
            self._clamp(discretisation, axis, measure, penalty)
        self._add_dead_loads(discretisation, axis, measure)

    def _clamp(
        self, discretisation: Discretisation, axis: Axis, ds: ufl.Measure, penalty: float
    ) -> None:
        energy = discretisation.energy
        ((_, K_b),) = energy.bending
        (kappa,) = discretisation.curvatures
        a, d = fibre(discretisation.bent_gradient, energy.directions[0]), self._direction
        J = api.atan2(cross(d, a), ufl.dot(d, a))
        n, h = ufl.FacetNormal(axis.mesh)[0], api.cell_size(axis.mesh)
        moment, stiffness = K_b * kappa * n, penalty * K_b / h
        self.stored["bending"] = (-moment * J + 0.5 * stiffness * J**2) * ds
        exerted = moment - stiffness * J
        self._moment = api.form(exerted * ds)
        if angle := self._conditions.motion.angle:
            self.pull = -fem.Constant(axis.mesh, angle) * exerted * ds

    def _add_dead_loads(self, discretisation: Discretisation, axis: Axis, ds: ufl.Measure) -> None:
        work: Expr | None = None
        if any(self._conditions.force):
            force = fem.Constant(axis.mesh, np.array(self._conditions.force))
            work = ufl.dot(force, discretisation.displacement)
        if self._conditions.moment:
            # Only its variation counts, so it does not matter that the angle jumps at ±π.
            (a,) = discretisation.energy.directions
            angle = direction_angle(fibre(discretisation.bent_gradient, a))
            turning = fem.Constant(axis.mesh, self._conditions.moment) * angle
            work = turning if work is None else work + turning
        if work is not None:
            self.potential = -self._load * work * ds
            self.pull = work * ds

    def values(self, load: float) -> Array:
        """Displacement of the held components, m."""
        return self._conditions.motion.displacement(self._X, load)[0, self._held]

    def rates(self, load: float) -> Array:
        """Its derivative with respect to the load factor."""
        return self._conditions.motion.displacement_rate(self._X, load)[0, self._held]

    def virtual_translation(self, direction: int) -> Array:
        """Unit translation along x (0) or y (1)."""
        return (self._held == direction).astype(float)

    def virtual_rotation(self, load: float) -> Array:
        """A point does not move when it turns about itself."""
        return np.zeros(len(self._held))

    def move(self, load: float) -> None:
        """Turn the clamp and raise the dead loads."""
        self._load.value = load
        self._direction.value[:] = self._conditions.motion.rotation(load)[:, 0]

    def exerted(self) -> Reaction:
        """Dead loads and the moment of the clamp; a collective call."""
        load = float(self._load.value)
        force, moment = self._conditions.force, load * self._conditions.moment
        if self._moment is not None:
            moment += self._comm.allreduce(fem.assemble_scalar(self._moment), MPI.SUM)
        return Reaction((load * force[0], load * force[1]), moment)
