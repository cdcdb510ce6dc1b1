"""The loop: solve, estimate, refine, go on from where it was, until the error is small enough."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

from ..errors import PathError
from .accuracy import Accuracy, FullLoad, Quantity, mesh_line
from .estimate import next_growth

#: Growth of the number of cells from mesh to mesh. The meshes before the last cost little beside
#: the path on that one, and two meshes that are more alike say little about the error.
GROWTH = (2.2, 3.0)
#: Share of the accuracy that the next mesh aims at.
AIM = 0.7
#: Where it ends even though the accuracy is not reached.
MAX_MESHES, MAX_DOFS = 8, 200_000
#: Relative difference of energy up to which a state is the continuation of that of another mesh.
_SAME_STATE = 0.1

Self = TypeVar("Self", bound="Level")


class Level(Protocol):
    """A mesh with its discrete problem. Every method is collective."""

    @property
    def cells(self) -> int:
        """Number of cells."""

    @property
    def unknowns(self) -> int:
        """Number of dofs of all fields."""

    @property
    def order(self) -> float:
        """Order of the scheme in energy norm."""

    def solve_from(self: Self, coarser: Self) -> FullLoad | None:
        """The state at full load near that of a coarser mesh; None where there is none."""

    def follow(self) -> FullLoad:
        """The state at full load, at the end of the path.

        Raises
        ------
        PathError
            Where the path stops. The state is then the last one before.
        """

    def refined(self: Self, growth: float) -> Self:
        """A level with `growth` times as many cells, where the present state needs them."""


L = TypeVar("L", bound=Level)


def adapt(
    level: L, of: Quantity, accuracy: float, tell: Callable[[str], None]
) -> tuple[L, Accuracy]:
    """Refine from a coarse level until the estimated error is within the accuracy.

    Of two meshes in a row on which the path stops, the second is the last: the path is recorded
    as far as it goes. The accuracy is not reached then, nor where it takes more than
    :data:`MAX_MESHES` meshes or :data:`MAX_DOFS` unknowns.

    Parameters
    ----------
    level
        The first mesh.
    of, accuracy
        Which error, relative to the value at full load, shall be how small.
    tell
        Called with a line about each mesh.

    Returns
    -------
    tuple
        The last level, and what the series of meshes says about it.
    """
    found = Accuracy(of, accuracy)
    coarser: L | None = None
    while True:
        state = _full_load(level, coarser, found)
        found = found.with_mesh(level.cells, level.unknowns, state, level.order)
        tell(mesh_line(len(found.meshes), found.last))
        stopped_again = len(found.meshes) > 1 and not any(m.state for m in found.meshes[-2:])
        if found.reached or stopped_again or len(found.meshes) == MAX_MESHES:
            return level, found
        growth = next_growth(found.error, AIM * accuracy, level.order, GROWTH)
        if growth * level.unknowns > MAX_DOFS:
            return level, found
        coarser, level = level, level.refined(growth)


def _full_load(level: L, coarser: L | None, found: Accuracy) -> FullLoad | None:
    """The state at full load, from that of the coarser mesh if it leads there."""
    before = found.last.state if found.meshes else None
    if coarser is not None and before is not None:
        state = level.solve_from(coarser)
        if state is not None and _continues(state, before):
            return state
    try:
        return level.follow()
    except PathError:
        return None


def _continues(state: FullLoad, before: FullLoad) -> bool:
    """Whether a state is that of the coarser mesh, as far as can be told."""
    near = abs(state.energy - before.energy) <= _SAME_STATE * max(state.energy, before.energy)
    return near and (state.stable or not before.stable)
