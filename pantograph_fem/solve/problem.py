"""What the solver needs of a discrete equilibrium problem, whatever is in equilibrium."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from petsc4py import PETSc

from .failure import Remedies
from .origin import Origin

Array = NDArray[np.float64]


class Problem(Protocol):
    """A potential with a load factor, of which an equilibrium is a stationary point.

    States are arrays of the unknowns that this process owns, in SI units. Some unknowns are held:
    the load factor prescribes them. Every method is collective.
    """

    @property
    def typical_sizes(self) -> Array:
        """Typical size of each owned unknown."""

    @property
    def typical_energy(self) -> float:
        """Typical energy, J."""

    @property
    def expected_negative_pivots(self) -> int:
        """Negative eigenvalues of the tangent at a stable state."""

    @property
    def has_minima(self) -> bool:
        """Whether the stable states are minima of :meth:`potential`."""

    @property
    def near(self) -> float:
        """Errors, in typical sizes, up to which the factor of an old tangent serves."""

    def matrix(self) -> PETSc.Mat:
        """An empty matrix for the tangent."""

    def impose(self, x: Array, load: float) -> Array:
        """A copy of x with the held unknowns where they are at the load factor."""

    def potential(self, x: Array, load: float) -> float:
        """What is stationary at equilibrium, J; asked for where it `has_minima`."""

    def residual(self, x: Array, load: float, r: PETSc.Vec) -> None:
        """Gradient of the potential; zero at the held unknowns, whose values x must have."""

    def tangent(self, x: Array, load: float, A: PETSc.Mat, origin: Origin | None = None) -> None:
        """Derivative of the residual; rows and columns of held unknowns are the identity's.

        `origin` tells where an iterate was extrapolated from, for tangents that converge faster
        if they know; at a solution they must be the derivative.
        """

    def load_rate(self, x: Array, load: float) -> Array:
        """Right side whose solution with the tangent assembled last is dx/dload along the path."""

    def lift(self, x: Array, load: float, shift: Array) -> Array:
        """Right side whose solution with that tangent follows a shift of the held unknowns.

        `shift` has the shape of x; what it has for free unknowns does not count.
        """

    def objection(self, x: Array, load: float) -> str:
        """Why an equilibrium is not acceptable all the same; empty where it is."""

    @property
    def softest(self) -> int:
        """Level of the easiest problem that :meth:`soften` makes of this one; 0 if it makes none.

        The problems of the levels lead to this one, which is level 0.
        """

    def soften(self, level: int) -> None:
        """Be the problem of a level from now on."""

    @property
    def remedies(self) -> Remedies:
        """What a user can change about the problem."""

    def locate(self, unknown: int) -> str:
        """What an owned unknown is and where, as "displacement at (0, 0.1) m"; not collective."""
