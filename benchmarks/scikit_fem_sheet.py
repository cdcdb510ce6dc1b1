"""The bias extension test of cases/a_bias_extension.toml, written with scikit-fem.

It shares no code with pantograph_fem. Both grips hold the position of their edge, the top one is
moved by 0.0567 m. Prints a line of JSON: force (N), energy (J), dofs, cells, CPU seconds of the
process, those by stage, and numbers of tangents and residuals.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
import scipy
import skfem
from centred_elements import CentredArgyris, CentredBFS
from load_path import Pull, follow
from schemes import c1_scheme, micromorphic_scheme
from sheet_material import Material
from sheet_meshes import HEIGHT, rectangles, triangles_of_file, uniform_triangles

#: Displacement of the top edge, m.
TRANSLATION = 0.0567
#: Order of SuperLU for a definite matrix, which needs no pivots. For the saddle point it is its
#: default: without pivots the factor fills up or is useless.
DEFINITE = {
    "permc_spec": "MMD_AT_PLUS_A",
    "diag_pivot_thresh": 0.0,
    "options": {"SymmetricMode": True},
}


def main() -> None:
    """Run what the command line asks for."""
    arguments = _arguments()
    forms = arguments.assembly == "forms"
    material = Material()
    if arguments.scheme == "bfs":
        mesh = rectangles(arguments.size, arguments.corner_size)
    elif arguments.mesh_file:
        mesh = triangles_of_file(arguments.mesh_file)
    else:
        mesh = uniform_triangles(arguments.size)
    if arguments.scheme == "micromorphic":
        order = arguments.order or arguments.degree + 2
        energy = micromorphic_scheme(mesh, material, arguments.degree, order, forms=forms)
    else:
        element = CentredBFS() if arguments.scheme == "bfs" else CentredArgyris()
        order = arguments.order or (5 if arguments.scheme == "bfs" else 7)
        energy = c1_scheme(mesh, material, element, order, forms=forms)
    options: dict[str, Any] = {} if arguments.scheme == "micromorphic" else DEFINITE
    prescribed, moved = _grips(energy.displacement_basis)
    values = np.zeros(energy.size)
    values[moved] = TRANSLATION
    pull = Pull(prescribed, values)
    path = follow(energy, pull, options, keep_factor=arguments.newton == "modified")
    result = {
        "force": path.works[-1] / TRANSLATION,
        "energy": path.energies[-1],
        "dofs": int(energy.size),
        "cells": int(mesh.nelements),
        "steps": len(path.loads),
        "tangents": path.tangents,
        "residuals": path.residuals,
        "cpu_seconds": process_time(),
        "seconds": path.seconds,
        "versions": {m.__name__: m.__version__ for m in (skfem, scipy, np)},
    }
    print(json.dumps(result))


def _grips(basis: skfem.Basis) -> tuple[np.ndarray, np.ndarray]:
    """Dofs of both edges, with the derivatives along them, and those of the pull in y."""
    bottom = basis.get_dofs(lambda x: x[1] == 0.0)
    top = basis.get_dofs(lambda x: x[1] == HEIGHT)
    along = [name for name in ("u", "u_x", "u_xx") if name in basis.elem.dofnames]
    held = np.concatenate([edge.all(along) for edge in (bottom, top)])
    return np.concatenate([held, held + basis.N]), top.all(["u"]) + basis.N


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--scheme",
        choices=("argyris", "bfs", "micromorphic"),
        default="argyris",
        help="displacement alone, in triangles or rectangles of C1; or the paper's scheme",
    )
    parser.add_argument("--degree", type=int, choices=(2, 3), default=3, help="of micromorphic")
    parser.add_argument("--order", type=int, help="of the quadrature; by default per scheme")
    parser.add_argument("--size", type=float, default=0.0068, help="of the elements, m")
    parser.add_argument("--corner-size", type=float, help="at the corners, m; of bfs alone")
    parser.add_argument("--mesh-file", type=Path, help=".npz with points and triangles")
    parser.add_argument("--assembly", choices=("products", "forms"), default="products")
    parser.add_argument("--newton", choices=("modified", "full"), default="modified")
    return parser.parse_args()


if __name__ == "__main__":
    main()
