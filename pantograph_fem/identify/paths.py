"""Equilibrium paths for one set of constants after another, each started from those before."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from time import process_time

import numpy as np
from numpy.typing import NDArray

from mpi4py import MPI

from ..case import SheetCase
from ..errors import PathError
from ..sheet.simulation import SheetSimulation
from ..solve.continuation import follow, start_at
from ..solve.equilibrium import Linearisation
from ..solve.origin import Origin
from ..stepping import step_settings
from ..stopwatch import Stopwatch
from .parameters import Parameter, slopes_of, values_of
from .responses import Response, Responses

Array = NDArray[np.float64]

#: Paths that are kept to start others from.
_KEPT = 6


@dataclass(frozen=True, eq=False)
class EquilibriumPath:
    """The states of one set of constants.

    Attributes
    ----------
    q
        Coordinates of the constants, shape (constants,).
    states
        An equilibrium for each load, shape (loads, unknowns).
    rates
        Their derivatives with respect to q, shape (loads, constants, unknowns).
    values
        What is measured, shape (loads, columns), SI units and rad.
    slopes
        Its derivatives with respect to q, shape (loads, columns, constants).
    stable
        Whether each state is stable.
    """

    q: Array
    states: Array
    rates: Array
    values: Array
    slopes: Array
    stable: tuple[bool, ...]


@dataclass
class Cost:
    """What paths have cost.

    Attributes
    ----------
    paths
        Paths asked for.
    from_rest
        Those that were followed from the state of rest.
    tangents
        Tangents factorised for all of them, and for the first alone, which is from rest.
    seconds
        CPU time for all of them, and for the first.
    """

    paths: int = 0
    from_rest: int = 0
    tangents: list[int] = field(default_factory=lambda: [0, 0])
    seconds: list[float] = field(default_factory=lambda: [0.0, 0.0])

    def copy(self) -> Cost:
        """What it has cost until now."""
        return Cost(self.paths, self.from_rest, [*self.tangents], [*self.seconds])

    @property
    def worth(self) -> float:
        """Time for all, in times that a path from rest takes."""
        return self.seconds[0] / self.seconds[1] if self.seconds[1] else 0.0


class _LostError(Exception):
    """A path could not be reached from another."""


class Paths:
    """The equilibria of a sheet at some loads as functions of its constants."""

    def __init__(
        self, case: SheetCase, parameters: Sequence[Parameter], loads: Sequence[float]
    ) -> None:
        """Build the sheet; the case has every effect whose constant is looked for."""
        self.parameters = tuple(parameters)
        self.loads = tuple(loads)
        self.cost = Cost()
        self.simulation = SheetSimulation(case, MPI.COMM_WORLD, Stopwatch())
        self._responses = Responses(self.simulation, [p.name for p in parameters])
        self._predictor = case.continuation.predictor
        settings = step_settings(case)
        self._settings = replace(
            settings,
            stops=self.loads,
            initial_step=min(settings.initial_step, self.loads[-1]),
        )
        self._kept: list[EquilibriumPath] = []
        self._tangents = 0

    def at(self, q: Array) -> EquilibriumPath:
        """The path of the constants with the coordinates q; a collective call.

        Each of its states is looked for where the derivatives of the nearest path that is known
        say that it is. If one is not found there, or is unstable, the path is followed from rest.

        Raises
        ------
        PathError
            If there is no path up to the last load.
        """
        for path in self._kept:
            if np.array_equal(path.q, q):
                return path
        start, self._tangents = process_time(), 0
        self._responses.sensitivity.constants = values_of(self.parameters, q)
        try:
            path = self._nearby(q)
        except _LostError:
            self.cost.from_rest += 1
            path = self._from_rest(q)
        finally:
            self._count(process_time() - start)
        self._kept = [*self._kept[-(_KEPT - 1) :], path]
        return path

    def curve(self, q: Array, loads: Sequence[float]) -> Array:
        """What is measured at increasing loads, from rest; shape (loads, columns).

        Raises
        ------
        PathError
            If there is no path up to the last load.
        """
        self._responses.sensitivity.constants = values_of(self.parameters, q)
        settings = replace(self._settings, stops=tuple(loads))
        start = start_at(self.simulation.start)
        states = follow(self.simulation.path, start, settings, self._predictor)
        found = [self._responses.values(s.x, s.load) for s in states if s.is_stop]
        return np.array(found)

    def _count(self, seconds: float) -> None:
        first = self.cost.paths == 0
        self.cost.paths += 1
        for i in (0, 1) if first else (0,):
            self.cost.tangents[i] += self._tangents
            self.cost.seconds[i] += seconds

    def _nearby(self, q: Array) -> EquilibriumPath:
        """From the nearest path that is known."""
        if not self._kept:
            raise _LostError
        base = min(self._kept, key=lambda path: float(np.linalg.norm(path.q - q)))
        states = []
        for load, x, rates, stable in zip(
            self.loads, base.states, base.rates, base.stable, strict=True
        ):
            step = (q - base.q) @ rates
            try:
                correction = self.simulation.path.correct(x + step, load, Origin(x, step))
                self._tangents += correction.iterations
                if not correction.converged:
                    raise _LostError
                linearisation = self._linearise(correction.x, load)
            except PathError:
                raise _LostError from None
            if stable and not linearisation.stable:
                raise _LostError
            states.append(self._read(linearisation, load))
        return self._path(q, states)

    def _from_rest(self, q: Array) -> EquilibriumPath:
        states = []
        start = start_at(self.simulation.start)
        for step in follow(self.simulation.path, start, self._settings, self._predictor):
            self._tangents += step.iterations + 1
            if step.is_stop:
                states.append(self._read(step.linearisation, step.load))
        return self._path(q, states)

    def _linearise(self, x: Array, load: float) -> Linearisation:
        self._tangents += 1
        return self.simulation.path.linearise(x, load)

    def _read(self, linearisation: Linearisation, load: float) -> tuple[Linearisation, Response]:
        """The response of the state that was linearised last."""
        solve = self.simulation.path.back_substitute
        return linearisation, self._responses.read(linearisation.x, load, solve)

    def _path(self, q: Array, states: Sequence[tuple[Linearisation, Response]]) -> EquilibriumPath:
        scale = slopes_of(self.parameters, q)
        return EquilibriumPath(
            q=q.copy(),
            states=np.array([at.x for at, _ in states]),
            rates=np.array([read.state_rates * scale[:, None] for _, read in states]),
            values=np.array([read.values for _, read in states]),
            slopes=np.array([read.rates * scale for _, read in states]),
            stable=tuple(at.stable for at, _ in states),
        )
