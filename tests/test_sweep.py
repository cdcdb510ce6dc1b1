"""Sweeps of made-up results, whose sensitivities are known, and of a real beam."""

import csv
import io
import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from rich.console import Console

from pantograph_fem.case import case_to_toml, load_case
from pantograph_fem.errors import CaseError
from pantograph_fem.study.process import Ended
from pantograph_fem.sweep import sweep, write
from pantograph_fem.sweep.design import make_design
from pantograph_fem.sweep.plan import Plan, Point
from pantograph_fem.sweep.processes import Processes
from pantograph_fem.sweep.report import failures, print_sweep
from pantograph_fem.sweep.results import PointResult
from pantograph_fem.sweep.runs import forms_of
from pantograph_fem.sweep.sensitivity import sensitivity
from pantograph_fem.sweep.study_file import load_sweep
from pantograph_fem.sweep.table import write_parquet

from .test_compare import COLUMNS
from .test_sweep_design import CASES, write_sweep

BENDING = {"key": "material.bending", "values": [1e5, 2e5, 3e5]}
#: Ranges of three keys, and by how much the force changes over each; the sum is linear.
RANGES = [
    {"key": "material.stretch", "low": 1e7, "high": 2e7},
    {"key": "material.bending", "low": 1e4, "high": 2e4, "scale": "log"},
    {"key": "ends.right.rotation", "low": 10.0, "high": 20.0},
]
CHANGES = (4.0, -2.0, 1.0)


def additive(case):
    """A force that is linear in each key on its scale, and an energy that is the same always."""
    material = case.material
    u = (
        material.stretch / 1e7 - 1,
        np.log2(material.bending / 1e4),
        case.ends.right.rotation / 10 - 1,
    )
    return 100.0 + np.dot(CHANGES, u), 2.0


class MadeUp:
    """A runner that leaves what a function of the case gives, at a cost of 1.5 s."""

    def __init__(self, function=lambda case: (case.material.bending / 1e5, 2.0)):
        self.function, self.cases, self.warm_ups = function, [], 0
        self.codes = {}
        self.lock = threading.Lock()

    def __call__(self, case, directory):
        if directory.name == "warm_up":
            self.warm_ups += 1
            return Ended(3, 100.0)
        with self.lock:
            self.cases.append(case)
            code = self.codes.get(case.material.bending, 0)
        if code == "interrupt":
            raise KeyboardInterrupt
        load = np.array([0.0, 0.5, 1.0] if code == 0 else [0.0, 0.5])
        table = {name: np.zeros_like(load) for name in COLUMNS}
        force, energy = self.function(case)
        table |= {"load": load, "force_x": -0.6 * force * load, "force_y": 0.8 * force * load}
        table |= {"energy": energy * load**2, "stable": np.ones_like(load)}
        table |= {"step": np.arange(len(load))}
        directory.mkdir(parents=True, exist_ok=True)
        if code in (0, 3):
            lines = [",".join(repr(float(x)) for x in row) for row in zip(*table.values())]  # noqa: B905
            (directory / "history.csv").write_text("\n".join([",".join(table), *lines]) + "\n")
            (directory / "case.resolved.toml").write_text(case_to_toml(case))
            status = "stopped: no further" if code else "done"
            (directory / "summary.json").write_text(json.dumps({"status": status}))
        messages = {1: "Traceback\nMemoryError", 2: "The case is wrong:\n  mesh.size: too small"}
        return Ended(code, 1.5, messages.get(code, ""))


@pytest.fixture
def made_up():
    return MadeUp()


def swept(folder, runner, *vary, jobs=2, rerun=False, **tables):
    path = write_sweep(folder, *(vary or [BENDING]), **tables)
    return sweep(path, folder / "out", jobs=jobs, rerun=rerun, runner=runner)


def rows(result):
    write(result)
    with (result.plan.directory / "sweep.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def shown(result):
    console = Console(width=100, file=io.StringIO(), force_terminal=True)
    print_sweep(result, console)
    return console.file.getvalue()


def test_the_table_has_keys_outputs_and_costs(tmp_path, made_up):
    table = rows(swept(tmp_path, made_up, set=["continuation.stops=[0.5]"], at_stops=True))
    assert [float(row["material.bending"]) for row in table] == [1e5, 2e5, 3e5]
    assert [float(row["force"]) for row in table] == pytest.approx([1.0, 2.0, 3.0])
    assert [float(row["force_x"]) for row in table] == pytest.approx([-0.6, -1.2, -1.8])
    assert [float(row["force@0.5"]) for row in table] == pytest.approx([0.5, 1.0, 1.5])
    assert [float(row["energy@0.5"]) for row in table] == [0.5] * 3
    for i, row in enumerate(table, 1):
        found = [row[k] for k in ("point", "steps", "stable", "load", "status", "cpu_seconds")]
        assert found == [str(i), "2", "1", "1.0", "done", "1.5"]
        case = load_case(tmp_path / "out" / row["folder"] / "case.resolved.toml")
        assert case.material.bending == float(row["material.bending"])


def test_parquet_has_the_table_of_the_csv(tmp_path, made_up):
    made_up.codes = {2e5: 3}
    result = swept(tmp_path, made_up)
    csv_rows = rows(result)
    path = result.plan.directory / "sweep.parquet"
    if not write_parquet(result, path):
        pytest.skip("no pyarrow")
    from pyarrow import parquet

    table = parquet.read_table(path).to_pylist()
    assert [list(row) for row in table] == [list(row) for row in csv_rows]
    assert [row["force"] for row in table] == [pytest.approx(1.0), None, pytest.approx(3.0)]
    assert [row["steps"] for row in table] == [2, 1, 2]


def test_what_is_over_is_not_run_again(tmp_path, made_up):
    made_up.codes = {2e5: 3}
    assert swept(tmp_path, made_up).runs == 3
    again = MadeUp()
    result = swept(tmp_path, again)
    assert (result.runs, again.cases, again.warm_ups) == (0, [], 0)
    assert [row["cpu_seconds"] for row in rows(result)] == ["1.5"] * 3
    assert result.points[1].status == "stopped: no further"
    # further values are run alone; other outputs need no runs
    more = {"key": "material.bending", "values": [*BENDING["values"], 4e5]}
    assert swept(tmp_path, again, more, outputs=["tip_ux", "energy", "force"]).runs == 1
    assert [case.material.bending for case in again.cases] == [4e5]
    # another value of another key makes all other cases
    assert swept(tmp_path, again, set=["material.stretch=1e8"]).runs == 3
    assert swept(tmp_path, again, rerun=True).runs == 3


def test_points_with_the_same_case_are_run_once(tmp_path, made_up):
    vary = {"key": "chain.spacing", "values": [0.1, 0.1001]}
    result = swept(tmp_path, made_up, vary, case=CASES / "chain_arc.toml")
    assert len(made_up.cases) == 1
    assert [row["status"] for row in rows(result)] == ["done", "done"]
    # springs have no forms
    assert made_up.warm_ups == 0


def test_failed_points_are_rows_without_values(tmp_path, made_up):
    made_up.codes = {2e5: 1, 3e5: 3, 4e5: 2}
    values = [1e5, 2e5, 3e5, 4e5, -1.0]
    result = swept(tmp_path, made_up, {"key": "material.bending", "values": values})
    table = rows(result)
    assert [row["status"].partition(":")[0] for row in table] == [
        *("done", "failed", "stopped", "invalid", "invalid")
    ]
    assert table[1]["status"] == "failed: MemoryError"
    assert table[3]["status"] == "invalid: mesh.size: too small"
    assert "material.bending: -1.0 is not allowed" in table[4]["status"]
    assert [row["force"] for row in table[1:]] == [""] * 4
    # how far it came
    assert (table[2]["load"], table[2]["steps"]) == ("0.5", "1")
    assert failures(result)[0] == "4 of 5 points have no result:"
    assert "MemoryError" in shown(result)
    # what crashed may do better the next time, and what was wrong may be right
    made_up.codes, made_up.cases = {}, []
    assert swept(tmp_path, made_up, {"key": "material.bending", "values": values}).runs == 2


def test_an_interrupt_leaves_what_was_found(tmp_path, made_up):
    made_up.codes = {3e5: "interrupt"}
    vary = {"key": "material.bending", "values": [1e5, 2e5, 3e5, 4e5]}
    with pytest.raises(KeyboardInterrupt):
        swept(tmp_path, made_up, vary, jobs=1)
    assert len(made_up.cases) <= 4
    before = {case.material.bending for case in made_up.cases} - {3e5}
    again = MadeUp()
    result = swept(tmp_path, again, vary, jobs=1)
    assert {case.material.bending for case in again.cases} == {1e5, 2e5, 3e5, 4e5} - before
    assert [row["status"] for row in rows(result)] == ["done"] * 4


def test_an_interrupt_ends_the_processes(tmp_path):
    processes = Processes()
    case = load_case(CASES / "beam_arc.toml", ["mesh.size=1e-5"])  # takes minutes
    ended = []
    with processes:
        thread = threading.Thread(target=lambda: ended.append(processes(case, tmp_path / "long")))
        thread.start()
        while not (tmp_path / "long" / "case.toml").is_file():
            time.sleep(0.01)
        time.sleep(0.1)
        processes.end()
        thread.join(timeout=30)
    assert not thread.is_alive()
    assert ended[0].code == -signal.SIGKILL
    assert processes(case, tmp_path / "late").message == "not started"


def test_forms_are_compiled_once_for_all_numbers(tmp_path, made_up):
    exponents = {"key": "material.shear_exponent", "values": [1.5, 1.8]}
    shears = {"key": "material.shear", "values": [100.0, 150.0]}
    result = swept(tmp_path, made_up, exponents, shears, case=CASES / "a_bias_extension.toml")
    assert (len(made_up.cases), made_up.warm_ups) == (4, 1)
    assert len({forms_of(point.point.case) for point in result.points}) == 1
    # a quadratic energy of the pivots is another form
    case = load_case(CASES / "a_bias_extension.toml", ["material.shear_exponent=2.0"])
    assert forms_of(case) != forms_of(made_up.cases[0])


def test_effects_of_a_linear_response_are_its_changes(tmp_path):
    result = swept(tmp_path, MadeUp(additive), *RANGES, design="morris", samples=4)
    (force,) = result.indices
    assert force.response == "force"
    assert force.values["mu"] == pytest.approx(CHANGES)
    assert force.values["mu_star"] == pytest.approx(np.abs(CHANGES))
    assert force.values["sigma"] == pytest.approx(np.zeros(3), abs=1e-9)
    assert result.notes == ("No indices of energy: it is the same at all points.",)
    with (Path(write(result)[0]).parent / "indices.csv").open(newline="") as file:
        table = list(csv.DictReader(file))
    assert [row["key"] for row in table] == [vary["key"] for vary in RANGES]
    assert [float(row["mu"]) for row in table] == pytest.approx(CHANGES)
    assert "mu*" in shown(result)


@pytest.mark.parametrize(
    ("response", "first", "total"),
    [
        # parts a_i^2 of the variance, with no interactions
        (lambda u: u @ CHANGES, np.square(CHANGES) / 21, np.square(CHANGES) / 21),
        # (1/9 - 1/16) is the variance of the product of two, 1/48 that of the mean over one
        (lambda u: u[:, 0] * u[:, 1], [3 / 7, 3 / 7, 0], [4 / 7, 4 / 7, 0]),
    ],
)
def test_sobol_indices_are_parts_of_the_variance(tmp_path, response, first, total):
    study = load_sweep(write_sweep(tmp_path, *RANGES, design="saltelli", samples=1024))
    design = make_design(study)
    plan = Plan(study, design, (), (), "beam", tmp_path)
    forces = 100.0 + response(design.unit)
    points = [
        PointResult(Point(values, None, tmp_path), "done", {"force": force, "energy": force})
        for values, force in zip(design.values, forces.tolist(), strict=True)
    ]
    found, notes = sensitivity(plan, points)
    assert (len(design.values), notes) == (1024 * 5, ())
    for indices in found:
        assert indices.values["S1"] == pytest.approx(first, abs=0.02)
        assert indices.values["ST"] == pytest.approx(total, abs=0.01)


def test_a_broken_trajectory_is_left_out(tmp_path):
    runner = MadeUp(additive)
    whole = swept(tmp_path, runner, *RANGES, design="morris", samples=4, seed=2)
    # the first point whose case is that of no other
    bendings = [point.point.case.material.bending for point in whole.points]
    folders = [point.point.directory for point in whole.points]
    number = next(i for i, folder in enumerate(folders) if folders.count(folder) == 1)
    (folders[number] / "summary.json").unlink()
    runner.codes = {bendings[number]: 3}
    result = swept(tmp_path, runner, *RANGES, design="morris", samples=4, seed=2)
    (force,) = result.indices
    assert (force.samples, force.of) == (3, 4)
    assert force.values["mu"] == pytest.approx(CHANGES)
    assert "3 of 4 trajectories" in result.notes[0]


def test_sobol_indices_need_every_point(tmp_path, made_up):
    vary = [RANGES[0], {"key": "material.bending", "low": -1e4, "high": 1e6}]
    result = swept(tmp_path, made_up, *vary, design="saltelli", samples=128)
    assert 0 < sum(not point.done for point in result.points) < 50
    assert result.indices == ()
    assert "would be biased" in result.notes[0]
    assert not (tmp_path / "out" / "indices.csv").exists()
    assert "points have no value" in shown(result)


@pytest.mark.parametrize(
    ("vary", "tables"),
    [
        ([BENDING], {}),
        ([BENDING, {"key": "discretisation.scheme", "values": ["hinge", "micromorphic"]}], {}),
        ([BENDING, RANGES[0] | {"count": 2}, RANGES[2] | {"count": 2}], {"title": "T $x"}),
        (RANGES, {"design": "morris", "samples": 3}),
        (RANGES[:2], {"design": "latin_hypercube", "samples": 5}),
    ],
)
def test_every_sweep_has_a_figure(tmp_path, made_up, vary, tables):
    made_up.codes = {1e5: 1, 2e5: 3}
    made_up.function = lambda case: (case.material.bending / 1e5, case.material.stretch)
    result = swept(tmp_path, made_up, *vary, **tables)
    paths = write(result)
    figures = [path for path in paths if path.suffix == ".png"]
    assert len(figures) == 1 + (tables.get("design") == "morris")
    for path in figures:
        with Image.open(path) as image:
            assert image.width > 600
            assert len(image.convert("L").getcolors()) > 50


@pytest.mark.slow
def test_a_beam_from_the_command_line(tmp_path):
    sizes = ["mesh.size=0.25", "continuation.max_step=1.0", "continuation.stops=[]"]
    vary = {"key": "ends.right.rotation", "values": [10.0, 20.0, -10.0]}
    path = write_sweep(tmp_path, vary, set=[*sizes, "discretisation.degree=2"])
    command = [sys.executable, "-m", "pantograph_fem", "sweep", str(path), "--output", "out"]
    env = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[1]), "COLUMNS": "100"}

    def run(*more):
        return subprocess.run(
            [*command, *more], cwd=tmp_path, env=env, capture_output=True, text=True, timeout=120
        )

    done = run("--jobs", "2")
    assert done.returncode == 0, done.stderr
    assert "3/3" in done.stdout
    with (tmp_path / "out" / "sweep.csv").open(newline="") as file:
        table = list(csv.DictReader(file))
    energies = [float(row["energy"]) for row in table]
    # mirror images of each other
    assert energies[2] == pytest.approx(energies[0], rel=1e-9)
    assert energies[1] > 3 * energies[0] > 0
    before = (tmp_path / "out" / "sweep.csv").read_bytes()
    assert "0 to run, 3 run before" in run().stdout
    assert (tmp_path / "out" / "sweep.csv").read_bytes() == before
    wrong = run("--jobs", "0")
    assert (wrong.returncode, "--jobs: 0 is not allowed" in wrong.stderr) == (2, True)


def test_a_folder_that_cannot_be_written_to_ends_the_sweep(tmp_path):
    (tmp_path / "out").write_text("a file")
    with pytest.raises(CaseError, match="cannot be made"):
        sweep(write_sweep(tmp_path, BENDING), tmp_path / "out", jobs=1)
