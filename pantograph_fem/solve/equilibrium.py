"""What path following needs of an equilibrium problem, and what it is told about states."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .cause import Cause
from .failure import Diagnosis, Remedies
from .origin import Origin

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Correction:
    """Outcome of a corrector: the state where it converged, why not where it did not.

    `residuals` holds the norm of the scaled residual before each step of the last attempt and
    after it.
    """

    load: float
    x: Array
    converged: bool
    iterations: int
    reason: str
    cause: Cause | None = None
    residuals: tuple[float, ...] = ()


@dataclass(frozen=True, eq=False)
class Mode:
    r"""An eigenvector of the tangent among the states that the constraints admit.

    Attributes
    ----------
    eigenvalue
        μ: the second variation of the energy along the mode, in typical energies, for a mean
        square displacement of one typical size.
    shape
        φ, shape of the states, SI units, with that mean square.
    load_share
        What the mode contributes to the work of the load along the path,
        :math:`(\varphi\cdot f)^2 / (\mu\, f\cdot x')`, with f the load rate. As μ tends to 0 it
        tends to 1 at a limit point, and to 0 at a bifurcation, where the load does not see the
        mode.
    """

    eigenvalue: float
    shape: Array
    load_share: float = 0.0


@dataclass(frozen=True)
class Linearisation:
    """A state, the tangent of the path there, and its inertia.

    `x` is the state given, corrected once more.
    `expected_negative_pivots` is what a stable state has; more of them, or zero pivots, mean
    that the energy is not at a minimum under the constraints.
    `lowest` is the mode of the lowest eigenvalue, where it was asked for and found.
    """

    x: Array
    rate: Array
    negative_pivots: int
    expected_negative_pivots: int
    zero_pivots: int
    lowest: Mode | None = None

    @property
    def stable(self) -> bool:
        """Whether the state is a strict minimum of the energy."""
        return self.zero_pivots == 0 and self.negative_pivots == self.expected_negative_pivots

    @property
    def unstable_modes(self) -> int:
        """Number of modes along which the energy does not rise; none of a stable state."""
        return abs(self.negative_pivots - self.expected_negative_pivots) + self.zero_pivots


@dataclass(frozen=True, eq=False)
class Plane:
    """The states and loads with ⟨normal, x - x₀⟩ + slope · (load - load₀) = 0.

    Attributes
    ----------
    x, load
        A point of the plane: x₀, shape of the states, and load₀.
    normal
        Shape of the states; its product is that of :meth:`ModalEquilibrium.inner`.
    slope
        The normal's part along the load.
    origin
        Where the point was extrapolated from.
    """

    x: Array
    load: float
    normal: Array
    slope: float
    origin: Origin | None = None


class Equilibrium(Protocol):
    """What continuation needs of a problem."""

    def correct(self, guess: Array, load: float) -> Correction:
        """Find the equilibrium near `guess`."""

    def linearise(self, x: Array, load: float) -> Linearisation:
        """Derivative of the path and inertia at an equilibrium."""


class ModalEquilibrium(Equilibrium, Protocol):
    """What is needed besides for critical points, branches, arcs and where a path is in trouble."""

    def analyse(self, x: Array, load: float, number: int = 1) -> tuple[Linearisation, Mode | None]:
        """As `linearise`, and the mode of an eigenvalue, if it was found; number 1 is the lowest.

        Of a state with n unstable modes, those up to number n are negative.
        """

    def correct_on_plane(self, plane: Plane) -> Correction:
        """Find the equilibrium on a plane, near its point, and its load."""

    def inner(self, a: Array, b: Array) -> float:
        """Mean product of the displacements of two states, in typical sizes."""

    @property
    def softest(self) -> int:
        """Level of the easiest problem that `correct_softly` can set out from; 0 is this one."""

    @property
    def remedies(self) -> Remedies:
        """What a user can change."""

    def correct_exactly(self, guess: Array, load: float) -> Correction:
        """As `correct`, with a line search that tries harder."""

    def correct_softly(self, guess: Array, load: float, level: int) -> Correction:
        """As `correct`, by way of easier problems from the one of a level down to this one."""

    def diagnose(self, last: Array, last_load: float, failed: Correction) -> Diagnosis:
        """What can be told about a failed correction and the last accepted state."""
