"""Other ways to a state that the corrector did not find, one after the other."""

from __future__ import annotations

from collections.abc import Iterator

from .equilibrium import Array, Correction, Linearisation, ModalEquilibrium
from .factorisation import SingularTangentError
from .predictor import PathPoint, PredictorName, predict

#: A state is on the path if it is away from the last one by no more than so many times what the
#: tangent predicts. Towards a point where the load turns back it is up to twice that.
_FARTHEST = 4.0


def rescue(
    problem: ModalEquilibrium,
    predictor: PredictorName,
    points: tuple[PathPoint, ...],
    load: float,
    stable: bool,
) -> tuple[Correction, Linearisation] | None:
    """An equilibrium at `load`, and its linearisation, by the first rung that leads to one.

    The rungs are the tangent predictor, if another one was used; the line search that tries
    harder; and the way by easier problems, which ends at this one. (To start from the last state
    without a prediction, where the tangent fails, has never helped.) A path in trouble leads past
    other paths, so that a state counts only if it is near, and stable where the path was.

    Parameters
    ----------
    problem
        Corrects and linearises states.
    predictor
        What the corrector set out from.
    points
        The last accepted states, the last one last, with its derivative of the path.
    load
        Where the corrector found nothing.
    stable
        Whether the last accepted state is stable.
    """
    guess = predict("tangent", points, load)
    for found in _rungs(problem, predictor, guess, load):
        if not found.converged or not _near(problem, found, points[-1]):
            continue
        try:
            linearisation = problem.linearise(found.x, load)
        except SingularTangentError:
            continue
        if linearisation.stable or not stable:
            return found, linearisation
    return None


def _rungs(
    problem: ModalEquilibrium, predictor: PredictorName, guess: Array, load: float
) -> Iterator[Correction]:
    if predictor != "tangent":
        yield problem.correct(guess, load)
    yield problem.correct_exactly(guess, load)
    for level in range(1, problem.softest + 1):
        yield problem.correct_softly(guess, load, level)


def _near(problem: ModalEquilibrium, found: Correction, here: PathPoint) -> bool:
    assert here.rate is not None  # it was linearised
    ahead, away = (found.load - here.load) * here.rate, found.x - here.x
    return problem.inner(away, away) <= _FARTHEST**2 * problem.inner(ahead, ahead)
