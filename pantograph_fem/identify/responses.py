"""What is measured of an equilibrium, and its derivatives with respect to the constants."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..case import SheetCase
from ..continuum.sensitivity import Sensitivity
from ..sheet.domain import GRIPS
from ..sheet.simulation import SheetSimulation

Array = NDArray[np.float64]

#: Columns of the history that are the force of the top grip, N.
FORCES = ("force_x", "force_y")


def response_columns(case: SheetCase) -> tuple[str, ...]:
    """Columns of ``history.csv`` that data can be compared with."""
    readings = (m.columns(name) for name, m in case.measurements.items())
    return (*FORCES, *(column for columns in readings for column in columns))


@dataclass(frozen=True, eq=False)
class Response:
    """What is measured of a state.

    Attributes
    ----------
    values
        By the columns of :func:`response_columns`, SI units and rad.
    rates
        Their derivatives, shape (columns, constants).
    state_rates
        Those of the state, shape (constants, unknowns).
    """

    values: Array
    rates: Array
    state_rates: Array


class Responses:
    """Reads states of a sheet."""

    def __init__(self, simulation: SheetSimulation, constants: Sequence[str]) -> None:
        self._simulation = simulation
        self._equilibrium = simulation.equilibrium
        self._grip = self._equilibrium.supports[GRIPS.index("top")]
        self._translations = [self._grip.virtual_translation(i) for i in (0, 1)]
        self.sensitivity = Sensitivity(simulation.equilibrium, constants)

    def values(self, x: Array, load: float) -> Array:
        """What is measured of a state, by the columns; a collective call."""
        residual = self._equilibrium.forces(x, load)
        forces = [self._equilibrium.work(self._grip, v, residual) for v in self._translations]
        readings = self._simulation.measurements
        return np.array(forces) if readings is None else np.append(forces, readings.values())

    def read(self, x: Array, load: float, solve: Callable[[Array], Array]) -> Response:
        """The response of an equilibrium; a collective call.

        `solve` back-substitutes with the factor of the tangent there.
        """
        force_rates = self.sensitivity.force_rates(x, load)
        state_rates = self.sensitivity.state_rates(force_rates, solve)
        rates = self._force_rates(x, load, force_rates, state_rates)
        readings = self._simulation.measurements
        if readings is not None:
            moved = [self._place(rate, load) for rate in state_rates]
            u = self._place(x, load)
            rates = np.concatenate([rates, np.transpose([readings.rates(u, v) for v in moved])])
        return Response(self.values(x, load), rates, state_rates)

    def _place(self, x: Array, load: float) -> Array:
        """Displacements of the measured points in a state, or in the rate of one."""
        assert self._simulation.measurements is not None
        self._equilibrium.load_state(x, load)
        return self._simulation.measurements.displacements()

    def _force_rates(self, x: Array, load: float, force_rates: Array, state_rates: Array) -> Array:
        """Of the top grip's force, which is the work on its unit translations."""
        rates = []
        for virtual in self._translations:
            pull = self._equilibrium.work_rate(x, load, self._grip, virtual)
            direct = [self._equilibrium.work(self._grip, virtual, rate) for rate in force_rates]
            rates.append(direct + self._equilibrium.sum(state_rates @ pull))
        return np.array(rates)
