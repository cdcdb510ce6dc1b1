"""An equilibrium problem as path following sees it: it corrects guesses and linearises states."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from mpi4py import MPI

from ..stopwatch import Stopwatch
from .bordered import BorderedNewton
from .corrector import Corrector
from .diagnosis import diagnose
from .eigenvalue import ModesNearZero, place_of
from .equilibrium import Array, Correction, Linearisation, Mode, Plane
from .factorisation import Inertia
from .failure import Diagnosis, Remedies
from .memory import clean_up, destroy_with
from .metric import Metric
from .newton import NewtonSolver
from .newton_settings import NewtonSettings
from .origin import Origin
from .problem import Problem

#: Held unknowns that are less than this off, in typical sizes, are in place.
_IN_PLACE = 1e-13

#: By number; number 1 is that of the lowest eigenvalue.
_Modes = dict[int, Mode | None]


@dataclass(frozen=True, eq=False)
class _Trusted:
    """The state that was linearised last: as it was factorised, and as it was corrected then."""

    load: float
    factorised: Array
    x: Array
    rate: Array


class NewtonPath:
    """Implements :class:`pantograph_fem.solve.equilibrium.ModalEquilibrium` by Newton's method."""

    def __init__(
        self,
        problem: Problem,
        settings: NewtonSettings,
        clock: Stopwatch,
        weights: Callable[[], Array] | None = None,
        eigenvalues: bool = False,
    ) -> None:
        """Set up the solver.

        Parameters
        ----------
        problem, settings, clock
            What is solved, when iterations stop and where their time is counted.
        weights
            Makes the share of each owned unknown in the mean square of a displacement, 0 for what
            is no displacement, once it is needed; the same for all by default.
        eigenvalues
            Whether `linearise` finds the lowest mode at every state.
        """
        self._problem = problem
        self._clock = clock
        self._weights = weights
        self._always = {1} if eigenvalues else set()
        self._load = 0.0
        self._trusted: _Trusted | None = None
        self._at_hand = False  # the factor of that state
        self._matrix = problem.matrix()
        destroy_with(self, self._matrix)
        self._newton = NewtonSolver(
            lambda x, r: problem.residual(x, self._load, r),
            lambda x, A, origin: problem.tangent(x, self._load, A, origin),
            self._matrix,
            problem.typical_sizes,
            problem.typical_energy,
            replace(settings, near=problem.near),
            self._potential if problem.has_minima else None,
        )
        self._corrector = Corrector(problem, self._newton, self._set_load)

    def correct(self, guess: Array, load: float, origin: Origin | None = None) -> Correction:
        """Newton's method from the guess, with the held unknowns put in place.

        The free ones follow these along the tangent that was linearised last. The guess is from
        `origin`; by default from the state that was linearised last.
        """
        with self._clock("solve"):
            placed = self._placed(guess, load)
            return self._corrector.correct(placed, load, origin or self._origin(load))

    def correct_exactly(self, guess: Array, load: float) -> Correction:
        """As :meth:`correct`, with steps as long as makes the residual smallest."""
        with self._clock("solve"):
            placed = self._placed(guess, load)
            return self._corrector.correct(placed, load, self._origin(load), exactly=True)

    def correct_softly(self, guess: Array, load: float, level: int) -> Correction:
        """As :meth:`correct`, by way of easier problems from that of a level down to this one."""
        with self._clock("solve"):
            placed = self._placed(guess, load)
            return self._corrector.correct_softly(placed, load, self._origin(load), level)

    @property
    def softest(self) -> int:
        """Level of the easiest problem for that; 0 is this one."""
        return self._problem.softest

    @property
    def remedies(self) -> Remedies:
        """What a user can change."""
        return self._problem.remedies

    def diagnose(self, last: Array, last_load: float, failed: Correction) -> Diagnosis:
        """What can be told about a failed correction and the last accepted state."""
        with self._clock("solve"):
            return diagnose(
                self._problem, self._newton, self._modes, self._set_load, (last, last_load), failed
            )

    def correct_on_plane(self, plane: Plane) -> Correction:
        """Newton's method for the state and its load, from the point of the plane."""
        with self._clock("solve"):
            placed = self._placed(plane.x, plane.load)
            return self._bordered.solve(plane, placed)

    def linearise(self, x: Array, load: float) -> Linearisation:
        """Factorise the tangent at an accepted state: its inertia, and the path's direction.

        The factor, being at hand, corrects the state once more: forces, which are differences of
        large ones in places, gain more digits than the state had.
        """
        return self._linearise(x, load, self._always)[0]

    def back_substitute(self, forces: Array) -> Array:
        """Solve (tangent at the state linearised last) y = forces; SI units."""
        with self._clock("solve"):
            return self._newton.back_substitute(forces)

    def analyse(self, x: Array, load: float, number: int = 1) -> tuple[Linearisation, Mode | None]:
        """As :meth:`linearise`, and the mode of an eigenvalue; number 1 is the lowest."""
        linearisation, modes = self._linearise(x, load, {number} | self._always)
        return linearisation, modes[number]

    def inner(self, a: Array, b: Array) -> float:
        """Mean product of the displacements of two states, in typical sizes."""
        return self._metric.inner(a, b)

    def _linearise(self, x: Array, load: float, numbers: set[int]) -> tuple[Linearisation, _Modes]:
        self._load, self._at_hand, factorised = load, False, x
        with self._clock("solve"):
            inertia = self._newton.factorise(x).inertia
            # Of the very state whose factor it is: small elements resist strain and yield to
            # motion, so that the least difference of the two states would be magnified.
            force = self._problem.load_rate(x, load)
            rate = self._newton.back_substitute(force)
            x = x + self._newton.correction(x)
            modes = {n: self._mode(n, inertia, force, rate) for n in sorted(numbers)}
        clean_up(self._matrix)
        self._trusted, self._at_hand = _Trusted(load, factorised, x, rate), True
        linearisation = Linearisation(
            x=x,
            rate=rate,
            negative_pivots=inertia.negative,
            expected_negative_pivots=self._problem.expected_negative_pivots,
            zero_pivots=inertia.zero,
            lowest=modes.get(1),
        )
        return linearisation, modes

    def _mode(self, number: int, inertia: Inertia, force: Array, rate: Array) -> Mode | None:
        """A mode of the state that was factorised last."""
        negative = max(inertia.negative - self._problem.expected_negative_pivots, 0)
        found = self._modes.find(place_of(number, negative, inertia.zero))
        if found is None:
            return None
        eigenvalue, phi = found
        shape = phi * self._problem.typical_sizes
        free = self._metric.free
        work, response = (self._sum(force[free] * y[free]) for y in (shape, rate))
        stiffness = eigenvalue * self._problem.typical_energy * response
        return Mode(eigenvalue, shape, work**2 / stiffness if stiffness else 0.0)

    def _sum(self, products: Array) -> float:
        return self._comm.allreduce(float(np.sum(products)), MPI.SUM)

    def _potential(self, x: Array) -> float:
        return self._problem.potential(x, self._load)

    def _placed(self, guess: Array, load: float) -> Array:
        """The guess with the held unknowns in place, and the free ones moved along with them.

        What is held moves on curves, which no predictor follows exactly. Left alone at the edge of
        what is held, small elements would be strained by all that is missing.
        """
        at_hand, self._at_hand = self._at_hand, False
        placed = self._problem.impose(guess, load)
        if self._trusted is None:
            return placed
        shift = placed - guess
        sizes = self._problem.typical_sizes
        largest = float(np.abs(shift / sizes).max(initial=0.0))
        if self._comm.allreduce(largest, MPI.MAX) <= _IN_PLACE:
            return placed
        trusted = self._trusted
        if not at_hand:
            self._load = trusted.load
            self._newton.factorise(trusted.factorised)
        forces = self._problem.lift(trusted.factorised, trusted.load, shift)
        return guess + self._newton.back_substitute(forces)

    def _origin(self, load: float) -> Origin | None:
        """The state that was linearised last, and the step along its tangent to a load."""
        if self._trusted is None:
            return None
        trusted = self._trusted
        return Origin(trusted.x, (load - trusted.load) * trusted.rate)

    def _set_load(self, load: float) -> None:
        self._load = load

    @property
    def _comm(self) -> MPI.Comm:
        return self._newton.comm

    @cached_property
    def _metric(self) -> Metric:
        weights = None if self._weights is None else self._weights()
        return Metric(self._problem, self._comm, weights)

    @cached_property
    def _bordered(self) -> BorderedNewton:
        return BorderedNewton(self._problem, self._newton, self._metric, self._set_load)

    @cached_property
    def _modes(self) -> ModesNearZero:
        return ModesNearZero(self._matrix, self._newton.factorisation, self._metric.weights)
