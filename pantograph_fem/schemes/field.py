"""One field of a (possibly mixed) finite element space, with its place in the state vector."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dolfinx import fem

from .. import dolfinx_api as api
from ..numbering import same_points


@dataclass(frozen=True)
class Field:
    """A field of the state.

    Attributes
    ----------
    name
        "displacement", "gradient" or "multiplier".
    space
        The field's own space.
    dofs
        State dof of each of the field's dofs, shape (blocks, block size), ghosts included.
    typical
        Typical size in SI units; solvers measure the field in it.
    multiplier
        Whether the energy is stationary but not minimal with respect to it.
    """

    name: str
    space: fem.FunctionSpace
    dofs: NDArray[np.int32]
    typical: float
    multiplier: bool = False

    @property
    def size(self) -> int:
        """Number of dofs over all processes."""
        dofmap = self.space.dofmap
        return dofmap.index_map.size_global * dofmap.index_map_bs

    @property
    def coordinates(self) -> NDArray[np.float64]:
        """Reference position of each block, shape (blocks, 2); that of a beam is along x."""
        return self.space.tabulate_dof_coordinates()[:, :2]

    def blocks_on(self, facets: NDArray[np.int32]) -> NDArray[np.int32]:
        """Numbers of the blocks on some facets: edges of a sheet, ends of a beam; collective."""
        return fem.locate_dofs_topological(self.space, self.space.mesh.topology.dim - 1, facets)


def fields_of(
    space: fem.FunctionSpace, typical: dict[str, float], multipliers: tuple[str, ...] = ()
) -> tuple[Field, ...]:
    """Fields of a space in the order of `typical`, which gives their names and sizes."""
    fields = []
    for index, (name, size) in enumerate(typical.items()):
        if space.num_sub_spaces and len(typical) > 1:
            own, dofs = _part(space, index)
        else:
            own = space
            dofs = np.arange(api.local_size(space), dtype=np.int32)
            dofs = dofs.reshape(-1, own.dofmap.index_map_bs)
        fields.append(Field(name, own, dofs, size, name in multipliers))
    return tuple(fields)


def _part(space: fem.FunctionSpace, index: int) -> tuple[fem.FunctionSpace, NDArray[np.int32]]:
    """A space like one part of a mixed space, and the dofs of that part by its blocks.

    The part itself, collapsed, will not do: in dolfinx 0.5 it takes the two nodes of a cubic edge
    for one another where the edge runs the other way in a neighbour. Its coordinates are right.
    """
    part, dofs = space.sub(index).collapse()
    own = api.functionspace(space.mesh, part.ufl_element())
    blocks = same_points(part.tabulate_dof_coordinates(), own.tabulate_dof_coordinates())
    return own, np.asarray(dofs, dtype=np.int32).reshape(-1, own.dofmap.index_map_bs)[blocks]
