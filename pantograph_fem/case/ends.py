"""Sections ``[ends.left]`` and ``[ends.right]``: how a beam is held, moved and loaded."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from .part import Part, Point
from .problem import Problem, not_allowed, problem_error

_ORIGIN = (0.0, 0.0)

#: Components of the displacement that each support holds: 0 for x, 1 for y.
HELD: dict[str, tuple[int, ...]] = {
    "clamped": (0, 1),
    "pinned": (0, 1),
    "roller": (1,),
    "free": (),
}


class End(Part):
    """An end of a beam.

    A load fraction t imposes the translation t * `translation` and the rigid rotation
    t * `rotation` about the pivot, or the dead loads t * `force` and t * `moment`.

    Attributes
    ----------
    support
        "clamped": position and direction are held; "pinned": the position; "roller": the position
        across the beam, along y; "free": nothing.
    translation
        Translation at full load of a clamped or pinned end, m.
    rotation
        Rotation at full load about the pivot of a clamped or pinned end, degrees anticlockwise. A
        clamped end turns with it, a pinned end moves along an arc.
    pivot
        Centre of the rotation, m; the end itself by default.
    force
        Dead force at full load on a free end, or [N, 0] on a roller, N.
    moment
        Moment at full load on an end that is free to turn, N m, anticlockwise.
    """

    support: Literal["clamped", "pinned", "roller", "free"]
    translation: Point = _ORIGIN
    rotation: float = 0.0
    pivot: Point | None = None
    force: Point = _ORIGIN
    moment: float = 0.0

    def problems(self, side: str) -> Iterator[Problem]:
        """Everything that the support does not allow."""
        moved = {"translation": self.translation != _ORIGIN, "rotation": self.rotation != 0.0}
        if self.support in ("roller", "free"):
            for key, given in moved.items():
                if given:
                    rule = f'be absent at a {self.support} end; only a "clamped" or "pinned" end'
                    value = getattr(self, key)
                    yield Problem(not_allowed(value, rule + " is moved"), (side, key))
        if self.force != _ORIGIN and self.support in ("clamped", "pinned"):
            rule = f'be absent at a {self.support} end; only a "free" end or a "roller" is loaded'
            yield Problem(not_allowed(self.force, rule), (side, "force"))
        if self.force[1] != 0.0 and self.support == "roller":
            rule = "be [N, 0] at a roller, which is held along y"
            yield Problem(not_allowed(self.force, rule), (side, "force"))
        if self.moment != 0.0 and self.support == "clamped":
            rule = "be absent at a clamped end, whose direction is held"
            yield Problem(not_allowed(self.moment, rule), (side, "moment"))


class Ends(Part):
    """The two ends; by default a cantilever that is clamped on the left."""

    left: End = End(support="clamped")
    right: End = End(support="free")

    def check(self, has_bending: bool, has_foundation: bool) -> None:
        """Raise when an end is given what its support does not allow, or nothing holds the beam."""
        problems = [*self.left.problems("left"), *self.right.problems("right")]
        supports = (self.left.support, self.right.support)
        if not has_bending:
            for side, end in (("left", self.left), ("right", self.right)):
                if end.support in ("clamped", "roller"):
                    text = (
                        f'"{end.support}" is not allowed without material.bending; it must be '
                        '"pinned" or "free" (a string has no direction to hold, nor does it '
                        "stand by itself)"
                    )
                    problems.append(Problem(text, (side, "support")))
                if end.moment:
                    rule = "be absent without material.bending"
                    problems.append(Problem(not_allowed(end.moment, rule), (side, "moment")))
        elif not has_foundation and "clamped" not in supports and not _holds(supports):
            text = (
                f'supports "{supports[0]}" and "{supports[1]}" are not allowed: the beam could '
                'move as a whole; one end must be "clamped", or one "pinned" and the other '
                '"pinned" or "roller"'
            )
            problems.append(Problem(text))
        if problems:
            raise problem_error(*problems)


def _holds(supports: tuple[str, str]) -> bool:
    return "pinned" in supports and "free" not in supports
