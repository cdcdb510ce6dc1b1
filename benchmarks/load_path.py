"""From rest to full load: a predictor, Newton's method, and SuperLU for the linear systems."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from time import process_time
from typing import Any

import numpy as np
from discretised_energy import Array, DiscretisedEnergy
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

#: Correction, in the energy norm over the energy stored, that ends an iteration.
TOLERANCE = 1e-6
#: An old factor is kept while a correction is less than this share of the one before.
CONTRACTION = 0.2
#: Correction above which the factor of another state is not trusted.
NEAR = 0.1
FIRST_STEP, LARGEST_STEP, SMALLEST_STEP = 0.02, 0.25, 1e-4
MOST_TANGENTS = 8
#: Tangents of a step after which the step size is kept, by whether factors are.
TARGET = {True: 3.0, False: 5.0}


@dataclass(frozen=True)
class Pull:
    """Dofs that are prescribed, and their values at full load, zeros elsewhere, shape (size,)."""

    prescribed: NDArray[np.int64]
    values: Array


@dataclass
class Path:
    """Where the path has come to, and what it has cost.

    Attributes
    ----------
    loads, works, energies
        Of the states found: load fraction; force on the grip times its displacement at full load,
        J; stored energy, J.
    tangents, residuals
        Numbers made of each.
    seconds
        CPU time by stage.
    """

    loads: list[float] = field(default_factory=list)
    works: list[float] = field(default_factory=list)
    energies: list[float] = field(default_factory=list)
    tangents: int = 0
    residuals: int = 0
    seconds: dict[str, float] = field(
        default_factory=lambda: {"tangent": 0.0, "factorise": 0.0, "residual": 0.0}
    )


class _Linearised:
    """Factor of the tangent at a state, and the rate of the state with the load."""

    def __init__(
        self,
        energy: DiscretisedEnergy,
        x: Array,
        pull: Pull,
        options: Mapping[str, Any],
        path: Path,
    ) -> None:
        self._free = np.setdiff1d(np.arange(energy.size), pull.prescribed)
        start = process_time()
        K = energy.tangent(x)
        of_free = K[self._free][:, self._free].tocsc()
        right = -(K @ pull.values)[self._free]
        assembled = process_time()
        self._factor = splu(of_free, **options)
        path.seconds["tangent"] += assembled - start
        path.seconds["factorise"] += process_time() - assembled
        path.tangents += 1
        self.rate = pull.values.copy()
        self.rate[self._free] = self._factor.solve(right)

    def corrected(self, x: Array, residual: Array) -> tuple[Array, float]:
        """The state after a correction, and the square of the correction in the energy norm."""
        right = -residual[self._free]
        correction = self._factor.solve(right)
        better = x.copy()
        better[self._free] += correction
        return better, abs(correction @ right)


def follow(
    energy: DiscretisedEnergy, pull: Pull, options: Mapping[str, Any], *, keep_factor: bool
) -> Path:
    """Follow the equilibria to full load.

    The predictor is the parabola through the last two states with the tangent of the last one.
    Steps grow where few tangents are enough.

    Parameters
    ----------
    options
        Of `scipy.sparse.linalg.splu`.
    keep_factor
        Whether a factor is used for several corrections while they get smaller quickly; else each
        has a tangent of its own.

    Raises
    ------
    RuntimeError
        If a step fails that cannot be cut any more.
    """
    path = Path()
    x, load, step = np.zeros(energy.size), 0.0, FIRST_STEP
    before: tuple[float, Array] | None = None
    linearised = _Linearised(energy, x, pull, options, path)
    while load < 1.0:
        step = min(step, 1.0 - load)
        guess = x + step * linearised.rate
        if before is not None:
            back = before[0] - load
            guess += (step / back) ** 2 * (before[1] - x - back * linearised.rate)
        tangents = path.tangents
        found = _newton(energy, guess, pull, options, path, keep_factor)
        if found is None:
            step *= 0.5
            if step < SMALLEST_STEP:
                raise RuntimeError(f"no equilibrium found beyond the load fraction {load:.6g}")
            continue
        before = load, x
        x, stored, residual, linearised = found
        load = 1.0 if load + step > 1.0 - 1e-9 else load + step
        path.loads.append(load)
        path.works.append(float(residual @ pull.values))
        path.energies.append(stored)
        growth = TARGET[keep_factor] / (path.tangents - tangents)
        step = min(step * min(max(growth, 0.5), 2.0), LARGEST_STEP)
    return path


def _newton(
    energy: DiscretisedEnergy,
    x: Array,
    pull: Pull,
    options: Mapping[str, Any],
    path: Path,
    keep_factor: bool,
) -> tuple[Array, float, Array, _Linearised] | None:
    """State, energy, residual and last factor; None where the iteration does not converge."""
    stored, residual = _residual(energy, x, path)
    most = path.tangents + MOST_TANGENTS
    linearised, last = None, np.inf
    while np.isfinite(stored):
        if linearised is None:
            if path.tangents == most:
                return None
            linearised, last = _Linearised(energy, x, pull, options, path), np.inf
        x, square = linearised.corrected(x, residual)
        stored, residual = _residual(energy, x, path)
        error = np.sqrt(square / abs(stored))
        if error < TOLERANCE:
            return x, stored, residual, linearised
        if not keep_factor or error > min(CONTRACTION * last, NEAR):
            linearised = None
        last = error
    return None


def _residual(energy: DiscretisedEnergy, x: Array, path: Path) -> tuple[float, Array]:
    start = process_time()
    result = energy.residual(x)
    path.seconds["residual"] += process_time() - start
    path.residuals += 1
    return result
