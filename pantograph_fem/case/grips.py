"""Sections ``[grips.bottom]`` and ``[grips.top]``: how the short sides are held and moved."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator

from .part import Part, Point, finite_numbers
from .problem import Problem, not_allowed, problem_error


def _pivot(value: object) -> object:
    if value in ("centre", "left", "right"):
        return value
    numbers = finite_numbers(value)
    if numbers is None or len(numbers) != 2:
        rule = 'be "centre", "left", "right" or a pair [x, y] of finite numbers'
        raise problem_error(Problem(not_allowed(value, rule)))
    return numbers


#: A place on the reference edge, or a point, m.
Pivot = Annotated[Literal["centre", "left", "right"] | tuple[float, float], BeforeValidator(_pivot)]


class Grip(Part):
    """An edge that moves as a rigid body.

    A load fraction t imposes the translation t * `translation` and the rigid rotation
    t * `rotation` about the pivot.

    Attributes
    ----------
    hold
        "position": the position alone; "clamp": the placement gradient as well.
    translation
        Translation at full load, m.
    rotation
        Rotation at full load, degrees anticlockwise.
    pivot
        Centre of the rotation: a place on the reference edge, or a point [x, y], m.
    """

    hold: Literal["position", "clamp"] = "position"
    translation: Point = (0.0, 0.0)
    rotation: float = 0.0
    pivot: Pivot = "centre"


class Grips(Part):
    """The two grips; one that is not given is held still."""

    bottom: Grip = Grip()
    top: Grip = Grip()

    @property
    def clamped(self) -> bool:
        """Whether a grip holds the placement gradient."""
        return "clamp" in (self.bottom.hold, self.top.hold)

    def check_clamps(self, has_bending: bool) -> None:
        """Raise when a grip clamps a sheet without bending."""
        if has_bending:
            return
        text = (
            '"clamp" is not allowed without material.bending; it must be "position" (a clamp '
            "prescribes the placement gradient, which only the bending effect sees)"
        )
        problems = [
            Problem(text, (side, "hold"))
            for side, grip in (("bottom", self.bottom), ("top", self.top))
            if grip.hold == "clamp"
        ]
        if problems:
            raise problem_error(*problems)
