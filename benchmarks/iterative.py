"""Iterative solvers against the direct one: one tangent of the hinge scheme, degree 3.

The tangent of the bias extension test at a load of 2 % is positive definite, so conjugate gradients
serve. Each mesh has a process of its own, in which each preconditioner is set up and solves for the
direction of the path, to 1e-8 in the norm of the energy. Writes docs/iterative.csv and prints a
table.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from time import process_time

from cost_growth import COARSEST, LOAD, SHRINK
from overlapping_schwarz import interpolation_of_linears, whole_matrix
from programs import CASE, HERE, LEAN, ONE_THREAD
from rows import write_rows

from petsc4py import PETSc

from pantograph_fem.case import SheetCase, load_case

#: Relative error at which iterations end, and how many there may be.
TOLERANCE, MOST = 1e-8, 600
#: Unknowns of a subdomain, and the layers of nodes by which subdomains overlap.
SUBDOMAIN, OVERLAP = 16_000, 4
#: Share of the sum of corrections that is taken; a node lies in up to four subdomains.
DAMPING = 0.3

_CHOLMOD = {"pc_type": "cholesky", "pc_factor_mat_solver_type": "cholmod"}
_SCHWARZ = {
    "pc_type": "asm",
    "pc_asm_type": "basic",
    "pc_asm_overlap": OVERLAP,
    **{f"sub_{key}": value for key, value in _CHOLMOD.items()},
}
#: PETSc's options of each solver; `pc_asm_blocks` depends on the mesh.
SOLVERS: dict[str, dict[str, object]] = {
    "direct": {
        "ksp_type": "preonly",
        "pc_type": "cholesky",
        "pc_factor_mat_solver_type": "mumps",
    },
    "two-level Schwarz": {
        "pc_type": "mg",
        "pc_mg_galerkin": "both",
        "mg_levels_ksp_type": "richardson",
        "mg_levels_ksp_max_it": 1,
        "mg_levels_ksp_richardson_scale": DAMPING,
        **{f"mg_levels_{key}": value for key, value in _SCHWARZ.items()},
        **{f"mg_coarse_{key}": value for key, value in _CHOLMOD.items()},
    },
    "one-level Schwarz": _SCHWARZ,
    "BoomerAMG": {"pc_type": "hypre", "pc_hypre_boomeramg_strong_threshold": 0.6},
    "GAMG": {"pc_type": "gamg", "mg_levels_ksp_max_it": 4},
}
#: Unknowns up to which the last two come to an end in a reasonable time.
LARGE = 5e4


@dataclass(frozen=True)
class Solve:
    """One system solved: CPU seconds with all that is set up for it, and how far the result is off.

    `residual` is relative, in the norm of forces.
    """

    solver: str
    dofs: int
    iterations: int
    seconds: float
    residual: float


def main() -> None:
    """Run one mesh, or all of them."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--most", type=float, default=1e6, help="unknowns of the largest mesh")
    parser.add_argument("--docs", type=Path, default=HERE.parent / "docs")
    parser.add_argument("--one", metavar="SIZE", type=float, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.one:
        for solve in _one(arguments.one):
            print(json.dumps(asdict(solve)), flush=True)
        return
    os.environ.update(ONE_THREAD)
    solves: list[Solve] = []
    size = COARSEST["hinge"] * SHRINK**3
    while not solves or 2 * solves[-1].dofs < 1.1 * arguments.most:
        command = [sys.executable, __file__, "--one", repr(size)]
        ended = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
        solves += [Solve(**json.loads(line)) for line in ended.stdout.splitlines()]
        print(ended.stdout, end="", flush=True)
        size *= SHRINK
    write_rows(arguments.docs / "iterative.csv", solves, digits=4)
    print("| unknowns | " + " | ".join(SOLVERS) + " |\n" + "|---" * (len(SOLVERS) + 1) + "|")
    for dofs in sorted({solve.dofs for solve in solves}):
        mine = {solve.solver: solve for solve in solves if solve.dofs == dofs}
        print(f"| {dofs} | " + " | ".join(_cell(mine.get(name)) for name in SOLVERS) + " |")


def _cell(solve: Solve | None) -> str:
    if solve is None:
        return ""
    seconds = f"{solve.seconds:.3g} s"
    if solve.iterations >= MOST:
        return f"> {seconds}"
    return f"{seconds} ({solve.iterations})" if solve.iterations > 1 else seconds


def _one(size: float) -> list[Solve]:
    from mpi4py import MPI

    from pantograph_fem.sheet.simulation import SheetSimulation
    from pantograph_fem.stopwatch import Stopwatch

    case = load_case(CASE, [*LEAN, "discretisation.scheme=hinge", f"mesh.size={size}"])
    assert isinstance(case, SheetCase)
    simulation = SheetSimulation(case, MPI.COMM_WORLD, Stopwatch())
    problem = simulation.equilibrium
    rest = simulation.path.linearise(simulation.start, 0.0)
    x = problem.impose(simulation.start + LOAD * rest.rate, LOAD)
    upper = problem.matrix()
    problem.tangent(x, LOAD, upper)
    right = upper.createVecLeft()
    right.array[:] = problem.load_rate(x, LOAD)
    right.array[problem.held_dofs] = 0.0  # known, and in other units than forces
    whole, coarse = whole_matrix(upper), interpolation_of_linears(problem)
    dofs = right.size
    return [
        _solve(name, upper if name == "direct" else whole, coarse, right)
        for name in SOLVERS
        if dofs < LARGE or not name.endswith("AMG")
    ]


def _solve(name: str, matrix: PETSc.Mat, coarse: PETSc.Mat, right: PETSc.Vec) -> Solve:
    options = PETSc.Options()
    for key in options.getAll():
        options.delValue(key)
    for key, value in SOLVERS[name].items():
        options[key] = value
    blocks = max(2, round(right.size / SUBDOMAIN))
    options["pc_asm_blocks"] = options["mg_levels_pc_asm_blocks"] = blocks
    ksp = PETSc.KSP().create(matrix.comm)
    ksp.setType(PETSc.KSP.Type.CG)
    direct = name == "direct"
    ksp.setNormType(PETSc.KSP.NormType.NONE if direct else PETSc.KSP.NormType.NATURAL)
    ksp.setTolerances(rtol=TOLERANCE, max_it=MOST)
    ksp.setOperators(matrix)
    if SOLVERS[name]["pc_type"] == "mg":
        ksp.getPC().setType("mg")
        ksp.getPC().setMGLevels(2)
        ksp.getPC().setMGInterpolation(1, coarse)
    ksp.setFromOptions()
    x, residual = right.duplicate(), right.duplicate()
    start = process_time()
    ksp.setUp()
    ksp.solve(right, x)
    seconds = process_time() - start
    matrix.mult(x, residual)
    residual.axpy(-1.0, right)
    solved = Solve(name, right.size, ksp.its, seconds, residual.norm() / right.norm())
    ksp.destroy()
    return solved


if __name__ == "__main__":
    main()
