"""Grips: boundary edges that move as rigid bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import ufl
from numpy.typing import NDArray

from dolfinx import mesh

from ..continuum.held_directions import HeldDirections
from ..physics.reaction import NO_REACTION, Reaction
from ..physics.rigid_motion import QUARTER_TURN, RigidMotion
from ..schemes import Discretisation, StiffEnergy

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Grip:
    """One grip.

    Attributes
    ----------
    tags, tag
        The edges of all grips, and the number of those that this one holds.
    motion
        Its motion with the load factor.
    clamp
        Whether it holds the placement gradient as well as the position.
    centre
        Middle of the held edges in the reference, m; moments are taken about its current place.
    """

    tags: mesh.MeshTags
    tag: int
    motion: RigidMotion
    clamp: bool
    centre: tuple[float, float]


class GripSupport:
    """A grip by the dofs that it holds; a clamp holds the auxiliary gradient, or directions weakly.

    Implements :class:`pantograph_fem.continuum.support.Support`.
    """

    potential: ufl.Form | None = None

    def __init__(self, grip: Grip, discretisation: Discretisation) -> None:
        self._motion = grip.motion
        self._centre = np.array([grip.centre])
        displacement = discretisation.field("displacement")
        assert displacement is not None  # every scheme has one
        facets = grip.tags.find(grip.tag)
        blocks = displacement.blocks_on(facets)
        self._X = displacement.coordinates[blocks]
        dofs = [displacement.dofs[blocks]]
        self._gradients = 0
        gradient = discretisation.field("gradient")
        self._directions: HeldDirections | None = None
        self.stored: dict[str, ufl.Form] = {}
        self.stiff: list[StiffEnergy] = []
        self.pull: ufl.Form | None = None
        if grip.clamp and gradient is not None:
            blocks = gradient.blocks_on(facets)
            dofs.append(gradient.dofs[blocks])
            self._gradients = len(blocks)
        elif grip.clamp:
            self._directions = HeldDirections(discretisation, grip.tags, grip.tag, grip.motion)
            self.stored["bending"] = self._directions.stored
            self.stiff = self._directions.stiff
            self.pull = self._directions.pull
        self.dofs = np.concatenate([part.ravel() for part in dofs])

    def values(self, load: float) -> Array:
        """Prescribed values: u, and H = R - I where the gradient is held."""
        return self._collect(
            self._motion.displacement(self._X, load), self._motion.rotation(load) - np.eye(2)
        )

    def rates(self, load: float) -> Array:
        """Derivatives of the values with respect to the load factor."""
        return self._collect(
            self._motion.displacement_rate(self._X, load), self._motion.rotation_rate(load)
        )

    def virtual_translation(self, direction: int) -> Array:
        """Unit translation of the grip along x (0) or y (1): its work is the force."""
        v = np.zeros_like(self._X)
        v[:, direction] = 1.0
        return self._collect(v, np.zeros((2, 2)))

    def virtual_rotation(self, load: float) -> Array:
        """Unit rotation about the grip's current centre: its work is the moment."""
        x = self._X + self._motion.displacement(self._X, load)
        centre = self._centre + self._motion.displacement(self._centre, load)
        return self._collect(
            (x - centre) @ QUARTER_TURN.T, QUARTER_TURN @ self._motion.rotation(load)
        )

    def move(self, load: float) -> None:
        """Turn the held directions."""
        if self._directions is not None:
            self._directions.move(load)

    def exerted(self) -> Reaction:
        """The couple on held directions; a collective call."""
        if self._directions is None:
            return NO_REACTION
        return Reaction((0.0, 0.0), self._directions.moment())

    def _collect(self, displacements: Array, gradient: Array) -> Array:
        return np.concatenate([displacements.ravel(), np.tile(gradient.ravel(), self._gradients)])
