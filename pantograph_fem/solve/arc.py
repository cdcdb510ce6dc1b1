"""Length along a path, and how the path is expected to go on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .ending import linearise_first
from .equilibrium import Array, ModalEquilibrium, Plane
from .origin import Origin
from .predictor import PathPoint

#: Root mean square displacement, in typical sizes, that is not worth less than the full load.
_LEAST_SCALE = 0.3


@dataclass(frozen=True, eq=False)
class Point:
    """A state and its load, or a change of both."""

    x: Array
    load: float


@dataclass(frozen=True, eq=False)
class Arc:
    r"""Length along a path: :math:`ds^2 = dt^2 + |dx|^2/\sigma^2`.

    The scale σ is the root mean square displacement that goes with the full load at the start of
    the path, so that lengths are about loads where the path begins, and steps mean the same.
    """

    problem: ModalEquilibrium
    scale: float

    @classmethod
    def from_rest(cls, problem: ModalEquilibrium, rest: Array) -> Arc:
        """The arc of the path that begins at `rest`, the state at load 0."""
        rate = linearise_first(problem, rest, 0.0, problem).rate
        return cls(problem, max(problem.inner(rate, rate) ** 0.5, _LEAST_SCALE))

    def product(self, a: Point, b: Point) -> float:
        """Of two changes."""
        return a.load * b.load + self.problem.inner(a.x, b.x) / self.scale**2

    def length(self, x: Array, load: float) -> float:
        """Length of a change."""
        return self.product(Point(x, load), Point(x, load)) ** 0.5

    def plane(self, point: Point, normal: Point, origin: Origin) -> Plane:
        """Through a point, at right angles to a direction."""
        return Plane(point.x, point.load, normal.x / self.scale**2, normal.load, origin)


@dataclass(frozen=True, eq=False)
class Parabola:
    """Where the path is expected, by the length from `here`.

    `tangent` is its direction there, of unit length, and `bend` half of its second derivative.
    """

    here: PathPoint
    tangent: Point
    bend: Point

    @classmethod
    def through(cls, arc: Arc, points: tuple[PathPoint, ...], rate: Array) -> Parabola:
        """From the state before the last, if there is one, and the path's derivative at the last.

        Without one before, it sets out with rising loads, and is straight.
        """
        *earlier, here = points
        length = arc.length(rate, 1.0)
        if not earlier:
            return cls(here, Point(rate / length, 1.0 / length), Point(np.zeros_like(rate), 0.0))
        back = Point(earlier[-1].x - here.x, earlier[-1].load - here.load)
        if arc.product(back, Point(rate, 1.0)) > 0.0:
            length = -length
        tangent = Point(rate / length, 1.0 / length)
        chord = arc.length(back.x, back.load)
        bend = Point(
            (back.x + chord * tangent.x) / chord**2, (back.load + chord * tangent.load) / chord**2
        )
        return cls(here, tangent, bend)

    def at(self, length: float) -> Point:
        """The expected state."""
        x = self.here.x + length * self.tangent.x + length**2 * self.bend.x
        load = self.here.load + length * self.tangent.load + length**2 * self.bend.load
        return Point(x, load)

    def origin(self, length: float) -> Origin:
        """Where that is extrapolated from."""
        return Origin(self.here.x, length * self.tangent.x)

    def reaching(self, load: float, longest: float) -> float:
        """Length at which the load comes to a value, or `longest` where it does not before."""
        roots = np.roots([self.bend.load, self.tangent.load, self.here.load - load])
        lengths = roots.real[(roots.imag == 0.0) & (roots.real > 0.0)]
        return float(min(lengths.min(initial=longest), longest))
