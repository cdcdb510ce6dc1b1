"""Studies of made-up results whose errors, orders and costs are known, and of a real beam."""

import csv
import io
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import tomli_w
from PIL import Image
from rich.console import Console

from pantograph_fem.case import case_to_toml, load_case
from pantograph_fem.errors import CaseError, PantographError, PathError
from pantograph_fem.study import study, write
from pantograph_fem.study.advice import advice, cheapest
from pantograph_fem.study.files import write_table
from pantograph_fem.study.knobs_figure import draw_knobs
from pantograph_fem.study.limits import settled_limit
from pantograph_fem.study.plan import Wanted
from pantograph_fem.study.process import Ended, run_in_process
from pantograph_fem.study.table import print_study

from .conftest import COARSE, merged
from .test_compare import COLUMNS

CASES = Path(__file__).parents[1] / "cases"
FORCE, ENERGY = 5.0, 2.0
MESHES = ("0.016/0.004", "0.008/0.002", "0.004/0.001", "0.002/0.0005")


class MadeUp:
    """A runner whose force and energy converge at the order of the degree.

    The relative error of the force is h^p with h the size over 0.08 m, at half load half of that
    of a force half as large; the energy has a tenth of it. CPU time is 0.005 s p/h, and grows by
    1 s from one run of a case to the next.
    """

    def __init__(self):
        self.runs, self.warm_ups = [], []
        self.codes = {}
        self.off = 0.0

    def __call__(self, case, directory):
        degree = case.discretisation.degree
        if directory.name == "warm_up":
            self.warm_ups.append((degree, case.mesh.size))
            return Ended(3, 100.0)
        self.runs.append(directory.name)
        h = case.mesh.size / 0.08
        code = self.codes.get(directory.name, 0)
        error = h**degree + self.off * (directory.name == "reference")
        error += 1e4 * (case.continuation.tolerance - 1e-8)
        load = np.array([0.0, 0.5, 1.0] if code == 0 else [0.0, 0.5])
        table = {name: np.zeros_like(load) for name in COLUMNS}
        force = FORCE * load * (1 + error * np.array([0.0, 0.5, 1.0])[: len(load)])
        table |= {"load": load, "force_x": 0.6 * force, "force_y": -0.8 * force}
        table |= {"energy": ENERGY * load**2 * (1 - error / 10), "stable": np.ones_like(load)}
        table |= {"step": np.arange(len(load)), "newton_iterations": np.full(len(load), 3)}
        directory.mkdir(parents=True, exist_ok=True)
        if code in (0, 3):
            lines = [",".join(repr(float(x)) for x in row) for row in zip(*table.values())]  # noqa: B905
            (directory / "history.csv").write_text("\n".join([",".join(table), *lines]) + "\n")
            (directory / "case.resolved.toml").write_text(case_to_toml(case))
            summary = {
                "status": "stopped: no further" if code else "done",
                "dofs": {"displacement": round(100 / h), "multiplier": 10},
                "cells": round(10 / h),
                "seconds": {"compile": 50.0, "assemble": 0.25 / h, "solve": 0.5 / h},
                "versions": {"python": "3"},
            }
            (directory / "summary.json").write_text(json.dumps(summary))
        message = "Traceback\nMemoryError" if code == 1 else "corner_size is wrong"
        return Ended(code, 0.005 * degree / h + self.runs.count(directory.name) - 1, message)


@pytest.fixture
def made_up():
    return MadeUp()


def write_case(folder, **changes):
    base = merged(COARSE, {"continuation": {"stops": [0.5]}, "title": "Made up"})
    path = folder / "case.toml"
    path.write_text(tomli_w.dumps(merged(base, changes)))
    return path


def studied(folder, runner, meshes=MESHES, *, repeat=1, rerun=False, case=None, **wanted):
    path = case or write_case(folder)
    wanted = Wanted(meshes=meshes, **wanted)
    return study(path, folder / "out", wanted, repeat=repeat, rerun=rerun, runner=runner)


def rows(result):
    path = result.plan.directory / "study.csv"
    path.parent.mkdir(exist_ok=True)
    write_table(result, path)
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def shown(result):
    console = Console(width=100, file=io.StringIO(), force_terminal=True)
    print_study(result, console)
    return console.file.getvalue()


def test_errors_are_those_against_the_reference(tmp_path, made_up):
    result = studied(tmp_path, made_up, degrees=[2, 3])
    table = rows(result)
    # the reference: the highest degree, half the finest size and a quarter at the corners
    assert table[-1]["label"] == "reference"
    assert [table[-1][key] for key in ("degree", "size", "corner_size")] == [
        *("3", "0.001", "0.000125")
    ]
    assert table[-1]["force_error"] == ""
    exact = FORCE * (1 + (0.001 / 0.08) ** 3)
    assert len(table) == 9
    for row in table[:-1]:
        h, p = float(row["size"]) / 0.08, int(row["degree"])
        force = FORCE * (1 + h**p)
        assert float(row["force"]) == pytest.approx(force, rel=1e-12)
        assert float(row["force_error"]) == pytest.approx(force / exact - 1, rel=1e-9)
        assert float(row["energy_error"]) == pytest.approx((h**p - 0.0125**3) / 10, rel=1e-4)
        # largest at full load, where the force is
        assert float(row["force_error_largest"]) == pytest.approx(float(row["force_error"]))
        assert float(row["force_x_error"]) == pytest.approx(0.6 * float(row["force_error"]))
        assert float(row["force_y"]) == pytest.approx(-0.8 * force)
        assert float(row["cpu_seconds"]) == pytest.approx(0.005 * p / h)
        # not the time of the compiler
        assert float(row["solve_seconds"]) == pytest.approx(0.75 / h)
        assert (row["dofs"], row["cells"]) == (str(round(100 / h) + 10), str(round(10 / h)))
        assert (row["steps"], row["newton_iterations"], row["status"]) == ("2", "9", "done")
    h = 0.002 / 0.08
    assert result.accuracy.uncertainty["force"] == pytest.approx(h**3, rel=0.2)
    assert not result.accuracy.off_series


def test_the_limits_of_the_series_are_exact(tmp_path, made_up):
    result = studied(tmp_path, made_up, degrees=[2, 3], with_reference=False)
    for degree in (2, 3):
        for quantity, value in (("force", FORCE), ("energy", ENERGY)):
            limit = result.accuracy.limits[f"micromorphic, degree {degree}", quantity].limit
            assert limit == pytest.approx((value, degree), rel=1e-8)
    for row in rows(result):
        # errors are against the limits where there is no reference
        h = float(row["size"]) / 0.08
        assert float(row["force_error"]) == pytest.approx(h ** int(row["degree"]), rel=1e-5)
        assert row["force_error_to_limit"] == row["force_error"]
        assert row["force_error_largest"] == ""


def test_no_limit_without_settled_order_or_proportion(tmp_path, made_up):
    sizes = np.array([8.0, 4.0, 2.0, 1.0])
    assert settled_limit(sizes, 3 + sizes**2) == pytest.approx((3.0, 2.0))
    assert settled_limit(sizes, 3 + sizes**0.3) is None
    # the order jumps from 4 to 1
    assert settled_limit(sizes, np.array([19.0, 3.0, 2.0, 1.5])) is None
    assert settled_limit(sizes[1:], np.array([3.0, 2.0, 1.5])) == pytest.approx((1.0, 1.0))
    assert settled_limit(sizes[:2], sizes[:2]) is None
    uneven = studied(tmp_path, made_up, ("0.016/0.004", "0.008/0.002", "0.004/0.004"))
    assert uneven.accuracy.limits == {}


def test_a_stopped_run_is_a_row_without_error(tmp_path, made_up):
    made_up.codes["micromorphic_p3_0.008_0.002"] = 3
    result = studied(tmp_path, made_up)
    row = rows(result)[1]
    assert row["status"] == "stopped: no further"
    assert [row[key] for key in ("force", "force_error", "energy_error_largest")] == [""] * 3
    assert (row["steps"], row["dofs"]) == ("1", "1010")
    assert float(row["cpu_seconds"]) == pytest.approx(0.15)
    assert [bool(r["force_error"]) for r in rows(result)] == [True, False, True, True, False]
    assert result.failure() is None
    assert "stopped at 0.5" in shown(result)
    # the sizes that are left have no constant ratio
    assert result.accuracy.limits == {}


def test_a_study_in_which_nothing_arrives_says_so(tmp_path, made_up):
    made_up.codes = {"micromorphic_p3_0.016_0.004": 3, "reference": 3}
    result = studied(tmp_path, made_up, MESHES[:1])
    assert result.accuracy.reference is None
    assert not [path for path in write(result) if path.suffix == ".png"]
    with pytest.raises(PathError, match=r"micromorphic_p3_0.016_0.004 stopped, no further"):
        raise result.failure()


def test_a_crash_keeps_the_others(tmp_path, made_up):
    made_up.codes["reference"] = 1
    result = studied(tmp_path, made_up)
    assert result.runs[-1].status == "failed: MemoryError"
    # the finest of the others is the reference
    assert result.accuracy.reference is result.runs[3]
    assert [bool(row["force_error"]) for row in rows(result)] == [True, True, True, False, False]
    failure = result.failure()
    assert type(failure) is PantographError
    assert "reference: MemoryError" in str(failure)


def test_a_case_that_proves_wrong_ends_the_study(tmp_path, made_up):
    made_up.codes["micromorphic_p3_0.008_0.002"] = 2
    with pytest.raises(CaseError, match=r"micromorphic_p3_0.008_0.002: corner_size is wrong"):
        studied(tmp_path, made_up)


def test_results_are_reused_and_times_with_them(tmp_path, made_up):
    first = studied(tmp_path, made_up)
    assert len(made_up.runs) == 5
    assert made_up.warm_ups == [(3, 0.016)]
    again = studied(tmp_path, made_up)
    assert len(made_up.runs) == 5
    assert [run.cpu_seconds for run in again.runs] == [run.cpu_seconds for run in first.runs]
    # what is there counts as one of the three: 0, 1 and 2 s more
    more = studied(tmp_path, made_up, repeat=3)
    assert len(made_up.runs) == 15
    assert more.runs[0].cpu_seconds == pytest.approx(first.runs[0].cpu_seconds + 1)
    anew = studied(tmp_path, made_up, rerun=True)
    assert len(made_up.runs) == 20
    assert anew.runs[0].cpu_seconds == pytest.approx(first.runs[0].cpu_seconds + 3)
    # another case is another result
    write_case(tmp_path, material={"shear": 100.0})
    studied(tmp_path, made_up, case=tmp_path / "case.toml")
    assert len(made_up.runs) == 25


def test_forms_are_compiled_once_a_degree_on_the_coarsest_mesh(tmp_path, made_up):
    varied = ["continuation.tolerance=1e-6,1e-5", "discretisation.quadrature_degree=4,7"]
    studied(tmp_path, made_up, degrees=[3, 2], knobs=varied)
    assert made_up.warm_ups == [(3, 0.02), (2, 0.02), (3, 0.02), (3, 0.02)]


def test_each_value_of_a_key_is_taken_alone(tmp_path, made_up):
    result = studied(tmp_path, made_up, knobs=["continuation.tolerance=1e-8,1e-6,2e-6"])
    varied = [row for row in rows(result) if row["vary"]]
    assert [(row["vary"], row["value"], row["size"]) for row in varied] == [
        ("continuation.tolerance", value, "0.02") for value in ("1e-8", "1e-6", "2e-6")
    ]
    h = 0.02 / 0.08
    errors = [float(row["force_error"]) for row in varied]
    assert errors == pytest.approx([h**3 + extra for extra in (0, 0.0099, 0.0199)], rel=1e-3)
    # the value of the case itself is run once, with it
    assert len(made_up.runs) == 4 + 1 + 2 + 1


def test_the_cheapest_run_within_an_error_is_named(tmp_path, made_up):
    result = studied(tmp_path, made_up, degrees=[2, 3])
    # errors of 0.2^p, 0.1^p, 0.05^p and 0.025^p, for p/2 times 0.05, 0.1, 0.2 and 0.4 s
    names = ("force", 1e-2), ("force", 1e-3), ("force", 1e-4), ("energy", 1e-2)
    found = [result.runs[cheapest(result, *name)].variant.label for name in names]
    assert found == [
        "micromorphic_p3_0.016_0.004",
        "micromorphic_p3_0.008_0.002",
        "micromorphic_p3_0.002_0.0005",
        "micromorphic_p2_0.016_0.004",
    ]
    assert cheapest(result, "force", 1e-9) is None
    text = "\n".join(advice(result))
    assert "force to 1e-4: micromorphic, degree 3, 2/0.5 mm: 0.6 s CPU, 4010 dofs" in text
    assert "Beware" not in text


def test_a_reference_on_another_branch_is_noticed(tmp_path, made_up):
    made_up.off = 0.05
    result = studied(tmp_path, made_up)
    assert result.accuracy.off_series == ("force", "energy")
    text = "\n".join(advice(result))
    assert "another branch" in text
    assert "the reference itself is known to 5e-2 only" in text


def test_a_folder_of_results_as_reference(tmp_path, made_up):
    fine = load_case(write_case(tmp_path), ["mesh.size=0.0008", "mesh.corner_size=0.0001"])
    made_up(fine, tmp_path / "fine")
    result = studied(tmp_path, made_up, reference=tmp_path / "fine")
    assert len(made_up.runs) == 5
    table = rows(result)
    assert table[-1]["label"] == "reference"
    assert float(table[0]["force_error"]) == pytest.approx(0.2**3 - 0.01**3, rel=1e-5)
    other = load_case(write_case(tmp_path), ["material.shear=1.0"])
    made_up(other, tmp_path / "other")
    with pytest.raises(CaseError, match=r"another problem, as \[material\] differs"):
        studied(tmp_path, made_up, reference=tmp_path / "other")
    with pytest.raises(CaseError, match="holds no results"):
        studied(tmp_path, made_up, reference=tmp_path / "nothing")
    made_up.codes["short"] = 3
    made_up(fine, tmp_path / "short")
    with pytest.raises(CaseError, match="stopped: no further; give a finished run"):
        studied(tmp_path, made_up, reference=tmp_path / "short")


def test_sizes_by_default_and_along_clamps(tmp_path, made_up):
    case = write_case(tmp_path, grips={"top": {"hold": "clamp"}})
    result = studied(tmp_path, made_up, (), case=case, overrides=["mesh.grip_size=0.002"])
    meshes = [run.variant.case.mesh for run in result.runs]
    factors = np.array([2, 2**0.5, 1, 0.5**0.5, 0.5 * 0.5**0.5])
    assert [mesh.size for mesh in meshes] == pytest.approx(0.02 * factors)
    assert [mesh.grip_size for mesh in meshes] == pytest.approx(0.002 * factors)
    assert meshes[0].corner_size == pytest.approx(0.02)
    # a size alone has its corners in proportion
    mesh = studied(tmp_path, made_up, ("0.004",)).runs[0].variant.case.mesh
    assert (mesh.size, mesh.corner_size) == pytest.approx((0.004, 0.002))


@pytest.mark.parametrize(
    ("wanted", "message"),
    [
        ({"meshes": ("0.01/x",)}, r"--mesh 0.01/x is not allowed; .* form SIZE/CORNER_SIZE"),
        ({"meshes": ("-1",)}, "--mesh -1 is not allowed"),
        ({"meshes": ("0.01", "0.01/0.005")}, "the mesh of 10/5 mm is given twice"),
        ({"meshes": ("0.01/0.02",)}, r"be at most mesh.size \(0.01\)"),
        ({"degrees": [2, 9]}, "discretisation.degree: 9 is not allowed"),
        ({"schemes": ["spectral"]}, r'discretisation.scheme: "spectral" is not allowed'),
        ({"knobs": ["tolerance"]}, "--vary tolerance is not allowed; it must be of the form"),
        ({"knobs": ["a.b=1,,2"]}, "--vary a.b=1,,2 is not allowed"),
        ({"knobs": ["continuation.max_step=0.1,0.1"]}, "gives a value twice"),
        ({"knobs": ["continuation.max_step=0.1,7"]}, "continuation.max_step: 7 is not allowed"),
        ({"reference": Path("x"), "with_reference": False}, "exclude each other"),
    ],
)
def test_wrong_arguments_are_refused_before_anything_runs(tmp_path, made_up, wanted, message):
    with pytest.raises(CaseError, match=message):
        studied(tmp_path, made_up, **{"meshes": MESHES[:1], **wanted})
    assert made_up.runs == []


def test_other_kinds_of_cases(tmp_path, made_up):
    with pytest.raises(CaseError, match="a lattice is a net of springs"):
        study(CASES / "lattice_bias_extension.toml", tmp_path, Wanted(degrees=[2]))
    with pytest.raises(CaseError, match=r"for a beam it must be of the form SIZE, with"):
        study(CASES / "beam_arc.toml", tmp_path, Wanted(meshes=["0.1/0.01"]))
    with pytest.raises(CaseError, match="--repeat: 0 is not allowed"):
        studied(tmp_path, made_up, repeat=0)
    mesh = tmp_path / "mesh.msh"
    mesh.write_text("")
    case = write_case(tmp_path, mesh={"file": str(mesh), "size": None, "corner_size": None})
    with pytest.raises(CaseError, match=r"mesh.msh cannot be refined"):
        studied(tmp_path, made_up, case=case)


def test_tables_and_figures(tmp_path, made_up):
    result = studied(tmp_path, made_up, degrees=[2, 3], knobs=["continuation.tolerance=1e-6,1e-7"])
    paths = write(result)
    assert [path.name for path in paths] == ["study.csv", "work_precision.png", "knobs.png"]
    for path in paths[1:]:
        with Image.open(path) as image:
            pixels = np.asarray(image.convert("RGB"))
        # both degrees or quantities have drawn in their colours
        for colour in ((31, 119, 180), (255, 127, 14)):
            assert (np.abs(pixels - np.array(colour)).max(axis=2) < 8).sum() > 500
    text = shown(result)
    for word in ("reference", "2/0.5 mm", "extrapolated", "tolerance", "as in the case"):
        assert word in text
    # a table a hundred columns wide cuts nothing
    assert "…" not in text
    # nothing is left of a study that there no longer is
    assert not draw_knobs(studied(tmp_path, made_up), paths[-1])
    assert not (tmp_path / "out" / "knobs.png").exists()


@pytest.mark.slow
def test_a_real_beam_from_start_to_end(tmp_path):
    command = [sys.executable, "-m", "pantograph_fem", "study", str(CASES / "beam_arc.toml")]
    command += ["--degree", "3", "--mesh", "0.25", "--mesh", "0.125", "--output", "out"]
    options = {"cwd": tmp_path, "env": dict(os.environ), "text": True, "capture_output": True}
    done = subprocess.run(command, **options)
    assert (done.returncode, done.stderr) == (0, "")
    with (tmp_path / "out" / "study.csv").open(newline="") as file:
        table = list(csv.DictReader(file))
    errors = [float(row["force_error"]) for row in table[:2]]
    # fourth order against a mesh of half the size
    assert errors[0] / errors[1] == pytest.approx(16, rel=0.2)
    assert errors[1] < 2e-3
    for row in table:
        assert 0 < float(row["solve_seconds"]) < 3 * float(row["cpu_seconds"])
    assert "force to 1e-2: micromorphic, degree 3, 125 mm" in done.stdout
    times = [row["cpu_seconds"] for row in table]
    again = subprocess.run([*command, "--quiet"], **options)
    assert "running" in done.stdout
    assert "running" not in again.stdout
    with (tmp_path / "out" / "study.csv").open(newline="") as file:
        assert [row["cpu_seconds"] for row in csv.DictReader(file)] == times


@pytest.mark.slow
def test_a_process_tells_how_it_ended_and_what_it_took(tmp_path):
    hard = {"initial_step": 1.0, "min_step": 1.0, "max_step": 1.0, "max_iterations": 1}
    case = load_case(CASES / "beam_arc.toml", ["mesh.size=0.25", "output.figures=false"])
    stopped = case.model_copy(
        update={"continuation": case.continuation.model_copy(update=hard | {"stops": (1.0,)})}
    )
    ended = run_in_process(stopped, tmp_path / "stopped")
    assert ended.code == PathError.exit_code
    assert "load" in ended.message
    assert ended.cpu_seconds > 0.1
    assert load_case(tmp_path / "stopped" / "case.toml") == stopped
    (tmp_path / "file").write_text("")
    with pytest.raises(CaseError, match="cannot hold results"):
        run_in_process(case, tmp_path / "file")


@pytest.mark.parametrize(
    ("options", "size", "message"),
    [
        (["--degree", "9"], "1", "discretisation.degree: 9 is not allowed"),
        (["--vary", "continuation"], "1", "--vary continuation is not allowed"),
        ([], "2", "leave mpirun out"),
    ],
)
def test_the_command_refuses(tmp_path, options, size, message):
    done = subprocess.run(
        [sys.executable, "-m", "pantograph_fem", "study", str(CASES / "beam_arc.toml"), *options],
        cwd=tmp_path,
        env=dict(os.environ) | {"OMPI_COMM_WORLD_SIZE": size},
        text=True,
        capture_output=True,
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert message in done.stderr
    assert not list(tmp_path.iterdir())
