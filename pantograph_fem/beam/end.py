"""Ends of a beam: held points, held directions and dead loads."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import ufl
from numpy.typing import NDArray

from dolfinx import fem

from ..continuum.held_directions import HeldDirections
from ..physics.kinematics import Expr, direction_angle, fibre
from ..physics.reaction import Reaction
from ..physics.rigid_motion import RigidMotion
from ..schemes import Discretisation, StiffEnergy
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


class EndSupport:
    """One end. Implements :class:`pantograph_fem.continuum.support.Support`."""

    def __init__(
        self,
        conditions: EndConditions,
        discretisation: Discretisation,
        axis: Axis,
    ) -> None:
        self._conditions = conditions
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
        self.stored: dict[str, ufl.Form] = {}
        self.stiff: list[StiffEnergy] = []
        self.potential: ufl.Form | None = None
        self.pull: ufl.Form | None = None
        self._direction: HeldDirections | None = None
        if conditions.clamp:
            self._direction = HeldDirections(discretisation, axis.tags, tag, conditions.motion)
            self.stored["bending"] = self._direction.stored
            self.stiff = self._direction.stiff
            self.pull = self._direction.pull
        self._add_dead_loads(discretisation, axis, measure)

    def _add_dead_loads(self, discretisation: Discretisation, axis: Axis, ds: ufl.Measure) -> None:
        work: Expr | None = None
        if any(self._conditions.force):
            force = fem.Constant(axis.mesh, np.array(self._conditions.force))
            work = ufl.dot(force, discretisation.displacement)
        if self._conditions.moment:
            # Only its variation counts, so it does not matter that the angle jumps at ±π.
            (D,) = discretisation.energy.directions
            angle = direction_angle(fibre(discretisation.bent_gradient, D))
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
        if self._direction is not None:
            self._direction.move(load)

    def exerted(self) -> Reaction:
        """Dead loads and the moment of the clamp; a collective call."""
        load = float(self._load.value)
        force, moment = self._conditions.force, load * self._conditions.moment
        if self._direction is not None:
            moment += self._direction.moment()
        return Reaction((load * force[0], load * force[1]), moment)
