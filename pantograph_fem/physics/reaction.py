"""What a support exerts on what it holds."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Reaction:
    """Force (N) and moment about the support's current centre (N m)."""

    force: tuple[float, float]
    moment: float

    def __add__(self, other: Reaction) -> Reaction:
        return Reaction(
            (self.force[0] + other.force[0], self.force[1] + other.force[1]),
            self.moment + other.moment,
        )


#: Of a support that exerts nothing.
NO_REACTION = Reaction((0.0, 0.0), 0.0)
