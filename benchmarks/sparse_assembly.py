"""Sum of element matrices into a sparse matrix whose pattern stays the same."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix

Array = NDArray[np.float64]
Dofs = NDArray[np.int64]


class SparseAssembly:
    """Where each entry of the blocks of the element matrices goes."""

    def __init__(self, blocks: Sequence[tuple[Dofs, Dofs]], size: int) -> None:
        """`blocks` have the dofs of their rows and columns, shape (cells, n) and (cells, m)."""
        keys = []
        for rows, columns in blocks:
            keys.append((columns[:, None, :] * size + rows[:, :, None]).ravel())
        unique, self._places = np.unique(np.concatenate(keys), return_inverse=True)
        self._indices = (unique % size).astype(np.int32)
        counts = np.bincount(unique // size, minlength=size)
        self._pointers = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
        self._size = size

    def matrix(self, blocks: Sequence[Array]) -> csc_matrix:
        """Assemble the blocks, shape (cells, n, m) each, in the order of their dofs."""
        values = np.concatenate([block.ravel() for block in blocks])
        data = np.bincount(self._places, values, minlength=len(self._indices))
        shape = (self._size, self._size)
        return csc_matrix((data, self._indices, self._pointers), shape=shape)
