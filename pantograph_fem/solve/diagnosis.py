"""Looks at a state that was not found, and at the last one that was."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from .eigenvalue import ModesNearZero
from .equilibrium import Array, Correction
from .factorisation import SingularTangentError
from .failure import Diagnosis
from .newton import NewtonSolver
from .problem import Problem


def diagnose(
    problem: Problem,
    newton: NewtonSolver,
    modes: ModesNearZero,
    set_load: Callable[[float], None],
    last: tuple[Array, float],
    failed: Correction,
) -> Diagnosis:
    """What there is to say; a collective call.

    Parameters
    ----------
    problem, newton, modes
        What was solved, how, and the modes of the tangents of `newton`.
    set_load
        Tells the load at which `newton` evaluates residual and tangent.
    last
        The last accepted state and its load.
    failed
        The last try after it.
    """
    set_load(failed.load)
    worst, where = _worst_residual(problem, newton, failed.x)
    found = Diagnosis(worst_residual=worst, worst_at=where)
    x, load = last
    set_load(load)
    try:
        factor = newton.factorise(x)
        inertia, expected = factor.inertia, problem.expected_negative_pivots
        found = replace(
            found,
            negative_pivots=inertia.negative,
            expected_negative_pivots=expected,
            zero_pivots=inertia.zero,
            condition=factor.condition(),
        )
        mode = modes.find(min(expected - inertia.negative, 0))
        return found if mode is None else replace(found, lowest_eigenvalue=mode[0])
    except SingularTangentError:
        return found


def _worst_residual(problem: Problem, newton: NewtonSolver, x: Array) -> tuple[float | None, str]:
    """The largest entry and its place; nothing where the residual is no number."""
    residual = newton.residual(x)
    comm = newton.comm
    own = float(np.abs(residual).max(initial=0.0))
    largest = comm.allgather(own if np.isfinite(residual).all() else np.nan)
    if not np.isfinite(largest).all():
        return None, ""
    rank = int(np.argmax(largest))
    where = ""
    if comm.rank == rank and len(residual):
        where = problem.locate(int(np.abs(residual).argmax()))
    return largest[rank], comm.bcast(where, root=rank)
