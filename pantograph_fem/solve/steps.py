"""The states that make up a path, and what is needed to take it up again."""

from __future__ import annotations

from dataclasses import dataclass

from .critical import CriticalPoint
from .equilibrium import Array, Linearisation
from .predictor import PathPoint
from .step_size import StepSettings


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """All that the rest of a path depends on.

    Attributes
    ----------
    points
        The last one or two accepted states, the last one last.
    number, iterations
        Number of the last accepted step, and the iterations it took.
    step_size
        Size of the next step; None for the initial one of the settings.
    """

    points: tuple[PathPoint, ...]
    number: int = 0
    iterations: int = 0
    step_size: float | None = None


def start_at(x: Array) -> Checkpoint:
    """The beginning of a path at a state that is in equilibrium at load 0."""
    return Checkpoint((PathPoint(0.0, x),))


@dataclass(frozen=True, eq=False)
class Step:
    """An accepted state; step 0 is the start.

    From `checkpoint` the path can be taken up again. That of a critical state, which has
    `critical`, is the one of the state before it.
    """

    number: int
    load: float
    x: Array
    iterations: int
    linearisation: Linearisation
    is_stop: bool
    checkpoint: Checkpoint
    critical: CriticalPoint | None = None


def accepted_step(
    checkpoint: Checkpoint, linearisation: Linearisation, settings: StepSettings
) -> Step:
    """The last state of a checkpoint as a step."""
    here = checkpoint.points[-1]
    return Step(
        checkpoint.number,
        here.load,
        here.x,
        checkpoint.iterations,
        linearisation,
        here.load in settings.stops,
        checkpoint,
    )


def critical_step(
    number: int, point: CriticalPoint, checkpoint: Checkpoint, settings: StepSettings
) -> Step:
    """A critical point as a step."""
    return Step(
        number,
        point.load,
        point.x,
        point.iterations,
        point.linearisation,
        point.load in settings.stops,
        checkpoint,
        point,
    )
