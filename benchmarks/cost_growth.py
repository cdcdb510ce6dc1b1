"""Cost of a tangent against the number of unknowns, for both schemes with the direct solver.

For each scheme the bias extension test is meshed finer and finer. Each mesh has a process of its
own, which linearises the state of rest, and then times a second linearisation, at a load of 2 %:
tangent, numerical factorisation with its inertia, and the rate of the path. So the symbolic
analysis, which is made once a run, is told apart. Writes docs/cost_growth.csv and
docs/figures/cost_growth.png, and prints the exponents fitted in log-log.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from time import process_time

import numpy as np
from growth_figure import draw
from programs import CASE, HERE, LEAN, ONE_THREAD
from rows import write_rows

from pantograph_fem.case import load_case

SCHEMES = ("hinge", "micromorphic")
#: Element size inside, m, of the coarsest mesh: about 1e4 unknowns.
COARSEST = {"hinge": 0.0098, "micromorphic": 0.017}
#: From mesh to mesh the size shrinks so that there are twice as many elements.
SHRINK = 0.5**0.5
#: Unknowns from which on the exponents are fitted, if so many meshes have them.
MANY, ENOUGH = 5e4, 3
#: Load fraction of the timed linearisation.
LOAD = 0.02


@dataclass(frozen=True)
class Cost:
    """CPU seconds of one tangent, and what was needed before.

    Attributes
    ----------
    assemble, solve
        Of the timed linearisation: tangent and right side; factorisation and back-substitution.
    tangent
        Their sum.
    first
        Of the linearisation at rest, with the symbolic analysis.
    memory
        Largest resident memory of the process, GiB.
    """

    scheme: str
    size: float
    cells: int
    dofs: int
    assemble: float
    solve: float
    tangent: float
    first: float
    memory: float


def main() -> None:
    """Run one mesh, or all of them."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--most", type=float, default=1e6, help="unknowns of the largest mesh")
    parser.add_argument("--memory", type=float, default=22.0, help="a process may take, GiB")
    parser.add_argument("--docs", type=Path, default=HERE.parent / "docs")
    parser.add_argument("--one", nargs=2, metavar=("SCHEME", "SIZE"), help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.one:
        scheme, size = arguments.one
        print(json.dumps(asdict(_one(scheme, float(size), arguments.memory))))
        return
    os.environ.update(ONE_THREAD)
    costs: list[Cost] = []
    for scheme in SCHEMES:
        _in_process(scheme, COARSEST[scheme], arguments.memory)  # compiles the forms
        size = COARSEST[scheme]
        while (cost := _in_process(scheme, size, arguments.memory)) is not None:
            costs.append(cost)
            print(cost, flush=True)
            if 2 * cost.dofs > 1.1 * arguments.most:
                break
            size *= SHRINK
    write_rows(arguments.docs / "cost_growth.csv", costs, digits=6)
    exponents = {
        (scheme, name): _exponent([cost for cost in costs if cost.scheme == scheme], name)
        for scheme in SCHEMES
        for name in ("assemble", "solve", "tangent", "memory")
    }
    for (scheme, name), exponent in exponents.items():
        print(f"{scheme}, {name}: unknowns^{exponent:.2f}")
    draw(costs, exponents, arguments.docs / "figures" / "cost_growth.png")


def _exponent(costs: list[Cost], name: str) -> float:
    """Slope of the quantity over unknowns in log-log, by least squares."""
    large = [cost for cost in costs if cost.dofs >= MANY]
    costs = large if len(large) >= ENOUGH else costs
    if len(costs) < 2:
        return float("nan")
    x, y = np.log([(cost.dofs, getattr(cost, name)) for cost in costs]).T
    return float(np.polyfit(x, y, 1)[0])


def _in_process(scheme: str, size: float, memory: float) -> Cost | None:
    """Cost of one mesh; None where it does not fit into the memory."""
    command = [sys.executable, __file__, "--one", scheme, repr(size), "--memory", str(memory)]
    ended = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    if ended.returncode:
        print(f"{scheme}, {1e3 * size:.3g} mm: ended with code {ended.returncode}, out of memory?")
        return None
    return Cost(**json.loads(ended.stdout.splitlines()[-1]))


def _one(scheme: str, size: float, memory: float) -> Cost:
    from mpi4py import MPI

    from pantograph_fem.simulation import build_simulation
    from pantograph_fem.stopwatch import Stopwatch

    limit = int(memory * 2**30)
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    overrides = [*LEAN, f"discretisation.scheme={scheme}", f"mesh.size={size}"]
    case = load_case(CASE, overrides)
    clock = Stopwatch()
    simulation = build_simulation(case, MPI.COMM_WORLD, clock)
    start = process_time()
    rest = simulation.path.linearise(simulation.start, 0.0)
    first = process_time() - start
    # Away from equilibrium, so that nothing of the state of rest can be used again.
    guess = simulation.start + LOAD * rest.rate
    wall = dict(clock.seconds)
    start = process_time()
    simulation.path.linearise(guess, LOAD)
    tangent = process_time() - start
    stages = {name: clock.seconds[name] - wall[name] for name in ("assemble", "solve")}
    # The stopwatch has wall times: their shares of the CPU time.
    shares = {name: tangent * seconds / sum(stages.values()) for name, seconds in stages.items()}
    largest = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    dofs = sum(simulation.dofs.values())
    return Cost(
        scheme, size, simulation.cells, dofs, **shares, tangent=tangent, first=first, memory=largest
    )


if __name__ == "__main__":
    main()
