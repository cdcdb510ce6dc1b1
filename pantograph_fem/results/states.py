"""Saved states of a run as arrays by name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import overload

import numpy as np
from numpy.typing import NDArray

from ..errors import CaseError
from .fields import FieldSeries

Array = NDArray[np.float64]


class State(Mapping[str, Array]):
    """Fields of a saved state on the nodes of the output grid, by name; read when first used.

    ``state["displacement"]`` has shape (n, 2) and is in m, scalars as ``state["shear_angle"]``
    have shape (n,); docs/paraview.md names them all with their units.

    Attributes
    ----------
    load
        Load factor t.
    """

    def __init__(self, series: FieldSeries, index: int) -> None:
        self._series, self._index = series, index
        self.load = float(series.loads[index])

    @property
    def points(self) -> Array:
        """Reference coordinates of the nodes, shape (n, 2), m."""
        return self._series.grid.points

    @property
    def cells(self) -> NDArray[np.integer]:
        """Nodes of each triangle of a sheet, shape (m, 3), or of each line, shape (m, 2)."""
        return self._series.grid.cells

    @property
    def deformed(self) -> Array:
        """Current coordinates of the nodes, shape (n, 2), m."""
        return self.points + self["displacement"]

    @cached_property
    def cell_fields(self) -> dict[str, Array]:
        """Fields of the cells by name, shape (m,) or (m, 2)."""
        return self._series.cell_fields(self._index)

    @cached_property
    def _fields(self) -> dict[str, Array]:
        return self._series.fields(self._index)

    def __getitem__(self, name: str) -> Array:
        return self._fields[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __len__(self) -> int:
        return len(self._fields)

    def __repr__(self) -> str:
        return f"State(load={self.load:.7g}, fields={list(self)})"


class States(Sequence[State]):
    """Saved states of a run, in the order in which they were found."""

    def __init__(self, series: FieldSeries) -> None:
        self._series = series

    @property
    def loads(self) -> Array:
        """Load factor of each state, shape (k,)."""
        return self._series.loads

    def at(self, load: float) -> State:
        """The first state at a load factor, to 1e-9.

        Raises
        ------
        CaseError
            If none was saved there; the message tells the loads of those that were.
        """
        found = np.flatnonzero(np.abs(self.loads - load) <= 1e-9)
        if not len(found):
            loads = ", ".join(f"{value:.7g}" for value in self.loads)
            raise CaseError(
                f"there is no saved state at load factor {load:.7g}; there are those at {loads}. "
                "A load in continuation.stops is always found and saved."
            )
        return self[int(found[0])]

    def __len__(self) -> int:
        return len(self._series.loads)

    @overload
    def __getitem__(self, index: int) -> State: ...
    @overload
    def __getitem__(self, index: slice) -> list[State]: ...
    def __getitem__(self, index: int | slice) -> State | list[State]:
        if isinstance(index, slice):
            return [State(self._series, i) for i in range(*index.indices(len(self)))]
        if not -len(self) <= index < len(self):
            raise IndexError(f"state {index} of {len(self)}")
        return State(self._series, index % len(self))

    def __repr__(self) -> str:
        return f"States({len(self)} at loads {self.loads.min():.7g} to {self.loads.max():.7g})"
