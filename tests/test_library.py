"""The package from Python: what it offers, what it imports, what it returns."""

import copy
import os
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import pantograph_fem as pf
from pantograph_fem.case import case_to_toml

ROOT = Path(__file__).parents[1]
CHAIN = {
    "name": "chain",
    "kind": "chain",
    "beam": {"length": 1.0},
    "material": {"stretch": 4.05e8, "bending": 7.59e5},
    "chain": {"spacing": 0.125},
    "ends": {"right": {"support": "free", "moment": 2.0e6}},
    "continuation": {"stops": [0.5, 1.0], "max_step": 0.25},
    "output": {"figures": False, "probes": [[1.0, 0.0]]},
}
#: A step too long for its iterations that may not be cut back.
TOO_HARD = ["continuation.initial_step=1", "continuation.min_step=1", "continuation.max_step=1"]
TOO_HARD += ["continuation.stops=[1.0]", "continuation.max_iterations=1"]


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    return pf.run(CHAIN, tmp_path_factory.mktemp("library") / "chain")


def python(script, folder):
    return subprocess.run(
        [sys.executable, "-c", script],
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
        cwd=folder,
        env=dict(os.environ),
    ).stdout.strip()


def test_importing_it_is_light_and_checking_a_case_loads_no_numerics(tmp_path):
    (tmp_path / "case.toml").write_text(case_to_toml(pf.case_from_dict(CHAIN)))
    heavy = "[m for m in ('pydantic', 'numpy', 'h5py', 'dolfinx', 'mpi4py', 'matplotlib')"
    script = (
        "import sys, pantograph_fem as pf\n"
        f"print({heavy} if m in sys.modules])\n"
        "pf.load_case('case.toml'); pf.case_from_dict; pf.PathError; pf.SheetCase\n"
        f"print({heavy} if m in sys.modules])\n"
    )
    assert python(script, tmp_path).splitlines() == ["[]", "['pydantic']"]


def test_no_module_of_the_package_takes_the_name_of_what_it_offers():
    """Importing a submodule would put it in the place of a function of its name."""
    modules = {module.name for module in pkgutil.iter_modules(pf.__path__)}
    assert {"api", "running", "results"} <= modules
    assert modules.isdisjoint(pf.__all__)


def test_every_name_is_there_and_no_other():
    assert dir(pf) == sorted(pf.__all__)
    assert all(getattr(pf, name) is not None for name in pf.__all__)
    assert pf.run.__name__ == "run"
    assert issubclass(pf.PathError, pf.PantographError)
    with pytest.raises(AttributeError, match="no attribute 'simulate'"):
        _ = pf.simulate


def test_a_result_is_what_is_in_the_folder(result):
    assert (result.status, result.done) == ("done", True)
    history = result.history
    assert history["load"][[0, -1]].tolist() == [0.0, 1.0]
    assert history["stable"].dtype == bool
    assert result.last["moment"] == pytest.approx(2.0e6)
    assert result.last == result.summary["last"] | {"stable": True}
    assert result.case == pf.case_from_dict(CHAIN)
    assert (result.figures, result.report) == ([], None)
    again = pf.read(str(result.directory))
    assert again == result
    np.testing.assert_equal(again.history, history)


def test_states_are_arrays_by_name(result):
    states = result.fields()
    assert len(states) == len(result.history["load"])
    np.testing.assert_array_equal(states.loads, result.history["load"])
    for state, ux in zip(states, result.history["probe0_ux"], strict=True):
        tip = np.argmax(state.points[:, 0])
        assert state["displacement"][tip, 0] == ux
        assert state.deformed[tip, 0] == 1.0 + ux
    last = states[-1]
    assert last.load == states.at(1.0).load == 1.0
    assert last.cells.shape == (8, 2)
    assert set(last) >= {"displacement", "angle"}
    assert len(states[1:3]) == 2
    with pytest.raises(KeyError):
        last["shear_angle"]
    with pytest.raises(IndexError):
        states[len(states)]
    with pytest.raises(pf.CaseError, match=r"no saved state at load factor 0\.3"):
        states.at(0.3)


def test_a_case_may_be_a_path_tables_or_a_case(result, tmp_path):
    path, tables = tmp_path / "case.toml", copy.deepcopy(CHAIN)
    path.write_text(case_to_toml(pf.case_from_dict(CHAIN)))
    stiffer, angles = ["material.bending=1.518e6"], []
    for case in (str(path), tables, pf.load_case(path)):
        other = pf.run(case, tmp_path / "results", set=stiffer)
        assert other.case.material.bending == 1.518e6
        angles.append(other.last["tip_angle"])
    assert angles == [angles[0]] * 3
    assert angles[0] == pytest.approx(result.last["tip_angle"] / 2, rel=0.05)
    assert tables == CHAIN


def test_results_go_to_a_folder_of_the_name_of_the_case(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert pf.run(CHAIN, set=["name=mine", "output.report=true"]).directory == Path("results/mine")
    assert pf.read("results/mine").report == Path("results/mine/report.html")


def test_wrong_cases_are_refused(tmp_path):
    with pytest.raises(pf.CaseError, match=r"material\.shear"):
        pf.run(CHAIN, tmp_path / "r", set=["material.shear=1"])
    with pytest.raises(pf.CaseError, match="list of texts"):
        pf.run(CHAIN, tmp_path / "r", set="material.bending=1")
    with pytest.raises(pf.CaseError, match="is not found"):
        pf.run(tmp_path / "case.toml", tmp_path / "r")
    with pytest.raises(pf.CaseError, match="holds no results"):
        pf.read(tmp_path / "r")
    assert not list(tmp_path.iterdir())


def test_a_path_that_ends_early_gives_what_it_found(tmp_path):
    with pytest.raises(pf.PathError) as caught:
        pf.run(CHAIN, tmp_path, set=TOO_HARD)
    found = caught.value.result
    assert found.history["load"].tolist() == [0.0]
    assert found.status == f"stopped: {caught.value}"
    assert not found.done


def test_an_interrupted_run_can_be_read_and_gone_on_from(tmp_path):
    pf.run(CHAIN, tmp_path)
    (tmp_path / "summary.json").unlink()
    left = pf.read(tmp_path)
    assert (left.status, left.summary) == ("not finished", {})
    more = ["ends.right.moment=2.0e6", "continuation.stops=[0.5, 0.9, 1.0]"]
    resumed = pf.run(CHAIN, tmp_path, resume=True, set=more)
    assert resumed.done
    assert resumed.last["load"] == 1.0


def test_the_readme_is_right(tmp_path, monkeypatch):
    section = (ROOT / "README.md").read_text().split("\n## From Python\n")[1].split("\n## ")[0]
    (script,) = re.findall(r"```python\n(.*?)```", section, re.DOTALL)
    assert len(script.strip().splitlines()) <= 12
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(compile(script, "README.md", "exec"), names)
    assert names["result"].done
    assert names["result"].directory == Path("results") / names["result"].case.name


@pytest.mark.slow
def test_the_reference_is_built_without_warnings(tmp_path):
    pytest.importorskip("sphinx", reason="sphinx builds the reference: pip install '.[docs]'")
    done = subprocess.run(
        [
            *(sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q"),
            *("-d", str(tmp_path / "doctrees"), str(ROOT / "docs" / "api"), str(tmp_path / "html")),
        ],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    page = (tmp_path / "html" / "running.html").read_text()
    for name in ("run", "read", "Result.history", "States.at", "PathError"):
        assert f'id="pantograph_fem.{name}"' in page
