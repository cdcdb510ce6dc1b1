"""Sections ``[beam]`` and ``[material]`` of a beam, and what it rests on."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from .part import Part, finite_numbers
from .problem import Problem, not_allowed, problem_error


class Beam(Part):
    """Reference axis, straight from (0, 0) to (length, 0).

    Attributes
    ----------
    length
        m.
    """

    length: float = Field(gt=0)


class FoundationPiece(Part):
    """A part of the foundation, which begins where the one before it ends.

    Attributes
    ----------
    to
        Abscissa at which it ends, m.
    stiffness
        K_w in both directions, N/m².
    """

    to: float = Field(gt=0)
    stiffness: float = Field(ge=0)


def _foundation(value: object) -> object:
    """Accept a number for a uniform foundation; None when there is no stiffness."""
    if value is None:
        return None
    if isinstance(value, list | tuple) and value:
        return tuple(value)
    numbers = finite_numbers([value])
    if numbers is None or numbers[0] < 0:
        rule = (
            "be a finite number, 0 or greater, or a list of pieces {to = abscissa, stiffness = K_w}"
        )
        raise problem_error(Problem(not_allowed(value, rule)))
    return numbers[0] or None


Foundation = Annotated[float | tuple[FoundationPiece, ...] | None, BeforeValidator(_foundation)]

#: A stiffness; zero and absent mean the same.
Stiffness = Annotated[float | None, Field(ge=0), AfterValidator(lambda value: value or None)]


class BeamMaterial(Part):
    """Stiffnesses of a beam; an effect that is absent or zero is not simulated.

    Attributes
    ----------
    stretch
        K_e, N.
    bending
        K_b, N m².
    foundation
        K_w of a Winkler foundation, N/m²: a number, or pieces from left to right.
    """

    stretch: Stiffness = None
    bending: Stiffness = None
    foundation: Foundation = None

    @model_validator(mode="after")
    def _has_stretch(self) -> BeamMaterial:
        if self.stretch is None:
            text = "missing; it is required and must be greater than 0: K_e holds the beam's points"
            raise problem_error(Problem(text + " together", ("stretch",)))
        return self

    def pieces(self, length: float) -> tuple[tuple[float, float], ...]:
        """(end, stiffness) of each piece of the foundation, m and N/m²; none without one."""
        if self.foundation is None:
            return ()
        if isinstance(self.foundation, float):
            return ((length, self.foundation),)
        return tuple((piece.to, piece.stiffness) for piece in self.foundation)

    def check_pieces(self, length: float) -> None:
        """Raise when the pieces do not follow one another up to the end of the beam."""
        if self.foundation is None or isinstance(self.foundation, float):
            return
        ends = [piece.to for piece in self.foundation]
        if any(a >= b for a, b in pairwise(ends)) or abs(ends[-1] - length) > 1e-9 * length:
            rule = f"have increasing ends, the last of them beam.length ({length})"
            raise problem_error(Problem(not_allowed(ends, rule), ("foundation",)))
