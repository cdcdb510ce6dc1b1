"""A part of the boundary that is held, moved or loaded."""

from __future__ import annotations

from typing import Protocol

import numpy as np
import ufl
from numpy.typing import NDArray

from ..physics.reaction import Reaction
from ..schemes import StiffEnergy

Array = NDArray[np.float64]


class Support(Protocol):
    """Prescribed dofs, and what a support adds to the functional besides.

    Arrays over the held dofs have the order of `dofs`.

    Attributes
    ----------
    dofs
        Held dofs of the state, ghosts included.
    stored
        Terms of the stored energy that hold a direction weakly, by effect; J.
    stiff
        The parts of it whose stresses a tangent extrapolates.
    potential
        Potential of the dead loads, J; None without.
    pull
        Form -∂Π/∂load at fixed state, J; None where the functional does not depend on the load.
    """

    dofs: NDArray[np.int32]
    stored: dict[str, ufl.Form]
    stiff: list[StiffEnergy]
    potential: ufl.Form | None
    pull: ufl.Form | None

    def values(self, load: float) -> Array:
        """Prescribed values of the held dofs."""

    def rates(self, load: float) -> Array:
        """Derivatives of the values with respect to the load factor."""

    def virtual_translation(self, direction: int) -> Array:
        """Unit translation along x (0) or y (1): the residual's work on it is the force."""

    def virtual_rotation(self, load: float) -> Array:
        """Unit rotation about the current centre: the residual's work on it is the moment."""

    def move(self, load: float) -> None:
        """Give the coefficients of the forms their values at the load factor."""

    def exerted(self) -> Reaction:
        """What it exerts by the forms, beyond holding dofs; a collective call."""
