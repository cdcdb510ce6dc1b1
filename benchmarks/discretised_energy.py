"""A stored energy in finite elements of scikit-fem: its value, residual and tangent.

The energy density is a function of a few vectors, the slots: derivatives along the fibres of the
unknown vector fields, and these fields themselves. Both components of a field have the same scalar
basis, so a field brings, for each of its slots, an operator on scalar shape functions.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations_with_replacement, product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bmat, csc_matrix
from skfem import Basis, BilinearForm
from sparse_assembly import SparseAssembly

Array = NDArray[np.float64]

#: Takes a shape function of scikit-fem to its values at the points, shape (cells, points).
Operator = Callable[[Any], Array]


@dataclass(frozen=True)
class Density:
    """Energy density at the points and its derivatives.

    Attributes
    ----------
    energy
        Shape (cells, points).
    gradient
        By slots, shape (slots, 2, cells, points).
    hessian
        By pairs of slots, shape (2, 2, cells, points) each; pairs that are not there are zero.
    """

    energy: Array
    gradient: Array
    hessian: Mapping[tuple[int, int], Array]


@dataclass(frozen=True)
class VectorField:
    """An unknown field of two components in a scalar basis, and its slots."""

    basis: Basis
    operators: tuple[Operator, ...]

    @cached_property
    def shapes(self) -> Array:
        """Operators on shape functions, shape (cells, points, slots, functions)."""
        functions = [function[0] for function in self.basis.basis]
        values = [[operator(N) for N in functions] for operator in self.operators]
        return np.ascontiguousarray(np.array(values).transpose(2, 3, 0, 1))


class DiscretisedEnergy:
    """Functional of the unknowns: for each field those of u_x, then those of u_y.

    Parameters
    ----------
    fields
        Unknown fields on one mesh with the same quadrature points.
    density
        Energy density of the values of all slots, shape (slots, 2, cells, points).
    forms
        Whether tangents are assembled by forms of scikit-fem, a call for each pair of shape
        functions, or else by products of matrices, one for each pair of fields.
    """

    def __init__(
        self, fields: Sequence[VectorField], density: Callable[[Array], Density], *, forms: bool
    ) -> None:
        self._fields, self._density, self._forms = fields, density, forms
        self._dx = fields[0].basis.dx
        self._cells, self._points = self._dx.shape
        self.size = sum(2 * field.basis.N for field in fields)
        self._dofs = []  # of each component of each field, shape (cells, functions)
        start = 0
        for field in fields:
            for _ in range(2):
                self._dofs.append(field.basis.element_dofs.T.astype(np.int64) + start)
                start += field.basis.N
        ends = np.cumsum([len(field.operators) for field in fields])
        self._slots = [range(a, b) for a, b in zip([0, *ends[:-1]], ends, strict=True)]
        self._assembly: tuple[list[tuple[int, int]], SparseAssembly] | None = None

    @property
    def displacement_basis(self) -> Basis:
        """Scalar basis of the first field, whose dofs of u_x come first, then those of u_y."""
        return self._fields[0].basis

    def density(self, x: Array) -> Density:
        """Energy density at the unknowns x."""
        values = []
        for f, field in enumerate(self._fields):
            parts = [x[self._dofs[2 * f + c]] for c in range(2)]
            shapes = field.shapes.reshape(self._cells, -1, field.basis.Nbfun)
            at_points = shapes @ np.stack(parts, axis=-1)
            at_points = at_points.reshape(self._cells, self._points, -1, 2)
            values.append(at_points.transpose(2, 3, 0, 1))
        return self._density(np.concatenate(values))

    def residual(self, x: Array) -> tuple[float, Array]:
        """Value of the functional and its gradient, shape (size,)."""
        density = self.density(x)
        weighted = (density.gradient * self._dx).transpose(2, 3, 0, 1)
        parts = []
        for field, slots in zip(self._fields, self._slots, strict=True):
            shapes = field.shapes.reshape(self._cells, -1, field.basis.Nbfun)
            stress = weighted[:, :, slots].reshape(self._cells, -1, 2)
            part = shapes.swapaxes(1, 2) @ stress
            parts += [part[..., 0], part[..., 1]]
        gradient = np.zeros(self.size)
        for dofs, part in zip(self._dofs, parts, strict=True):
            gradient += np.bincount(dofs.ravel(), part.ravel(), minlength=self.size)
        return float((density.energy * self._dx).sum()), gradient

    def tangent(self, x: Array) -> csc_matrix:
        """Second derivative of the functional, shape (size, size)."""
        hessian = self.density(x).hessian
        blocks: dict[tuple[int, int], Any] = {}
        for f, g in combinations_with_replacement(range(len(self._fields)), 2):
            pairs = [(s, t) for s in self._slots[f] for t in self._slots[g] if (s, t) in hessian]
            for c, d in product(range(2), range(2)):
                moduli = {pair: hessian[pair][c, d] for pair in pairs}
                below = f == g and c > d
                if not below and any(values.any() for values in moduli.values()):
                    block = self._by_forms if self._forms else self._by_products
                    blocks[2 * f + c, 2 * g + d] = block(f, g, moduli)
        return self._from_forms(blocks) if self._forms else self._from_products(blocks)

    def _by_products(self, f: int, g: int, moduli: Mapping[tuple[int, int], Array]) -> Array:
        left, right = self._fields[f].shapes, self._fields[g].shapes
        C = np.zeros((self._cells, self._points, left.shape[2], right.shape[2]))
        for (s, t), values in moduli.items():
            C[:, :, s - self._slots[f][0], t - self._slots[g][0]] = values * self._dx
        right = (C @ right).reshape(self._cells, -1, right.shape[3])
        return left.reshape(self._cells, -1, left.shape[3]).swapaxes(1, 2) @ right

    def _from_products(self, blocks: Mapping[tuple[int, int], Array]) -> csc_matrix:
        full = dict(blocks)
        full |= {(j, i): block.swapaxes(1, 2) for (i, j), block in blocks.items()}
        if self._assembly is None or self._assembly[0] != list(full):
            places = [(self._dofs[i], self._dofs[j]) for i, j in full]
            self._assembly = list(full), SparseAssembly(places, self.size)
        return self._assembly[1].matrix(list(full.values()))

    def _by_forms(self, f: int, g: int, moduli: Mapping[tuple[int, int], Array]) -> csc_matrix:
        tests = [(s, op) for s, op in zip(self._slots[f], self._fields[f].operators, strict=True)]
        trials = [(t, op) for t, op in zip(self._slots[g], self._fields[g].operators, strict=True)]

        def form(u: Any, v: Any, w: Any) -> Array:
            fluxes = [(t, operator(u)) for t, operator in trials]
            return sum(
                operator(v) * sum(w[f"C{s}{t}"] * flux for t, flux in fluxes if (s, t) in moduli)
                for s, operator in tests
                if any((s, t) in moduli for t, _ in trials)
            )

        named = {f"C{s}{t}": values for (s, t), values in moduli.items()}
        return BilinearForm(form).assemble(self._fields[g].basis, self._fields[f].basis, **named)

    def _from_forms(self, blocks: Mapping[tuple[int, int], csc_matrix]) -> csc_matrix:
        count = 2 * len(self._fields)
        table: list[list[Any]] = [[None] * count for _ in range(count)]
        for (i, j), block in blocks.items():
            table[i][j] = block
            if i != j:
                table[j][i] = block.T
        return bmat(table, "csc")
