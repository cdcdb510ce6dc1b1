"""What a series of meshes says about the accuracy of the last."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

from .estimate import remaining_error

Quantity = Literal["force", "energy"]


@dataclass(frozen=True)
class FullLoad:
    """The state at the end of the path: force of the top grip (N), stored energy (J), stability."""

    force: tuple[float, float]
    energy: float
    stable: bool


@dataclass(frozen=True)
class MeshRecord:
    """One mesh of the series.

    Attributes
    ----------
    cells, dofs
        Its size.
    state
        What was found on it; None where the path stopped before its end.
    error_force, error_energy
        Estimated errors, relative to the values themselves; infinite where there is no estimate.
    """

    cells: int
    dofs: int
    state: FullLoad | None
    error_force: float = math.inf
    error_energy: float = math.inf

    def error(self, of: Quantity) -> float:
        """Estimated relative error of one of the two."""
        return self.error_force if of == "force" else self.error_energy

    def as_dict(self) -> dict[str, Any]:
        """For ``summary.json``; an error that is not known is None."""
        return {
            "cells": self.cells,
            "dofs": self.dofs,
            "force": None if self.state is None else list(self.state.force),
            "energy": None if self.state is None else self.state.energy,
            "estimated_error_force": _known(self.error_force),
            "estimated_error_energy": _known(self.error_energy),
        }


@dataclass(frozen=True)
class Accuracy:
    """What was asked, and the series of meshes by which it was, or was not, reached."""

    of: Quantity
    asked: float
    meshes: tuple[MeshRecord, ...] = ()

    @property
    def last(self) -> MeshRecord:
        """The mesh whose path is recorded."""
        return self.meshes[-1]

    @property
    def error(self) -> float:
        """Estimated relative error of what the accuracy was asked of."""
        return self.last.error(self.of) if self.meshes else math.inf

    @property
    def reached(self) -> bool:
        """Whether the estimate is within what was asked."""
        return self.error <= self.asked

    def with_mesh(self, cells: int, dofs: int, state: FullLoad | None, order: float) -> Accuracy:
        """The series with one mesh more, and the errors that are left on that one."""
        record = MeshRecord(cells, dofs, state)
        if state is not None:
            earlier = [(m.dofs, m.state) for m in self.meshes if m.state is not None]
            numbers, states = zip(*earlier, (dofs, state), strict=True)
            force = remaining_error(numbers, [s.force for s in states], order)
            energy = remaining_error(numbers, [(s.energy,) for s in states], order)
            record = replace(
                record,
                error_force=_relative(force, math.hypot(*state.force)),
                error_energy=_relative(energy, abs(state.energy)),
            )
        return replace(self, meshes=(*self.meshes, record))

    def at_end(self, end: tuple[tuple[float, float], float] | None) -> Accuracy:
        """With what the recorded path ended at: force and energy, or None where it stopped before.

        Should it be another state than the one that was estimated, how far it is from that one is
        added to both errors. Where the path stopped, no error is known.
        """
        state = self.last.state
        last = replace(self.last, state=None, error_force=math.inf, error_energy=math.inf)
        if end is not None and state is not None:
            force, energy = end
            off = math.hypot(force[0] - state.force[0], force[1] - state.force[1])
            last = replace(
                self.last,
                state=replace(state, force=force, energy=energy),
                error_force=self.last.error_force + _relative(off, math.hypot(*force)),
                error_energy=self.last.error_energy
                + _relative(abs(energy - state.energy), abs(energy)),
            )
        return replace(self, meshes=(*self.meshes[:-1], last))

    def as_dict(self) -> dict[str, Any]:
        """For ``summary.json``."""
        return {
            "of": self.of,
            "asked": self.asked,
            "reached": self.reached,
            "estimated_error_force": _known(self.last.error_force),
            "estimated_error_energy": _known(self.last.error_energy),
            "meshes": [mesh.as_dict() for mesh in self.meshes],
        }

    @classmethod
    def from_dict(cls, table: dict[str, Any]) -> Accuracy:
        """Inverse of :meth:`as_dict`, as far as a run that is resumed needs it."""
        return cls(table["of"], table["asked"], tuple(_record(m) for m in table["meshes"]))

    def sentence(self) -> str:
        """The estimated errors in words."""
        error_force, error_energy = (
            f"{error:.1e}" if math.isfinite(error) else "unknown"
            for error in (self.last.error_force, self.last.error_energy)
        )
        text = f"Estimated relative error: force {error_force}, energy {error_energy}"
        if self.reached:
            return f"{text}; mesh.accuracy = {self.asked:g} of the {self.of} is reached."
        return (
            f"Warning: {text}; mesh.accuracy = {self.asked:g} of the {self.of} is NOT reached "
            f"with {self.last.dofs} unknowns. Ask for less, or use a higher discretisation.degree "
            "or discretisation.quadrature_degree."
        )


def mesh_line(number: int, record: MeshRecord) -> str:
    """One mesh as a line of progress."""
    text = f"mesh {number}  cells {record.cells}  unknowns {record.dofs}"
    if record.state is None:
        return f"{text}  the path stopped before its end"
    text += f"  force {math.hypot(*record.state.force):.6g} N  energy {record.state.energy:.6g} J"
    if math.isfinite(record.error_force):
        text += (
            f"  estimated errors: force {record.error_force:.1e}, energy {record.error_energy:.1e}"
        )
    return text


def _relative(error: float, value: float) -> float:
    return error / value if value > 0.0 else (math.inf if error > 0.0 else 0.0)


def _known(error: float) -> float | None:
    return error if math.isfinite(error) else None


def _record(table: dict[str, Any]) -> MeshRecord:
    force: Sequence[float] | None = table["force"]
    errors = (
        math.inf if table[key] is None else float(table[key])
        for key in ("estimated_error_force", "estimated_error_energy")
    )
    state = None if force is None else FullLoad((force[0], force[1]), table["energy"], True)
    return MeshRecord(table["cells"], table["dofs"], state, *errors)
