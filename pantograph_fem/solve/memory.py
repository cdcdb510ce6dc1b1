"""Memory of PETSc objects that nobody uses any more.

What Python drops, petsc4py only puts aside: processes drop objects at different moments, and
destroying one takes all of them. It is taken up by a clean-up of the communicator, which is gone
itself once the mesh is.
"""

from __future__ import annotations

import weakref

from petsc4py import PETSc


def destroy_with(owner: object, thing: PETSc.Object) -> None:
    """Destroy a large object with its owner, where there is no other process to wait for."""
    if thing.comm.size == 1:
        weakref.finalize(owner, thing.destroy)


def clean_up(thing: PETSc.Object) -> None:
    """Destroy what was put aside on the communicator of an object; a collective call."""
    PETSc.garbage_cleanup(thing.comm)
