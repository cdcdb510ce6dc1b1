"""The file ``summary.json``: how a run ended, what it cost and what it ran on."""

from __future__ import annotations

import platform
import sys
from collections.abc import Mapping, Sequence
from importlib import metadata
from pathlib import Path

from .atomic import replace_text
from .history import HistoryRow
from .strict_json import to_json

DONE = "done"
CRITICAL = "stopped at a critical load"

PHASES = ("mesh", "compile", "assemble", "solve", "output", "total")

# Names of the distributions, which are not always those of the modules.
PACKAGES = {
    "pantograph_fem": "pantograph_fem",
    "dolfinx": "fenics-dolfinx",
    "ufl": "fenics-ufl",
    "petsc4py": "petsc4py",
    "mpi4py": "mpi4py",
    "gmsh": "gmsh",
    "numpy": "numpy",
}


def write_summary(
    path: Path,
    *,
    status: str,
    last: HistoryRow | None,
    dofs: Mapping[str, int],
    cells: int,
    seconds: Mapping[str, float],
    versions: Mapping[str, str],
    message: str = "",
    accuracy: Mapping[str, object] | None = None,
    critical_points: Sequence[Mapping[str, object]] = (),
    cutbacks: int = 0,
) -> None:
    """Write ``summary.json`` in one step, so that it is never half a file.

    Parameters
    ----------
    path
        The file.
    status
        "done", "stopped at a critical load" where that was asked for, or "stopped: " and the
        reason.
    last
        The last accepted state, None if there was none; written with the columns of
        ``history.csv``, null where one is no number.
    dofs
        Number of degrees of freedom by field.
    cells
        Number of cells of the mesh.
    seconds
        Wall time by phase, see `PHASES`; a phase that is not given took no time.
    versions
        Version by package, as `package_versions` returns them.
    message
        What the user was told at the end.
    accuracy
        What was asked of an adapted mesh and what it reached; None, and left out, for others.
    critical_points
        Step, load, kind and number of modes of each critical point; left out where there is none.
    cutbacks
        Number of steps that were rejected and tried again with a smaller one.

    Raises
    ------
    ValueError
        If the status or a phase is none of those above.
    """
    if status not in (DONE, CRITICAL) and not status.startswith("stopped: "):
        allowed = f'"{DONE}", "{CRITICAL}" and "stopped: <reason>"'
        raise ValueError(f"status is {status!r}; allowed are {allowed}")
    if unknown := set(seconds) - set(PHASES):
        raise ValueError(f"unknown phases {sorted(unknown)}; allowed are {', '.join(PHASES)}")
    summary: dict[str, object] = {
        "status": status,
        "message": message,
        "last": None if last is None else last.columns(),
        "dofs": {name: int(number) for name, number in dofs.items()},
        "cells": int(cells),
        "cutbacks": int(cutbacks),
        "seconds": {phase: round(float(seconds.get(phase, 0.0)), 3) for phase in PHASES},
        "versions": dict(versions),
    }
    if accuracy is not None:
        summary["accuracy"] = dict(accuracy)
    if critical_points:
        summary["critical_points"] = [dict(point) for point in critical_points]
    replace_text(path, to_json(summary))


def package_versions() -> dict[str, str]:
    """Return the versions of Python and of the packages a run rests on, importing none.

    Debian's gmsh is no distribution; only the module knows, where the run has needed it.
    """
    versions = {"python": platform.python_version()}
    for name, distribution in PACKAGES.items():
        try:
            versions[name] = metadata.version(distribution)
        except metadata.PackageNotFoundError:
            if name in sys.modules:
                versions[name] = getattr(sys.modules[name], "__version__", "unknown")
    return versions
