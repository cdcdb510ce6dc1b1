"""Strong and weak scaling of case a over processes of MPI, by both schemes.

Strong: one mesh, ever more processes. Weak: as many unknowns for each process, whose share of the
sheet gets the smaller. Every run is a `pantograph run` under mpirun, to full load, of which
nothing is written but the history; its times are those of `summary.json`. The fastest of several
counts. Prints a table for docs/cluster.md and writes docs/scaling.csv.
"""

from __future__ import annotations

import argparse
import json
import os
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from programs import CASE, HERE, LEAN, ONE_THREAD
from rows import write_rows

from pantograph_fem.case import load_case

SCHEMES = ("micromorphic", "hinge")
#: Strong: element sizes inside, at the corners, and growth of all over those of the case.
STRONG = {"micromorphic": 0.8, "hinge": 0.6}
#: Weak: the same, of one process.
WEAK = {"micromorphic": 1.4, "hinge": 1.0}
_COARSE = ("mesh.size=0.034", "mesh.corner_size=0.034")


@dataclass(frozen=True)
class Run:
    """Wall seconds of one run.

    Attributes
    ----------
    scaling
        "strong" or "weak".
    tangents
        Factorised on the way to full load.
    assemble, solve, total
        Stages, and the run from its start to the summary.
    gain
        Strong: speed-up of assembly and solution over the fewest processes. Weak: the time of the
        fewest processes, over that of these, for one tangent.
    """

    scaling: str
    scheme: str
    processes: int
    unknowns: int
    tangents: int
    assemble: float
    solve: float
    total: float
    gain: float = 1.0


def main() -> None:
    """Run both kinds of scaling."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--processes", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--repeat", type=int, default=3, help="runs of which the fastest counts")
    parser.add_argument(
        "--launcher", default="mpirun", help="with its options, as 'srun --mpi=pmix'"
    )
    parser.add_argument("--docs", type=Path, default=HERE.parent / "docs")
    arguments = parser.parse_args()
    os.environ.update(ONE_THREAD)
    if os.geteuid() == 0:
        os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    launcher = shlex.split(arguments.launcher)
    processes = sorted(arguments.processes)
    runs: list[Run] = []
    for scheme in SCHEMES:
        _run(launcher, 1, [f"discretisation.scheme={scheme}", *_COARSE])  # compiles the forms
        for scaling in ("strong", "weak"):
            series: list[Run] = []
            for number in processes:
                best = _fastest(launcher, scaling, scheme, number, arguments.repeat)
                series.append(_compared(best, series[0] if series else best))
                print(series[-1], flush=True)
            runs += series
    write_rows(arguments.docs / "scaling.csv", runs, digits=4)
    print("\n".join(_table(runs)))


def _fastest(launcher: list[str], scaling: str, scheme: str, number: int, repeat: int) -> Run:
    factor = STRONG[scheme] if scaling == "strong" else WEAK[scheme] / number**0.5
    mesh = load_case(CASE).mesh
    sizes = [f"mesh.{key}={getattr(mesh, key) * factor}" for key in ("size", "corner_size")]
    # All sizes alike everywhere: as many elements as the factor says.
    sizes.append(f"mesh.growth={mesh.growth * factor}")
    overrides = [f"discretisation.scheme={scheme}", *sizes]
    found = [_run(launcher, number, overrides) for _ in range(repeat)]
    best = min(found, key=lambda run: run["assemble"] + run["solve"])
    return Run(scaling, scheme, number, **best)


def _compared(run: Run, first: Run) -> Run:
    seconds = [one.assemble + one.solve for one in (first, run)]
    if run.scaling == "weak":
        seconds = [s / one.tangents for s, one in zip(seconds, (first, run), strict=True)]
    return Run(**asdict(run) | {"gain": seconds[0] / seconds[1]})


def _run(launcher: list[str], processes: int, overrides: Iterable[str]) -> dict[str, float]:
    """Times, unknowns and tangents of a run.

    Raises
    ------
    RuntimeError
        If it fails.
    """
    with tempfile.TemporaryDirectory() as folder:
        words = [word for value in (*LEAN, *overrides) for word in ("--set", value)]
        program = [sys.executable, "-m", "pantograph_fem", "run", str(CASE), *words]
        command = [*launcher, "-n", str(processes), *program, "--quiet", "--output", folder]
        ended = subprocess.run(command, capture_output=True, text=True, check=False)
        if ended.returncode:
            raise RuntimeError(
                f"{shlex.join(command)} ended with {ended.returncode}:\n{ended.stderr}"
            )
        summary = json.loads(Path(folder, "summary.json").read_text())
        history = np.genfromtxt(Path(folder, "history.csv"), delimiter=",", names=True)
    seconds = {name: summary["seconds"][name] for name in ("assemble", "solve", "total")}
    tangents = int(history["newton_iterations"].sum())
    return {"unknowns": sum(summary["dofs"].values()), "tangents": tangents, **seconds}


def _table(runs: list[Run]) -> list[str]:
    """The runs in Markdown."""
    names = ["scaling", "scheme", "processes", "unknowns", "tangents"]
    names += ["assembly, s", "solution, s", "run, s", "gain"]
    lines = [f"| {' | '.join(names)} |", "|" + "---|" * len(names)]
    for run in runs:
        unknowns = f"{run.unknowns:,}".replace(",", " ")
        seconds = " | ".join(f"{s:.1f}" for s in (run.assemble, run.solve, run.total))
        lines.append(
            f"| {run.scaling} | {run.scheme} | {run.processes} | {unknowns} | {run.tangents} "
            f"| {seconds} | {run.gain:.2f} |"
        )
    return lines


if __name__ == "__main__":
    main()
