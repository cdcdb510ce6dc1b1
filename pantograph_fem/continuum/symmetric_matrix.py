"""Half of a symmetric matrix, with a place for every entry that assembly makes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from petsc4py import PETSc

import dolfinx.fem.petsc  # noqa: F401
from dolfinx import fem

if TYPE_CHECKING:
    from dolfinx.fem import Form


def create_symmetric_matrix(a: Form) -> PETSc.Mat:
    """Upper half of a matrix with the sparsity of a symmetric bilinear form; a collective call.

    Half of the places to look up: assembly takes half of the time, and the factorisation needs no
    copy of a half.
    """
    full = fem.petsc.create_matrix(a)
    fem.petsc.assemble_matrix(full, a)  # else places without a value are dropped
    full.assemble()
    half = PETSc.Mat().create(full.comm)
    half.setSizes(full.getSizes(), full.getBlockSize())
    half.setType(PETSc.Mat.Type.SBAIJ)
    # Not by MatConvert, whose time grows with the square of the size.
    half.setPreallocationCSR(_upper_blocks(full))
    half.setLGMap(*full.getLGMap())
    half.setOption(PETSc.Mat.Option.IGNORE_LOWER_TRIANGULAR, True)
    full.destroy()
    return half


def _upper_blocks(full: PETSc.Mat) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Where the rows of this process start, and the columns of their blocks, from the diagonal on.

    Columns are numbered over all processes; blocks are full.
    """
    size = full.getBlockSize()
    starts, columns, _ = full.getValuesCSR()
    lengths = np.diff(starts)
    # One row of each row of blocks, and one column of each block, tell of all.
    chosen = np.repeat(np.arange(len(lengths)) % size == 0, lengths)
    blocks = columns[chosen][::size] // size
    lengths = lengths[::size] // size
    local = np.repeat(np.arange(len(lengths)), lengths)
    upper = blocks >= local + full.getOwnershipRange()[0] // size
    counts = np.bincount(local[upper], minlength=len(lengths))
    return np.concatenate([[0], np.cumsum(counts)]).astype(starts.dtype), blocks[upper]
