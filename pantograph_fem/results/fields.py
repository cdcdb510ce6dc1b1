"""Fields at every accepted step, in XDMF and HDF5: for ParaView, meshio and the figures.

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
from .xdmf import StateEntry, read_index

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
    cells
        Node numbers of each triangle of a sheet, shape (m, 3), or of each line of a lattice, a
        beam or a chain, shape (m, 2).
    """

    points: Array
    cells: NDArray[np.integer]


@dataclass(frozen=True, eq=False)
class FieldSeries:
    """States read back from a results directory.

    Attributes
    ----------
    grid
        Reference configuration.
    loads
        Load factor of each state, shape (k,).
    h5_path, entries
        Where the arrays are, and which of them are each state's.
    """

    grid: FieldGrid
    loads: Array
    h5_path: Path
    entries: tuple[StateEntry, ...]

    def fields(self, index: int) -> dict[str, Array]:
        """Return the nodal fields of a state by name: scalars (n,), vectors (n, 2)."""
        return self._read(self.entries[index].paths)

    def cell_fields(self, index: int) -> dict[str, Array]:
        """Return the cell fields of a state by name: scalars (m,), vectors (m, 2)."""
        return self._read(self.entries[index].cell_paths)

    def _read(self, paths: Mapping[str, str]) -> dict[str, Array]:
        with h5py.File(self.h5_path, "r") as file:
            arrays = {name: file[path][()] for name, path in paths.items()}
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
            grid = FieldGrid(file["points"][:, :2], file["cells"][()])
    except (ValueError, LookupError, SyntaxError, OSError) as error:
        raise CaseError(
            f"{xdmf_path} with {H5_NAME} cannot be read as the results of a run: {error}"
        ) from error
    return FieldSeries(grid, np.array([entry.load for entry in entries]), h5_path, entries)
