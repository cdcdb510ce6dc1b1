"""What must hold of one hard case in particular; each says what does not hold, or nothing."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from .evidence import Evidence


class Expectation(Protocol):
    """Something that is known about a result."""

    @property
    def others(self) -> tuple[str, ...]:
        """Names of the hard cases that it needs besides."""

    @property
    def of_the_end(self) -> bool:
        """Whether it is about the last state, and asked only of paths that are done."""

    def objection(self, found: Evidence, others: Mapping[str, Evidence]) -> str:
        """What does not hold; empty where all does."""


@dataclass(frozen=True)
class Value:
    """A number of the last state, as a closed form or a publication has it.

    Attributes
    ----------
    quantity
        Column of ``history.csv``, or "force".
    value, relative, absolute
        The number, SI units, and the larger of two tolerances.
    source
        Where it is from.
    size
        Whether its sign is anybody's choice.
    """

    quantity: str
    value: float
    relative: float = 0.0
    absolute: float = 0.0
    source: str = ""
    size: bool = False
    others: tuple[str, ...] = ()
    of_the_end: bool = True

    def objection(self, found: Evidence, others: Mapping[str, Evidence]) -> str:
        """Compare."""
        value = found.last(self.quantity)
        value = abs(value) if self.size else value
        allowed = max(self.relative * abs(self.value), self.absolute)
        if abs(value - self.value) <= allowed:
            return ""
        return f"{self.quantity} is {value:.8g}, not {self.value:.8g} ({self.source})"


@dataclass(frozen=True)
class Says:
    """A path that ends on its way says something in particular."""

    text: str
    others: tuple[str, ...] = ()
    of_the_end: bool = False

    def objection(self, found: Evidence, others: Mapping[str, Evidence]) -> str:
        """Look for it in the message."""
        if found.done or self.text in found.ended.message:
            return ""
        return f"the message does not say {self.text!r}: {found.ended.message}"


@dataclass(frozen=True)
class SameAs:
    """A number of the last state is that of another hard case, times a factor.

    Attributes
    ----------
    other
        Its name.
    quantity
        Column of ``history.csv``, or "force".
    relative, absolute
        The larger of two tolerances; the second in the units of this case.
    factor
        Of units, for one.
    """

    other: str
    quantity: str
    relative: float = 0.0
    absolute: float = 0.0
    factor: float = 1.0
    of_the_end: bool = True

    @property
    def others(self) -> tuple[str, ...]:
        """The other one."""
        return (self.other,)

    def objection(self, found: Evidence, others: Mapping[str, Evidence]) -> str:
        """Compare."""
        other = others[self.other]
        if not other.done or not other.rows:
            return f"there is no {self.other} to compare with"
        expected, value = self.factor * other.last(self.quantity), found.last(self.quantity)
        if abs(value - expected) <= max(self.relative * abs(expected), self.absolute):
            return ""
        return f"{self.quantity} is {value:.8g}, and {expected:.8g} by {self.other}"


@dataclass(frozen=True)
class NoLessThan:
    """A number of the last state is at least that of another hard case.

    `slack` is relative, for rounding and what iterations leave.
    """

    other: str
    quantity: str = "energy"
    slack: float = 1e-7
    of_the_end: bool = True

    @property
    def others(self) -> tuple[str, ...]:
        """The other one."""
        return (self.other,)

    def objection(self, found: Evidence, others: Mapping[str, Evidence]) -> str:
        """Compare."""
        other = others[self.other]
        if not other.done or not other.rows:
            return f"there is no {self.other} to compare with"
        value, least = found.last(self.quantity), other.last(self.quantity)
        if value >= least - self.slack * abs(least):
            return ""
        return f"{self.quantity} is {value:.8g}, less than the {least:.8g} of {self.other}"


@dataclass(frozen=True)
class Without:
    """No "cut-backs", or no "unstable states" besides critical ones, as named by `what`."""

    what: str
    others: tuple[str, ...] = ()
    of_the_end: bool = False

    def objection(self, found: Evidence, others: Mapping[str, Evidence]) -> str:
        """Count."""
        if self.what == "cut-backs":
            count = found.summary.get("cutbacks", math.nan)
        else:
            critical = [point["step"] for point in found.critical_points]
            elsewhere = ~np.isin(found.history["step"], critical)
            count = int((~found.history["stable"] & elsewhere).sum())
        return "" if count == 0 else f"{count} {self.what}"
