"""One run of either program in a process of its own, and what it cost."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from series import PANTOGRAPH, Series, Sizes

from pantograph_fem.case import load_case
from pantograph_fem.mesh.rectangle import rectangle
from pantograph_fem.study.process import run_in_process
from pantograph_fem.study.warm_up import warm_up

HERE = Path(__file__).resolve().parent
CASE = HERE.parent / "cases" / "a_bias_extension.toml"
#: A single state at full load, and nothing written but the history.
LEAN = ("continuation.stops=[1.0]", "output.figures=false", 'output.fields="none"')
ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}


@dataclass(frozen=True)
class Run:
    """Force (N) and energy (J) at full load, and the CPU time of the whole process (s)."""

    force: float
    energy: float
    dofs: int
    cells: int
    steps: int
    tangents: int
    cpu_seconds: float
    versions: Mapping[str, str] = field(default_factory=dict)


class Programs:
    """Runs both programs; forms of pantograph_fem are compiled before they are timed.

    Parameters
    ----------
    scikit_fem_python
        Interpreter of the environment with scikit-fem.
    """

    def __init__(self, scikit_fem_python: Path) -> None:
        self._python = scikit_fem_python
        self._warm: set[tuple[str, ...]] = set()
        os.environ.update(ONE_THREAD)

    def run(self, series: Series, sizes: Sizes) -> Run:
        """Run a series on one mesh.

        Raises
        ------
        RuntimeError
            If the program fails.
        """
        with tempfile.TemporaryDirectory() as folder:
            run = _pantograph if series.program == PANTOGRAPH else self._scikit_fem
            if series.program == PANTOGRAPH and series.options not in self._warm:
                case = load_case(CASE, _overrides(series.options, sizes))
                warm_up(case, case.mesh, run_in_process)
                self._warm.add(series.options)
            return run(series.options, sizes, Path(folder))

    def _scikit_fem(self, options: Sequence[str], sizes: Sizes, folder: Path) -> Run:
        command = [str(self._python), str(HERE / "scikit_fem_sheet.py"), *options]
        command += self._mesh(options, sizes, folder)
        with tempfile.TemporaryFile("w+") as output:
            process = subprocess.Popen(command, stdout=output)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            if process.returncode:
                raise RuntimeError(f"{' '.join(command)} ended with code {process.returncode}")
            output.seek(0)
            result = json.load(output)
        wanted = {name: result[name] for name in Run.__dataclass_fields__ if name in result}
        return Run(**wanted | {"cpu_seconds": usage.ru_utime + usage.ru_stime})

    @staticmethod
    def _mesh(options: Sequence[str], sizes: Sizes, folder: Path) -> list[str]:
        size, corner_size, growth = sizes
        if size == corner_size:
            return ["--size", str(size)]
        if "bfs" in options:
            return ["--size", str(size), "--corner-size", str(corner_size)]
        sheet = load_case(CASE).sheet
        mesh = rectangle(sheet.width, sheet.height, size, corner_size, growth=growth)
        file = folder / "mesh.npz"
        np.savez(file, points=mesh.points, triangles=mesh.triangles)
        return ["--mesh-file", str(file)]


def _overrides(options: Sequence[str], sizes: Sizes) -> list[str]:
    mesh = (f"mesh.{key}={value}" for key, value in sizes._asdict().items())
    return [*LEAN, *options, *mesh]


def _pantograph(options: Sequence[str], sizes: Sizes, folder: Path) -> Run:
    ended = run_in_process(load_case(CASE, _overrides(options, sizes)), folder)
    if ended.code:
        raise RuntimeError(f"pantograph_fem ended with code {ended.code}: {ended.message}")
    summary: dict[str, Any] = json.loads((folder / "summary.json").read_text())
    history = np.genfromtxt(folder / "history.csv", delimiter=",", names=True)
    last = summary["last"]
    return Run(
        force=last["force_y"],
        energy=last["energy"],
        dofs=sum(summary["dofs"].values()),
        cells=summary["cells"],
        steps=last["step"],
        tangents=int(history["newton_iterations"].sum()),
        cpu_seconds=ended.cpu_seconds,
        versions=summary["versions"],
    )
