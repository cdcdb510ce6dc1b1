"""Runs of beams, chains and lattices: what they leave, resumed and in parallel."""

import json
import subprocess
import sys

import meshio
import numpy as np
import pytest
from scipy.integrate import trapezoid

from pantograph_fem.case import case_from_dict, case_to_toml
from pantograph_fem.errors import PathError
from pantograph_fem.plot import plot
from pantograph_fem.results.fields import read_fields
from pantograph_fem.results.history import header, read_history

from .conftest import merged, run
from .processes import SEVERAL

pytestmark = pytest.mark.core

COMMON = {"continuation": {"stops": [0.5, 1.0]}, "output": {"figures": False}}
BEAM = merged(
    COMMON,
    {
        "name": "small_beam",
        "kind": "beam",
        "beam": {"length": 1.0},
        "material": {
            "stretch": 4.05e8,
            "bending": 7.59e5,
            "foundation": [{"to": 0.5, "stiffness": 1e7}, {"to": 1.0, "stiffness": 1e5}],
        },
        "ends": {"right": {"support": "pinned", "translation": [-0.1, 0.2]}},
        "output": {"probes": [[0.25, 0.0], [1.0, 0.0]]},
    },
)
CHAIN = merged(BEAM, {"name": "small_chain", "kind": "chain", "chain": {"spacing": 0.02}})
BEAM = merged(BEAM, {"mesh": {"size": 0.1}})
LATTICE = merged(
    COMMON,
    {
        "name": "small_lattice",
        "kind": "lattice",
        "sheet": {"width": 0.068, "height": 0.204},
        "material": {
            "stretch": 1.34e5,
            "bending": 1.92e-2,
            "shear": 1.59e2,
            "shear_exponent": 1.36,
        },
        "grips": {"top": {"hold": "clamp", "translation": [0.0, 0.03], "rotation": 10.0}},
        "lattice": {"spacing": 0.0096},
        "output": {"probes": [[0.034, 0.102], [0.034, 0.204], [0.07 / 3, 0.1]]},
    },
)
KINDS = {"beam": BEAM, "chain": CHAIN, "lattice": LATTICE}


@pytest.fixture(scope="module", params=KINDS)
def results(request, tmp_path_factory):
    """A finished run of each kind, with everything there is to write."""
    case = case_from_dict(merged(KINDS[request.param], {"output": {"figures": True}}))
    return case, run(case, tmp_path_factory.mktemp(request.param), quiet=True).directory


def test_the_history_begins_with_the_same_columns_for_every_kind(results):
    case, directory = results
    columns = (directory / "history.csv").read_text().splitlines()[0].split(",")
    common = header(0)
    assert columns[: len(common)] == common
    extra = [] if case.kind == "lattice" else ["energy_foundation", "tip_ux", "tip_uy", "tip_angle"]
    assert columns[len(common) :] == extra + [
        f"probe{i}_u{x}" for i in range(len(case.output.probes)) for x in "xy"
    ]


def test_the_energy_is_the_sum_of_its_parts_and_the_state_stable(results):
    _, directory = results
    history = read_history(directory / "history.csv")
    parts = [values for name, values in history.items() if name.startswith("energy_")]
    np.testing.assert_allclose(np.sum(parts, axis=0), history["energy"], rtol=1e-12, atol=1e-18)
    assert (history["energy"][1:] > 0).all()
    assert history["stable"].all()
    assert {0.5, 1.0} <= set(history["load"])


def test_probes_move_as_the_fields_say(results):
    case, directory = results
    history = read_history(directory / "history.csv")
    states = read_fields(directory)
    u = states.fields(-1)["displacement"]
    distance = np.linalg.norm(states.grid.points[:, None] - np.array(case.output.probes), axis=2)
    exact = 0
    for i, node in enumerate(distance.argmin(axis=0)):
        if distance[node, i] < 1e-9:
            exact += 1
            probe = [history[f"probe{i}_u{x}"][-1] for x in "xy"]
            np.testing.assert_allclose(probe, u[node], atol=1e-12)
    assert exact >= 1


def test_densities_add_up_to_the_energy(results):
    """Nodal densities times the part of the body at each node."""
    case, directory = results
    states = read_fields(directory)
    fields = states.fields(-1)
    effects = [name for name in fields if name.startswith("energy_density_")]
    total = sum(fields[name] for name in effects)
    np.testing.assert_allclose(total, fields["energy_density"], rtol=1e-9, atol=1e-9)
    if case.kind == "lattice":
        return
    energy = trapezoid(fields["energy_density"], states.grid.points[:, 0])
    history = read_history(directory / "history.csv")
    # The chain's node at the clamp holds half a link, over half a link's length.
    assert energy == pytest.approx(history["energy"][-1], rel=2e-3)


def test_other_programs_read_the_fields(results):
    case, directory = results
    with meshio.xdmf.TimeSeriesReader(directory / "fields.xdmf") as reader:
        points, cells = reader.read_points_cells()
        load, nodal, cellwise = reader.read_data(reader.num_steps - 1)
    assert load == 1.0
    assert cells[0].type == "line"
    assert nodal["displacement"].shape == (len(points), 3)
    if case.kind != "beam":
        assert cellwise["stretch"][0].shape == (len(cells[0].data),)


@pytest.mark.skipif(SEVERAL, reason="each process would draw them")
def test_figures_are_drawn_and_redrawn(results):
    case, directory = results
    names = {path.name for path in (directory / "figures").glob("*.png")}
    expected = {"force_displacement.png"}
    if case.kind == "lattice":
        expected |= {
            f"{q}_{s}.png" for q in ("shear_angle", "energy_density") for s in ("050", "100")
        }
    else:
        expected |= {"shapes.png", "profiles.png"}
    assert names == expected
    assert {path.name for path in plot(directory)} == expected


def test_the_summary_counts_cells_and_unknowns(results):
    case, directory = results
    summary = json.loads((directory / "summary.json").read_text())
    assert summary["status"] == "done"
    nodes = len(read_fields(directory).grid.points)
    if case.kind == "beam":
        assert summary["cells"] == 10
        degree = case.discretisation.degree
        assert summary["dofs"]["displacement"] == 2 * (10 * degree + 1)
    else:
        assert summary["dofs"] == {"displacement": 2 * nodes}
        assert summary["cells"] == len(read_fields(directory).grid.cells)


@pytest.mark.parametrize("kind", KINDS)
def test_a_resumed_run_ends_with_the_same_history(tmp_path, kind):
    base = KINDS[kind]
    whole = run(case_from_dict(base), tmp_path / "whole", quiet=True).directory
    hard = merged(base, {"continuation": {"initial_step": 0.5, "min_step": 0.5, "max_step": 0.5}})
    broken = merged(hard, {"continuation": {"max_iterations": 1, "stops": [0.5, 1.0]}})
    with pytest.raises(PathError):
        run(case_from_dict(broken), tmp_path / "part", quiet=True)
    resumed = run(case_from_dict(base), tmp_path / "part", resume=True, quiet=True).directory
    last, again = (read_history(d / "history.csv") for d in (whole, resumed))
    for name in ("force_x", "force_y", "moment", "energy"):
        assert again[name][-1] == pytest.approx(last[name][-1], rel=1e-6, abs=1e-9)


@pytest.mark.skipif(SEVERAL, reason="starts a process of its own")
def test_a_lattice_needs_no_finite_elements(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(case_to_toml(case_from_dict(LATTICE)))
    script = (
        "import sys; from pathlib import Path\n"
        "from pantograph_fem.case import load_case\n"
        "from pantograph_fem.running import run\n"
        f"run(load_case(Path({str(path)!r})), Path({str(tmp_path / 'r')!r}), quiet=True)\n"
        "print([m for m in ('dolfinx', 'ufl', 'gmsh', 'meshio', 'matplotlib') if m in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, timeout=120
    )
    assert done.stdout.strip() == "[]"


def test_only_effects_with_a_stiffness_make_fields(tmp_path):
    """A string on a foundation has displacements alone; a beam without one no column for it."""
    string = merged(
        BEAM,
        {
            "material": {"bending": None},
            "ends": {"left": {"support": "pinned"}, "right": {"translation": [0.1, 0.2]}},
        },
    )
    directory = run(case_from_dict(string), tmp_path / "string", quiet=True).directory
    summary = json.loads((directory / "summary.json").read_text())
    assert set(summary["dofs"]) == {"displacement"}
    assert "curvature" not in read_fields(directory).fields(-1)

    beam = merged(BEAM, {"material": {"foundation": None}})
    directory = run(case_from_dict(beam), tmp_path / "beam", quiet=True).directory
    assert "energy_foundation" not in read_history(directory / "history.csv")
    assert "energy_density_foundation" not in read_fields(directory).fields(-1)
