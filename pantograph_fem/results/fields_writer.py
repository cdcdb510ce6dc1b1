"""Writes states to ``fields.xdmf`` and ``fields.h5``, so that all that is listed can be read.

At each step the arrays are stored first and listed afterwards, also for those who look at them
while the run goes on, and for a run that is killed.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

import h5py
import numpy as np
from numpy.typing import NDArray

from ..errors import CaseError
from ..numbering import same_cells, same_points
from .fields import H5_NAME, XDMF_NAME, FieldGrid, read_fields
from .space import require_space
from .xdmf import Dataset, StateEntry, XdmfIndex

Array = NDArray[np.float64]


class FieldsWriter:
    """Write ``fields.xdmf`` and ``fields.h5``; both can be read after every step.

    Parameters
    ----------
    directory
        Where the two files go; made if it is missing. Earlier ones are replaced.
    grid
        Reference configuration.
    kept
        Number of states already in the directory to go on from; later ones are dropped.

    Raises
    ------
    CaseError
        If there are fewer than `kept` states, or they are on another grid.
    """

    def __init__(self, directory: Path, grid: FieldGrid, kept: int = 0) -> None:
        self._directory = directory
        self._nodes, self._cells = len(grid.points), len(grid.cells)
        self._index = XdmfIndex(
            points=Dataset(H5_NAME, "/points", (self._nodes, 3)),
            cells=Dataset(H5_NAME, "/cells", grid.cells.shape),
        )
        self._count = 0
        #: Rows of fields as they come, in the order in which they are stored.
        self._node_order, self._cell_order = np.arange(self._nodes), np.arange(self._cells)
        if kept:
            old = read_fields(directory)
            self._node_order, self._cell_order = _orders_of_old_grid(directory, old.grid, grid)
            if len(old.loads) < kept:
                raise CaseError(f"{directory} holds {len(old.loads)} states; {kept} are to be kept")
            for entry in old.entries[:kept]:
                self._list(entry)
            self._index.save(directory / XDMF_NAME)
        else:
            directory.mkdir(parents=True, exist_ok=True)
            (directory / XDMF_NAME).unlink(missing_ok=True)  # what it lists is about to go
            require_space(directory, 2 * (grid.points.nbytes + grid.cells.nbytes))
            with h5py.File(directory / H5_NAME, "w") as file:
                file["points"] = _padded(grid.points)
                file["cells"] = grid.cells.astype(np.int64)
                file.create_group("steps")

    def write(
        self,
        load: float,
        fields: Mapping[str, Array],
        cell_fields: Mapping[str, Array] = MappingProxyType({}),
    ) -> None:
        """Add a state.

        Parameters
        ----------
        load
            Load factor.
        fields
            Scalars (n,) and vectors (n, 2) on the nodes, by name.
        cell_fields
            Scalars (m,) and vectors (m, 2) on the cells, by name.

        Raises
        ------
        ValueError
            If a field has another shape.
        OSError
            If the disk is full; nothing is changed then.
        """
        arrays = _ordered(fields, self._node_order)
        cell_arrays = _ordered(cell_fields, self._cell_order)
        cell_arrays = {f"cells/{name}": values for name, values in cell_arrays.items()}
        new = arrays | cell_arrays
        require_space(self._directory, sum(values.nbytes for values in new.values()))
        # Closed after each step: while it is open it is locked, and nobody could look at it.
        with h5py.File(self._directory / H5_NAME, "r+") as file:
            group = append_step(file, self._count, new)
        self._list(
            StateEntry(
                load=float(load),
                paths={name: f"{group}/{name}" for name in fields},
                cell_paths={name: f"{group}/cells/{name}" for name in cell_fields},
            )
        )
        self._index.save(self._directory / XDMF_NAME)

    def _list(self, entry: StateEntry) -> None:
        with h5py.File(self._directory / H5_NAME, "r") as file:
            nodal, of_cells = (
                {name: Dataset(H5_NAME, path, file[path].shape) for name, path in paths.items()}
                for paths in (entry.paths, entry.cell_paths)
            )
        self._index.add(entry.load, nodal, of_cells)
        self._count += 1


def append_step(file: h5py.File, index: int, arrays: Mapping[str, Array]) -> str:
    """Store the arrays of step `index`, drop any later step, and return the path of its group.

    HDF5 spreads its own records over many writes, and a process that dies between two of them
    can leave a file in which nothing is found. So the list of steps is not changed in place: a
    new list, complete on disk, takes the place of the old one.
    """
    old, name = file["steps"], f"{index:05d}"
    steps = h5py.Group(h5py.h5g.create(file.id, None))
    for earlier in list(old)[:index]:
        steps[earlier] = old[earlier]
    group = steps.create_group(name)
    for key, values in arrays.items():
        group[key] = values
    file.flush()
    del file["steps"]
    file["steps"] = steps
    return f"/steps/{name}"


def _orders_of_old_grid(
    directory: Path, old: FieldGrid, grid: FieldGrid
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows of the nodes and of the cells of a grid in the order of those that are stored."""
    try:
        nodes = same_points(grid.points, old.points)
        numbers = np.empty_like(nodes)
        numbers[nodes] = np.arange(len(nodes))
        return nodes, same_cells(numbers[grid.cells], old.cells)
    except ValueError as error:
        raise CaseError(
            f"the states in {directory} are on another mesh and cannot be continued: {error}"
        ) from None


def _ordered(fields: Mapping[str, Array], order: NDArray[np.int64]) -> dict[str, Array]:
    """Fields as they are stored, if there is a value for each node or cell."""
    allowed = {(len(order),), (len(order), 2)}
    for name, values in fields.items():
        if values.shape not in allowed:
            shapes = ", ".join(map(str, sorted(allowed)))
            raise ValueError(f"{name} has shape {values.shape}; allowed: {shapes}")
    return {
        name: _padded(values[order]) if values.ndim == 2 else np.asarray(values[order], float)
        for name, values in fields.items()
    }


def _padded(vectors: Array) -> Array:
    # Three components, or ParaView's Warp By Vector does not offer the field.
    return np.column_stack([vectors, np.zeros(len(vectors))])
