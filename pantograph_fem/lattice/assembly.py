"""From blocks of second derivatives to the rows of a sparse matrix that one process owns."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from mpi4py import MPI
from petsc4py import PETSc

from .energy import Blocks, NetEnergy

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


class TangentRows:
    """The rows of the nodes from `first` to before `last`, with a sparsity found once.

    Rows and columns of held unknowns become the identity's.
    """

    def __init__(self, energy: NetEnergy, held: NDArray[np.bool_], first: int, last: int) -> None:
        """Find the sparsity.

        Parameters
        ----------
        energy
            Of a net that has all springs of the nodes.
        held
            Whether each unknown of all nodes is held, shape (2n,).
        first, last
            The nodes.
        """
        size = energy.net.size
        self._first = first
        rows, columns, sources, signs = _places(energy)
        own = (first <= rows) & (rows < last)
        diagonal = np.arange(first, last)
        keys = np.concatenate([rows[own] * size + columns[own], diagonal * size + diagonal])
        unique, places = np.unique(keys, return_inverse=True)
        places = places[: np.count_nonzero(own)]
        count = len(energy.net.links) + 2 * len(energy.pairs)
        if energy.net.ground is not None:
            count += size
        self._sum = sp.csr_matrix((signs[own], (places, sources[own])), shape=(len(unique), count))
        starts = np.searchsorted(unique // size, np.arange(first, last + 1))
        # An array that counts its own entries tells where each goes when blocks become rows.
        numbers = np.arange(4.0 * len(unique)).reshape(-1, 2, 2)
        pattern = sp.bsr_matrix(
            (numbers, unique % size, starts), shape=(2 * (last - first), 2 * size)
        ).tocsr()
        pattern.sort_indices()
        self._order = pattern.data.astype(np.int64)
        self._pattern = pattern
        row = np.repeat(np.arange(pattern.shape[0]), np.diff(pattern.indptr)) + 2 * first
        fixed = held[row] | held[pattern.indices]
        self._zeros = np.flatnonzero(fixed)
        self._ones = np.flatnonzero(fixed & (row == pattern.indices))

    def derivatives(self, blocks: Blocks) -> sp.csr_matrix:
        """The second derivatives themselves, nothing held; shape (own unknowns, 2n)."""
        self._pattern.data = self._data(blocks)
        return self._pattern

    def matrix(self, comm: MPI.Comm) -> PETSc.Mat:
        """An empty matrix with the sparsity; a collective call."""
        own, all_ = self._pattern.shape
        A = PETSc.Mat().createAIJ(
            ((own, all_), (own, all_)), csr=(*self._indices, np.zeros(self._pattern.nnz)), comm=comm
        )
        A.assemble()
        return A

    def fill(self, blocks: Blocks, A: PETSc.Mat) -> None:
        """Put the second derivatives into the matrix; a collective call."""
        data = self._data(blocks)
        data[self._zeros] = 0.0
        data[self._ones] = 1.0
        A.setValuesCSR(*self._indices, data)
        A.assemble()

    @property
    def _indices(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        kind = PETSc.IntType
        return self._pattern.indptr.astype(kind), self._pattern.indices.astype(kind)

    def _data(self, blocks: Blocks) -> Array:
        transposed = blocks.pairs.transpose(0, 2, 1)
        sources = np.concatenate([blocks.links, blocks.pairs, transposed, blocks.nodes])
        return (self._sum @ sources.reshape(-1, 4)).ravel()[self._order]


def _places(energy: NetEnergy) -> tuple[IntArray, IntArray, IntArray, Array]:
    """Row, column, number and sign of every block that enters somewhere: see :class:`Blocks`.

    Blocks are numbered in the order links, pairs, pairs transposed, nodes.
    """
    links, pairs = energy.net.links, energy.pairs
    sides = np.array([[0, 0], [0, 1], [1, 0], [1, 1]])
    signs = np.where(sides[:, 0] == sides[:, 1], 1.0, -1.0)
    own = np.arange(len(links))
    groups = []
    for first, second in ((own, own), (pairs[:, 0], pairs[:, 1]), (pairs[:, 1], pairs[:, 0])):
        groups.append((links[first][:, sides[:, 0]], links[second][:, sides[:, 1]]))
    rows = np.concatenate([row for row, _ in groups]).ravel()
    columns = np.concatenate([column for _, column in groups]).ravel()
    count = len(links) + 2 * len(pairs)
    numbers = np.repeat(np.arange(count), len(sides))
    all_signs = np.tile(signs, count)
    if energy.net.ground is None:
        return rows, columns, numbers, all_signs
    nodes = np.arange(energy.net.size)
    return (
        np.concatenate([rows, nodes]),
        np.concatenate([columns, nodes]),
        np.concatenate([numbers, count + nodes]),
        np.concatenate([all_signs, np.ones(energy.net.size)]),
    )
