"""Why a correction was no success."""

from __future__ import annotations

from enum import Enum


class Cause(Enum):
    """Kinds of failure, by what can be done about them."""

    #: Newton's method was not done after as many iterations as it may take.
    ITERATIONS = "iterations"
    #: It came to a stand: no step makes the residual smaller.
    STALLED = "stalled"
    #: The tangent has no factor.
    SINGULAR = "singular"
    #: It ran off to where the residual is no number.
    DIVERGED = "diverged"
    #: An equilibrium was found which is none of a body.
    OBJECTION = "objection"
    #: An equilibrium was found which is none of the path.
    ELSEWHERE = "elsewhere"
    #: The path had taken as many steps as it may.
    STEPS = "steps"
    #: It was to end or to be left at a critical point, of which no mode was found.
    NO_MODE = "no mode"
    #: It was to be left for a branch, and none was found.
    NO_BRANCH = "no branch"
