"""The command as a user runs it: what it prints where, its exit codes, what it leaves."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import meshio
import numpy as np
import pytest
import tomli_w

from pantograph_fem.case import load_case
from pantograph_fem.results.fields import read_fields
from pantograph_fem.results.history import read_history

from .conftest import COARSE, MPIRUN, merged

PANTOGRAPH = str(Path(sys.executable).with_name("pantograph"))
CASES = Path(__file__).parents[1] / "cases"
SMALL = merged(COARSE, {"discretisation": {"degree": 2}, "output": {"figures": False}})
#: A step too long for its iterations that may not be cut back.
TOO_HARD = {
    "initial_step": 1.0,
    "min_step": 1.0,
    "max_step": 1.0,
    "max_iterations": 2,
}
ESCAPE = "\x1b"


def pantograph(*arguments, cwd, launcher=()):
    """Run the command to its end."""
    return subprocess.run(
        [*launcher, PANTOGRAPH, *map(str, arguments)],
        cwd=cwd,
        # Without what Open MPI adds behind Python's back once a test has loaded it in this
        # process: mpirun would take it that it is itself under mpirun.
        env=dict(os.environ),
        capture_output=True,
        text=True,
        timeout=300,
    )


def write_case(folder, name="case.toml", **changes):
    path = folder / name
    path.write_text(tomli_w.dumps(merged(SMALL, changes)))
    return path


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A folder in which a case was run with the defaults of the command line."""
    folder = tmp_path_factory.mktemp("cli")
    write_case(folder, output={"figures": True})
    return folder, pantograph("run", "case.toml", cwd=folder)


def assert_refused(done, code, *sentences):
    """A message on standard error that says these things, no traceback, no other output."""
    assert done.returncode == code, done.stderr
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    for sentence in sentences:
        assert sentence in done.stderr


def test_a_run_succeeds_and_says_where_its_results_are(finished):
    folder, done = finished
    assert (done.returncode, done.stderr) == (0, "")
    results = folder / "results" / "coarse"
    last_line = done.stdout.splitlines()[-1]
    assert last_line.endswith("results are in results/coarse")
    for name in ("history.csv", "fields.xdmf", "fields.h5", "summary.json", "case.resolved.toml"):
        assert (results / name).is_file()
    assert list((results / "figures").glob("*.png"))
    assert json.loads((results / "summary.json").read_text())["status"] == "done"


def test_without_a_terminal_each_step_is_a_plain_line(finished):
    folder, done = finished
    assert ESCAPE not in done.stdout
    rows = read_history(folder / "results" / "coarse" / "history.csv")
    *lines, _ = done.stdout.splitlines()
    assert len(lines) == len(rows["load"])
    for line, load, force in zip(lines, rows["load"], rows["force_y"], strict=True):
        found = re.fullmatch(
            r"step \d+  load (\S+)  iterations \d+  force (\S+) N  energy \S+ J", line
        )
        assert found
        assert float(found[1]) == pytest.approx(load, abs=1e-4)
        assert float(found[2]) == pytest.approx(force, rel=1e-3, abs=1e-9)


def test_on_a_terminal_a_bar_shows_the_progress(tmp_path):
    write_case(tmp_path, title="A bar [of] sorts", output={"fields": "none"})
    master, slave = os.openpty()
    process = subprocess.Popen(
        [PANTOGRAPH, "run", "case.toml"],
        cwd=tmp_path,
        stdout=slave,
        stderr=subprocess.PIPE,
        env={**os.environ, "TERM": "xterm", "COLUMNS": "140"},
    )
    os.close(slave)
    shown = b""
    while True:
        try:
            chunk = os.read(master, 4096)
        except OSError:  # the other end is closed
            break
        shown += chunk
        if not chunk:
            break
    os.close(master)
    _, errors = process.communicate(timeout=60)
    assert (process.returncode, errors) == (0, b"")
    text = shown.decode()
    assert ESCAPE in text
    for part in ("A bar [of] sorts", "load 1.0000", "iterations", "force 1"):
        assert part in text


def test_quiet_prints_nothing(tmp_path):
    write_case(tmp_path, output={"fields": "none"})
    done = pantograph("run", "case.toml", "--quiet", "--output", "here", cwd=tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert (tmp_path / "here" / "summary.json").is_file()


def test_set_replaces_values_of_the_file(tmp_path):
    write_case(tmp_path)
    done = pantograph(
        *("run", "case.toml", "--quiet"),
        *("--output", "out with spaces/and é"),
        *("--set", "grips.top.translation=[0.01, 0.0]"),
        *("--set", "output.fields=none"),
        *("--set", 'title="Sheared"'),
        cwd=tmp_path,
    )
    assert (done.returncode, done.stderr) == (0, "")
    out = tmp_path / "out with spaces" / "and é"
    assert not (out / "fields.xdmf").exists()
    resolved = load_case(out / "case.resolved.toml")
    assert resolved.title == "Sheared"
    assert resolved.grips.top.translation == (0.01, 0.0)
    last = json.loads((out / "summary.json").read_text())["last"]
    assert last["force_x"] > 0.1 * abs(last["force_y"])


def test_plot_draws_the_figures_again(finished):
    folder, _ = finished
    figures = folder / "results" / "coarse" / "figures"
    before = {path.name: path.read_bytes() for path in figures.iterdir()}
    shutil.rmtree(figures)
    done = pantograph("plot", "results/coarse", cwd=folder)
    assert (done.returncode, done.stderr) == (0, "")
    assert {path.name: path.read_bytes() for path in figures.iterdir()} == before
    figures = [f"results/coarse/figures/{name}" for name in sorted(before)]
    assert done.stdout.splitlines() == [*figures, "results/coarse/report.html"]


def test_check_accepts_a_case_in_under_a_second_without_dolfinx(tmp_path):
    case = write_case(tmp_path)
    done = subprocess.run(
        [sys.executable, "-X", "importtime", "-m", "pantograph_fem", "check", str(case)],
        capture_output=True,
        text=True,
        timeout=60,
        cwd=tmp_path,
    )
    assert done.returncode == 0
    assert done.stdout == f"{case} is valid: coarse (sheet)\n"
    imported = {line.split("|")[-1].strip() for line in done.stderr.splitlines()}
    assert "pantograph_fem.case" in imported
    assert not imported & {"dolfinx", "petsc4py", "mpi4py", "numpy", "gmsh", "matplotlib"}
    assert list(tmp_path.iterdir()) == [case]

    before = os.times()
    pantograph("check", case, cwd=tmp_path)
    after = os.times()
    used = (after.children_user - before.children_user) + (
        after.children_system - before.children_system
    )
    assert used < 1.0


@pytest.mark.parametrize("path", sorted(CASES.glob("*.toml")), ids=lambda path: path.stem)
def test_every_shipped_case_is_valid(path):
    assert load_case(path).name == path.stem


def test_check_and_run_refuse_a_bad_case_in_the_same_words(tmp_path):
    write_case(tmp_path, material={"shear_exponent": 1.0, "stretchh": 3.0})
    checked, ran = (pantograph(command, "case.toml", cwd=tmp_path) for command in ("check", "run"))
    assert_refused(checked, 2, "case.toml is wrong", "material.shear_exponent: 1.0 is not allowed")
    assert_refused(ran, 2, 'material.stretchh: unknown key; did you mean "stretch"?')
    assert checked.stderr == ran.stderr
    assert not (tmp_path / "results").exists()


@pytest.mark.parametrize(
    ("arguments", "sentences"),
    [
        (["run", "no.toml"], ["no.toml is not found; give the path of a case file"]),
        (["run", "case.toml", "--set", "mesh.size"], ["not of the form key.path=value"]),
        (["run", "case.toml", "--set", "mesh.size=-1"], ["mesh.size: -1", "greater than 0"]),
        (
            ["run", "case.toml", "--set", "output.probes=[[0.1, 0.1]]"],
            ["output.probes[0]: [0.1, 0.1] is not allowed", "lie in the sheet"],
        ),
        (["run", "case.toml", "--speed", "fast"], ["--speed"]),
        (["run"], ["CASE.toml"]),
        (["simulate", "case.toml"], ["simulate"]),
        (["plot", "."], ["holds no results"]),
    ],
    ids=lambda value: " ".join(value) if value and value[0] in ("run", "plot", "simulate") else "",
)
def test_wrong_arguments_are_refused(tmp_path, arguments, sentences):
    write_case(tmp_path)
    assert_refused(pantograph(*arguments, cwd=tmp_path), 2, *sentences)
    assert [path.name for path in tmp_path.iterdir()] == ["case.toml"]


def test_a_mesh_without_labels_is_refused(tmp_path):
    mesh = meshio.Mesh(
        np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]), [("triangle", np.array([[0, 1, 2]]))]
    )
    meshio.write(tmp_path / "plain.inp", mesh)
    write_case(tmp_path, mesh={"file": "plain.inp", "size": None, "corner_size": None})
    done = pantograph("run", "case.toml", cwd=tmp_path)
    assert_refused(done, 2, "plain.inp", 'has no group "bottom"')
    assert not (tmp_path / "results").exists()


def test_a_path_that_cannot_be_followed_ends_with_3_and_keeps_its_results(tmp_path):
    write_case(tmp_path, continuation=TOO_HARD)
    done = pantograph("run", "case.toml", cwd=tmp_path)
    assert done.returncode == 3
    assert "Traceback" not in done.stderr
    (message,) = done.stderr.splitlines()
    assert "beyond load factor 0:" in message  # the load
    assert "no convergence within max_iterations" in message  # the cause
    assert "continuation.max_iterations" in message  # the setting
    results = tmp_path / "results" / "coarse"
    assert read_history(results / "history.csv")["load"].tolist() == [0.0]
    assert json.loads((results / "summary.json").read_text())["status"] == f"stopped: {message}"
    redrawn = pantograph("plot", results, cwd=tmp_path)
    assert redrawn.returncode == 0, redrawn.stderr


@pytest.mark.parametrize("output", ["case.toml", "case.toml/inside"])
def test_an_output_that_cannot_be_a_folder_is_refused(tmp_path, output):
    write_case(tmp_path)
    done = pantograph("run", "case.toml", "--output", output, cwd=tmp_path)
    assert_refused(done, 2, output)


def started(folder):
    """A run of the case in a folder, whose output can be read while it goes on."""
    return subprocess.Popen(
        [PANTOGRAPH, "run", "case.toml"],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # What is started in the background by a script ignores interrupts, and so would the run.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )


def test_a_reader_that_goes_away_is_no_crash(tmp_path):
    write_case(tmp_path, continuation={"max_step": 0.05}, output={"fields": "none"})
    with started(tmp_path) as process:
        process.stdout.readline()
        process.stdout.close()
        errors = process.stderr.read()
    assert "PETSC ERROR" not in errors
    assert "Traceback" not in errors


def test_a_broken_pipe_that_is_not_the_reader_is_an_error():
    program = (
        "from pantograph_fem import cli\n"
        "@cli.app.command()\n"
        "def leak(): raise BrokenPipeError(32, 'of a helper')\n"
        "cli.main()\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, "leak"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert "of a helper" in done.stderr


def test_an_interrupt_says_how_to_go_on(tmp_path):
    write_case(tmp_path, continuation={"max_step": 0.01}, output={"fields": "none"})
    with started(tmp_path) as process:
        process.stdout.readline()
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate()
    assert process.returncode == 1
    assert "--resume" in errors


@pytest.fixture(scope="module")
def one_and_two(tmp_path_factory):
    """The folder of the same case run by one process and by two, and how the command ended."""
    folder = tmp_path_factory.mktemp("mpi")
    write_case(folder, output={"probes": [[0.034, 0.102], [0.0, 0.0], [0.068, 0.15]]})
    ends = [
        pantograph("run", "case.toml", "--quiet", "--output", name, cwd=folder, launcher=launcher)
        for name, launcher in (("one", ()), ("two", MPIRUN))
    ]
    return folder, ends


@pytest.mark.slow
def test_two_processes_find_what_one_finds(one_and_two):
    folder, ends = one_and_two
    assert [(done.returncode, done.stdout) for done in ends] == [(0, "")] * 2
    one, two = (read_history(folder / name / "history.csv") for name in ("one", "two"))
    for column in ("step", "load", "negative_pivots", "expected_negative_pivots", "stable"):
        assert two[column].tolist() == one[column].tolist()
    scale = np.abs(one["force_y"]).max()
    for column in ("force_x", "force_y", "energy", "shear_max", "probe0_uy", "probe2_ux"):
        size = scale if column.startswith("force") else np.abs(one[column]).max()
        np.testing.assert_allclose(two[column], one[column], rtol=0, atol=1e-9 * size)
    summaries = [
        json.loads((folder / name / "summary.json").read_text()) for name in ("one", "two")
    ]
    assert summaries[0]["dofs"] == summaries[1]["dofs"]
    assert summaries[0]["cells"] == summaries[1]["cells"]


@pytest.mark.slow
def test_two_processes_save_the_fields_of_one(one_and_two):
    folder, _ = one_and_two
    one, two = (read_fields(folder / name) for name in ("one", "two"))
    distance = np.linalg.norm(one.grid.points[:, None] - two.grid.points[None], axis=2)
    same = distance.argmin(axis=1)
    assert distance.min(axis=1).max() < 1e-12
    assert sorted(same) == list(range(len(two.grid.points)))
    expected, found = one.fields(-1), two.fields(-1)
    assert expected.keys() == found.keys()
    for name, values in expected.items():
        np.testing.assert_allclose(
            found[name][same], values, rtol=0, atol=1e-8 * np.abs(values).max()
        )


@pytest.mark.slow
def test_two_processes_warn_of_nothing(one_and_two):
    _, ends = one_and_two
    assert all("Warning" not in done.stderr for done in ends)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("changes", "code"),
    [({"output": {"probes": [[0.1, 0.1]]}}, 2), ({"continuation": TOO_HARD}, 3)],
)
def test_two_processes_end_together_with_the_code_of_one(tmp_path, changes, code):
    write_case(tmp_path, **changes)
    done = pantograph("run", "case.toml", "--quiet", cwd=tmp_path, launcher=MPIRUN)
    assert done.returncode == code
    assert "Traceback" not in done.stderr
