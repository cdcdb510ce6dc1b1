"""Nodal fields at every accepted step, in XDMF and HDF5: for ParaView, meshio and the figures.

``fields.h5`` holds the output grid once and a group of arrays a step; ``fields.xdmf`` says which
of them make up the state at which load. At each step the arrays are stored first and listed
afterwards, so all that is listed can be read, also while the run goes on or if it is killed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
from numpy.typing import NDArray

from ..errors import CaseError
from .xdmf import Dataset, StateEntry, XdmfIndex, read_index

XDMF_NAME = "fields.xdmf"
H5_NAME = "fields.h5"

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FieldGrid:
    """Reference configuration of the nodes on which fields are written.

    Attributes
    ----------
    points
        Reference coordinates in m, shape (n, 2).
    triangles
        Node numbers of each triangle, shape (m, 3).
    """

    points: Array
    triangles: NDArray[np.integer]


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
        self._nodes = len(grid.points)
        self._index = XdmfIndex(
            points=Dataset(H5_NAME, "/points", (self._nodes, 3)),
            triangles=Dataset(H5_NAME, "/triangles", grid.triangles.shape),
        )
        self._count = 0
        if kept:
            for entry in _states_to_keep(directory, grid, kept):
                self._list(entry.load, entry.paths, _shapes(directory / H5_NAME, entry))
            self._index.save(directory / XDMF_NAME)
        else:
            directory.mkdir(parents=True, exist_ok=True)
            (directory / XDMF_NAME).unlink(missing_ok=True)  # what it lists is about to go
            with h5py.File(directory / H5_NAME, "w") as file:
                file["points"] = _padded(grid.points)
                file["triangles"] = grid.triangles.astype(np.int64)
                file.create_group("steps")

    def write(self, load: float, fields: Mapping[str, Array]) -> None:
        """Add the state at a load factor: scalars (n,) and vectors (n, 2) by name."""
        n = self._nodes
        for name, values in fields.items():
            if values.shape not in {(n,), (n, 2)}:
                raise ValueError(f"{name} has shape {values.shape}; allowed: ({n},), ({n}, 2)")
        arrays = {
            name: _padded(values) if values.ndim == 2 else np.asarray(values, float)
            for name, values in fields.items()
        }
        # Closed after each step: while it is open it is locked, and nobody could look at it.
        with h5py.File(self._directory / H5_NAME, "r+") as file:
            group = append_step(file, self._count, arrays)
        paths = {name: f"{group}/{name}" for name in arrays}
        self._list(float(load), paths, {name: a.shape for name, a in arrays.items()})
        self._index.save(self._directory / XDMF_NAME)

    def _list(
        self, load: float, paths: Mapping[str, str], shapes: Mapping[str, tuple[int, ...]]
    ) -> None:
        fields = {name: Dataset(H5_NAME, path, shapes[name]) for name, path in paths.items()}
        self._index.add(load, fields)
        self._count += 1


@dataclass(frozen=True, eq=False)
class FieldSeries:
    """States read back from a results directory.

    Attributes
    ----------
    grid
        Reference configuration.
    loads
        Load factor of each state, shape (k,).
    """

    grid: FieldGrid
    loads: Array
    _h5_path: Path
    _entries: tuple[StateEntry, ...]

    def fields(self, index: int) -> dict[str, Array]:
        """Return the fields of a state by name: scalars (n,), vectors (n, 2)."""
        with h5py.File(self._h5_path, "r") as file:
            arrays = {name: file[path][()] for name, path in self._entries[index].paths.items()}
        return {name: a[:, :2] if a.ndim == 2 else a for name, a in arrays.items()}


def read_fields(directory: Path) -> FieldSeries:
    """Read the states that a run, finished or not, has left in a directory.

    Raises
    ------
    CaseError
        If the directory holds no states, or they cannot be read.
    """
    xdmf_path, h5_path = directory / XDMF_NAME, directory / H5_NAME
    if not xdmf_path.is_file() or not h5_path.is_file():
        raise CaseError(
            f"{directory} holds no results: {XDMF_NAME} with {H5_NAME} is missing. "
            "`pantograph run CASE.toml` writes them."
        )
    try:
        entries = tuple(read_index(xdmf_path))
        with h5py.File(h5_path, "r") as file:
            grid = FieldGrid(file["points"][:, :2], file["triangles"][()])
    except (ValueError, LookupError, SyntaxError, OSError) as error:
        raise CaseError(
            f"{xdmf_path} with {H5_NAME} cannot be read as the results of a run: {error}"
        ) from error
    return FieldSeries(grid, np.array([entry.load for entry in entries]), h5_path, entries)


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


def _states_to_keep(directory: Path, grid: FieldGrid, kept: int) -> tuple[StateEntry, ...]:
    series = read_fields(directory)
    old = series.grid
    if len(series.loads) < kept:
        raise CaseError(f"{directory} holds {len(series.loads)} states; {kept} are to be kept")
    if not np.array_equal(old.triangles, grid.triangles) or not (
        old.points.shape == grid.points.shape and np.allclose(old.points, grid.points)
    ):
        raise CaseError(f"the states in {directory} are on another mesh and cannot be continued")
    return series._entries[:kept]


def _shapes(h5_path: Path, entry: StateEntry) -> dict[str, tuple[int, ...]]:
    with h5py.File(h5_path, "r") as file:
        return {name: file[path].shape for name, path in entry.paths.items()}


def _padded(vectors: Array) -> Array:
    # Three components, or ParaView's Warp By Vector does not offer the field.
    return np.column_stack([vectors, np.zeros(len(vectors))])
