"""A run with an adapted mesh, from the case file to its summary."""

import json
import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from pantograph_fem import checkpoint
from pantograph_fem.adapt import MESH_FILE
from pantograph_fem.case import case_from_dict, load_case
from pantograph_fem.errors import CaseError
from pantograph_fem.results.history import read_history

from .conftest import COARSE, merged, run
from .test_resume import PowerCut, mortal

pytestmark = pytest.mark.core

CASES = Path(__file__).parents[1] / "cases"
#: A sheet that is soft and hardly deformed: a handful of cells will do.
EASY = merged(
    COARSE,
    {
        "grips": {"top": {"translation": [0.0, 0.02]}},
        "discretisation": {"scheme": "hinge", "degree": 2},
        "mesh": {"adapt": True, "accuracy": 0.05, "size": 0.03},
        "output": {"figures": False, "fields": "none"},
    },
)
#: Force (N) and energy (J) in the limit. Case a: Argyris' triangle in another program, whose energy
#: comes from above (docs/benchmarks.md), uncertain by 2e-6. Case c: extrapolated from four meshes
#: with up to 68 000 unknowns, uncertain by 1e-5 (force) and 2e-5 (energy).
REFERENCE = {
    "a_bias_extension": ((0.0, 56.8025), 1.071387),
    "c_rotation_45": ((6.4627, 27.9031), 0.81972),
}


def easy(**changes):
    return case_from_dict(merged(EASY, changes))


def summary(directory):
    return json.loads((directory / "summary.json").read_text())


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    return run(easy(), tmp_path_factory.mktemp("adapted"), quiet=True)


def test_summary_tells_the_accuracy_and_how_it_was_found(result):
    found = summary(result.directory)
    accuracy = found["accuracy"]
    assert accuracy["of"] == "force"
    assert accuracy["asked"] == 0.05
    assert accuracy["reached"] is True
    assert 0 < accuracy["estimated_error_force"] <= 0.05
    assert accuracy["estimated_error_energy"] > 0
    meshes = accuracy["meshes"]
    assert len(meshes) >= 2
    assert all(b["cells"] > 1.5 * a["cells"] for a, b in pairwise(meshes))
    assert meshes[0]["estimated_error_force"] is None
    # The history is of the last mesh.
    assert meshes[-1]["cells"] == found["cells"]
    assert meshes[-1]["dofs"] == found["dofs"]["displacement"]
    assert meshes[-1]["energy"] == pytest.approx(found["last"]["energy"], rel=1e-7)
    assert "is reached" in found["message"]


def test_history_is_one_path_from_rest(result):
    loads = read_history(result.directory / "history.csv")["load"]
    assert loads[0] == 0.0
    assert loads[-1] == 1.0
    assert (np.diff(loads) > 0).all()


def test_lines_are_shown_for_each_mesh_and_for_the_end(tmp_path, capsys):
    run(easy(), tmp_path)
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("mesh 1  cells ")
    assert "estimated errors: force " in lines[1]
    assert lines[-1].startswith("Estimated relative error: force ")


def test_an_accuracy_that_is_not_reached_is_said_so(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("pantograph_fem.adapt.adaptive.MAX_MESHES", 2)
    run(easy(mesh={"accuracy": 1e-5, "accuracy_of": "energy"}), tmp_path)
    found = summary(tmp_path)
    assert found["status"] == "done"
    assert found["accuracy"]["reached"] is False
    assert found["accuracy"]["estimated_error_energy"] > 1e-5
    assert "NOT reached" in capsys.readouterr().out


def test_other_runs_have_no_accuracy_and_leave_no_mesh(tmp_path, result):
    (tmp_path / MESH_FILE).write_bytes((result.directory / MESH_FILE).read_bytes())
    run(easy(mesh={"adapt": False}), tmp_path, quiet=True)
    assert "accuracy" not in summary(tmp_path)
    assert not (tmp_path / MESH_FILE).exists()


def test_an_interrupted_run_goes_on_with_its_mesh(tmp_path, result, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(checkpoint, "save", mortal(checkpoint.save, survived=2))
        with pytest.raises(PowerCut):
            run(easy(), tmp_path, quiet=True)
    monkeypatch.setattr("pantograph_fem.adapt.adapted_sheet.adapt", None)  # once is enough
    run(easy(), tmp_path, resume=True, quiet=True)
    whole, resumed = (read_history(d / "history.csv") for d in (result.directory, tmp_path))
    for column in ("load", "force_y", "energy"):
        np.testing.assert_allclose(resumed[column], whole[column], rtol=1e-6, atol=1e-9)
    assert summary(tmp_path)["accuracy"]["reached"] is True

    (tmp_path / MESH_FILE).unlink(missing_ok=True)
    with pytest.raises(CaseError, match=f"{MESH_FILE}.*start anew without --resume"):
        run(easy(), tmp_path, resume=True, quiet=True)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "degree", "of", "asked"),
    [*((name, 3, "force", 1e-3) for name in REFERENCE), ("a_bias_extension", 5, "energy", 1e-4)],
)
def test_estimated_errors_are_those_that_there_are(name, degree, of, asked, tmp_path):
    """An accuracy is reached, and neither estimate is far from the true error."""
    overrides = [
        "mesh.adapt=true",
        f"mesh.accuracy={asked}",
        f"mesh.accuracy_of={of}",
        "discretisation.scheme=hinge",
        f"discretisation.degree={degree}",
        "output.figures=false",
        "output.fields=none",
    ]
    case = load_case(CASES / f"{name}.toml", overrides)
    last = run(case, tmp_path, quiet=True).rows[-1]
    accuracy = summary(tmp_path)["accuracy"]
    assert accuracy["reached"] is True
    force, energy = REFERENCE[name]
    error_force = math.dist(last.force, force) / math.hypot(*force)
    error_energy = abs(last.energy / energy - 1)
    assert {"force": error_force, "energy": error_energy}[of] < asked
    assert 0.5 < accuracy["estimated_error_force"] / error_force < 5
    assert 0.5 < accuracy["estimated_error_energy"] / error_energy < 5
