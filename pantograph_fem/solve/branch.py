"""From a bifurcation onto the path that branches off there."""

from __future__ import annotations

from dataclasses import dataclass

from .critical import CriticalPoint
from .equilibrium import Correction, Linearisation, ModalEquilibrium, Plane
from .factorisation import SingularTangentError
from .origin import Origin

#: Mean square displacements along the critical mode, in typical sizes, to try: root of it.
_AMPLITUDES = tuple(0.05 / 2**i for i in range(12))


@dataclass(frozen=True, eq=False)
class BranchState:
    """A state on the branch, and its linearisation."""

    correction: Correction
    linearisation: Linearisation


def switch_branch(
    problem: ModalEquilibrium, point: CriticalPoint, before: float, upwards: bool
) -> BranchState | None:
    """A state of the branch that leaves a path at a bifurcation, or None where none was found.

    The state is displaced from the critical one by a given amount along the critical mode, which
    the path itself is not; its load follows. The largest amount that works is taken, and of the
    two directions that of the mode, or else the other one.

    Parameters
    ----------
    problem
        Corrects and linearises states.
    point
        The bifurcation.
    before
        The load that the state must not pass, as the next stop.
    upwards
        Whether it must be stable and its load above the critical one, so that the branch can be
        followed by raising the load.
    """
    for amplitude in _AMPLITUDES:
        for sign in (1.0, -1.0):
            state = _displaced(problem, point, sign * amplitude)
            if state is None or state.correction.load > before:
                continue
            rises = state.correction.load > point.load and state.linearisation.stable
            if rises or not upwards:
                return state
    return None


def _displaced(
    problem: ModalEquilibrium, point: CriticalPoint, amplitude: float
) -> BranchState | None:
    shape = point.mode.shape
    step = amplitude * shape
    plane = Plane(point.x + step, point.load, shape, 0.0, Origin(point.x, step))
    found = problem.correct_on_plane(plane)
    if not found.converged:
        return None
    away = found.x - plane.x
    # Displaced by more than along the mode: some other state, with which the path does not cross.
    if problem.inner(away, away) > amplitude**2:
        return None
    try:
        return BranchState(found, problem.linearise(found.x, found.load))
    except SingularTangentError:
        return None
