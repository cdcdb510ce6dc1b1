"""The file ``adapted_mesh.npz``: the mesh to which a checkpoint belongs, and its accuracy."""

from __future__ import annotations

import json
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from ..errors import CaseError
from ..mesh import Triangulation
from . import MESH_FILE
from .accuracy import Accuracy


def save_mesh(directory: Path, mesh: Triangulation, accuracy: Accuracy) -> None:
    """Write the file into a folder of results, which is made if need be."""
    directory.mkdir(parents=True, exist_ok=True)
    np.savez(
        directory / MESH_FILE,
        points=mesh.points,
        triangles=mesh.triangles,
        accuracy=json.dumps(accuracy.as_dict()),
        **{f"edges_{grip}": edges for grip, edges in mesh.edges.items()},
    )


def load_mesh(directory: Path) -> tuple[Triangulation, Accuracy]:
    """Read the file.

    Raises
    ------
    CaseError
        If it is missing or damaged.
    """
    path = directory / MESH_FILE
    try:
        with np.load(path) as file:
            edges = {
                name.removeprefix("edges_"): file[name]
                for name in file.files
                if name.startswith("edges_")
            }
            mesh = Triangulation(file["points"], file["triangles"], edges)
            return mesh, Accuracy.from_dict(json.loads(str(file["accuracy"])))
    except (ValueError, KeyError, OSError, EOFError, BadZipFile) as error:
        raise CaseError(
            f"{path}, the mesh of the interrupted run, cannot be read ({error}); "
            "start anew without --resume"
        ) from error
