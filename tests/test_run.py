"""What a run leaves in its directory, whether it came to the end or not."""

import json
import re
import tomllib

import meshio
import numpy as np
import pytest
import pyvista
from PIL import Image

from pantograph_fem.case import case_from_dict, load_case
from pantograph_fem.errors import CaseError, PathError
from pantograph_fem.results.fields import read_fields
from pantograph_fem.results.history import read_history

from .conftest import COARSE, merged, run
from .processes import SEVERAL

pytestmark = pytest.mark.core

W, H = 0.068, 0.204
TRANSLATION, ANGLE = np.array([0.01, 0.02]), 25.0
STOPS = [0.1 + 0.2, 0.5, 1.0]
PROBES = [[0.034, 0.102], [0.0, 0.0], [0.034, 0.204]]
#: An easy step to 0.02, and then one that is too long for its iterations and may not be cut back.
TOO_HARD = {
    "grips": {"top": {"translation": [0.0, 0.06], "rotation": None}},
    "continuation": {
        "stops": [0.02, 1.0],
        "initial_step": 0.5,
        "min_step": 0.5,
        "max_step": 0.5,
        "max_iterations": 2,
    },
}


def small(**changes):
    base = merged(
        COARSE,
        {
            "name": "small",
            "discretisation": {"degree": 2},
            "grips": {"top": {"translation": TRANSLATION.tolist(), "rotation": ANGLE}},
        },
    )
    return case_from_dict(merged(base, changes))


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """A run with everything that there is to write."""
    case = small(continuation={"stops": STOPS}, output={"probes": PROBES})
    return run(case, tmp_path_factory.mktemp("run"), quiet=True)


@pytest.fixture
def history(result):
    return read_history(result.directory / "history.csv")


def names(directory):
    return sorted(path.name for path in directory.iterdir())


def test_a_run_leaves_the_files_of_the_interface_and_no_others(result):
    assert names(result.directory) == [
        "case.resolved.toml",
        "checkpoint.npz",
        "fields.h5",
        "fields.xdmf",
        "figures",
        "history.csv",
        "report.html",
        "summary.json",
    ]


def test_history_starts_at_rest_and_hits_every_stop_exactly(result, history):
    header, first, *_ = (result.directory / "history.csv").read_text().splitlines()
    assert header == (
        "step,load,force_x,force_y,moment,energy,energy_stretch,energy_bending,energy_shear,"
        "newton_iterations,negative_pivots,expected_negative_pivots,stable,shear_min,shear_max,"
        "probe0_ux,probe0_uy,probe1_ux,probe1_uy,probe2_ux,probe2_uy"
    )
    assert first.startswith("0,0.0,")
    assert set(STOPS) <= set(history["load"].tolist())
    assert history["step"].tolist() == list(range(len(result.rows)))
    assert (np.diff(history["load"]) > 0).all()
    assert history["stable"].all()


def test_history_columns_agree_with_each_other(history):
    effects = [history[f"energy_{name}"] for name in ("stretch", "bending", "shear")]
    np.testing.assert_allclose(history["energy"], np.sum(effects, axis=0), rtol=1e-12)
    assert (
        history["stable"] == (history["negative_pivots"] == history["expected_negative_pivots"])
    ).all()
    assert (history["shear_min"] <= history["shear_max"]).all()
    for column in ("force_x", "force_y", "moment", "energy", "shear_min", "shear_max"):
        assert abs(history[column][0]) < 1e-9


def test_probes_on_the_grips_move_with_them(history):
    load = history["load"]
    np.testing.assert_allclose(history["probe2_ux"], load * TRANSLATION[0], atol=1e-15)
    np.testing.assert_allclose(history["probe2_uy"], load * TRANSLATION[1], atol=1e-15)
    np.testing.assert_allclose(history["probe1_ux"], 0.0, atol=1e-15)
    assert 0.2 * TRANSLATION[1] < history["probe0_uy"][-1] < 0.8 * TRANSLATION[1]


def test_summary_repeats_the_last_row_and_says_what_it_took(result):
    summary = json.loads((result.directory / "summary.json").read_text())
    assert summary["status"] == "done"
    assert summary["last"] == result.rows[-1].columns()
    last_line = (result.directory / "history.csv").read_text().splitlines()[-1].split(",")
    assert [float(text) for text in last_line] == list(map(float, summary["last"].values()))
    assert set(summary["dofs"]) == {"displacement", "gradient", "multiplier"}
    assert summary["cells"] > 0
    phases = summary["seconds"]
    assert set(phases) == {"mesh", "compile", "assemble", "solve", "output", "total"}
    total = phases.pop("total")
    assert 0.5 * total < sum(phases.values()) <= total + 0.01
    assert {"python", "dolfinx", "petsc4py", "numpy"} <= set(summary["versions"])


def test_the_resolved_case_gives_the_same_run_again(result, history, tmp_path):
    path = result.directory / "case.resolved.toml"
    again = run(load_case(path), tmp_path / "again", quiet=True)
    assert (again.directory / "case.resolved.toml").read_text() == path.read_text()
    repeated = read_history(again.directory / "history.csv")
    assert repeated.keys() == history.keys()
    for name, values in history.items():
        scale = np.abs(values.astype(float)).max()
        np.testing.assert_allclose(
            repeated[name].astype(float), values.astype(float), rtol=1e-10, atol=1e-10 * scale
        )


def test_paraview_warps_the_sheet_to_where_the_grips_hold_it(result):
    reader = pyvista.get_reader(result.directory / "fields.xdmf")
    assert reader.time_values == [row.load for row in result.rows]
    reader.set_active_time_value(1.0)
    mesh = reader.read()
    X, u = np.asarray(mesh.points), np.asarray(mesh["displacement"])
    assert u.shape == (mesh.n_points, 3)
    np.testing.assert_array_equal(u[:, 2], 0.0)
    at_top, at_bottom = np.abs(X[:, 1] - H) < 1e-6, np.abs(X[:, 1]) < 1e-6
    assert at_top.sum() >= 7
    np.testing.assert_allclose(u[at_bottom], 0.0, atol=1e-12)
    c, s = np.cos(np.radians(ANGLE)), np.sin(np.radians(ANGLE))
    centre = np.array([W / 2, H])
    expected = centre + TRANSLATION + (X[at_top, :2] - centre) @ np.array([[c, s], [-s, c]])
    warped = np.asarray(mesh.warp_by_vector("displacement").points)
    np.testing.assert_allclose(warped[at_top, :2], expected, atol=1e-7)  # points: single precision


def test_energy_density_integrates_to_the_energy(result):
    """About: at the nodes it is an average over the elements that meet there."""
    with meshio.xdmf.TimeSeriesReader(result.directory / "fields.xdmf") as reader:
        points, cells = reader.read_points_cells()
        assert reader.num_steps == len(result.rows)
        load, fields, _ = reader.read_data(reader.num_steps - 1)
    assert load == 1.0
    corners = points[cells[0].data][:, :, :2]
    edges = corners[:, 1:] - corners[:, :1]
    areas = 0.5 * np.linalg.det(edges)
    assert areas.sum() == pytest.approx(W * H, rel=1e-9)
    assert (areas > 0).all()

    def integral(field):
        return float(areas @ fields[field][cells[0].data].mean(axis=1))

    last = result.rows[-1]
    assert integral("energy_density") == pytest.approx(last.energy, rel=0.05)
    assert integral("energy_density_shear") == pytest.approx(last.energies["shear"], rel=0.05)
    effects = sum(fields[f"energy_density_{effect}"] for effect in last.energies)
    np.testing.assert_allclose(fields["energy_density"], effects, rtol=1e-9)


def test_fields_hold_what_the_interface_names(result):
    fields = read_fields(result.directory).fields(-1)
    assert set(fields) == {
        "displacement",
        "shear_angle",
        "stretch_1",
        "stretch_2",
        "curvature_1",
        "curvature_2",
        "energy_density",
        "energy_density_stretch",
        "energy_density_bending",
        "energy_density_shear",
    }
    assert fields["shear_angle"].min() == result.rows[-1].shear_min
    assert fields["shear_angle"].max() == result.rows[-1].shear_max


def test_figures_show_every_stop(result):
    figures = result.directory / "figures"
    assert names(figures) == sorted(
        ["force_displacement.png"]
        + [
            f"{quantity}_{percent}.png"
            for quantity in ("shear_angle", "energy_density")
            for percent in ("030", "050", "100")
        ]
    )
    for path in figures.iterdir():
        with Image.open(path) as image:
            assert min(image.size) > 300
            assert len(image.getcolors(maxcolors=10**6)) > 20


@pytest.mark.parametrize(
    ("fields", "saved"), [("all", None), ("stops", [0.3, 0.5, 1.0]), ("none", [])]
)
def test_fields_are_saved_at_the_states_asked_for(tmp_path, fields, saved):
    case = small(
        continuation={"stops": [0.3, 0.5, 1.0], "max_step": 0.15},
        output={"fields": fields, "figures": False},
    )
    result = run(case, tmp_path, quiet=True)
    loads = [row.load for row in result.rows]
    assert len(loads) > 4
    assert "figures" not in names(tmp_path)
    if fields == "none":
        assert names(tmp_path) == [
            "case.resolved.toml",
            "checkpoint.npz",
            "history.csv",
            "summary.json",
        ]
    else:
        assert read_fields(tmp_path).loads.tolist() == (loads if saved is None else saved)


def test_a_path_that_ends_early_keeps_what_it_found(tmp_path):
    with pytest.raises(PathError) as caught:
        run(small(**TOO_HARD), tmp_path, quiet=True)
    history = read_history(tmp_path / "history.csv")
    reached = history["load"][-1]
    assert history["load"].tolist() == [0.0, 0.02]
    assert f"beyond load factor {reached:.6g}" in str(caught.value)
    assert "max_iterations" in str(caught.value)

    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["status"] == f"stopped: {caught.value}"
    assert summary["last"]["load"] == reached
    assert read_fields(tmp_path).loads.tolist() == history["load"].tolist()
    assert "force_displacement.png" in names(tmp_path / "figures")
    assert load_case(tmp_path / "case.resolved.toml").name == "small"


def test_a_path_that_fails_at_once_leaves_the_state_of_rest(tmp_path):
    case = small(
        grips={"top": {"translation": [0.0, 0.06]}},
        continuation={"initial_step": 1.0, "min_step": 1.0, "max_step": 1.0, "max_iterations": 2},
    )
    with pytest.raises(PathError, match="beyond load factor 0:"):
        run(case, tmp_path, quiet=True)
    assert read_history(tmp_path / "history.csv")["load"].tolist() == [0.0]
    assert read_fields(tmp_path).loads.tolist() == [0.0]
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["status"].startswith("stopped: ")
    assert summary["last"]["energy"] == 0.0


def test_steps_that_were_cut_back_are_told_and_not_recorded(tmp_path, capsys):
    case = small(
        grips={"top": {"translation": [0.0, 0.0567]}},
        continuation={"initial_step": 1.0, "max_step": 1.0, "max_iterations": 4},
        output={"figures": False, "fields": "none"},
    )
    result = run(case, tmp_path)
    lines = capsys.readouterr().out.splitlines()
    cut_back = [line for line in lines if line.startswith("cut back: load ")]
    assert cut_back
    assert all("within max_iterations" in line for line in cut_back)
    assert len(lines) == len(cut_back) + len(result.rows)
    assert result.rows[-1].load == 1.0
    # The path does not remember the failures: its end is that of a gentle one.
    gentle = run(
        small(
            grips={"top": {"translation": [0.0, 0.0567]}},
            output={"figures": False, "fields": "none"},
        ),
        tmp_path,
        quiet=True,
    )
    assert result.rows[-1].force == pytest.approx(gentle.rows[-1].force, rel=1e-8)
    assert result.rows[-1].energy == pytest.approx(gentle.rows[-1].energy, rel=1e-8)


def test_a_new_run_in_the_same_directory_replaces_the_old_one(tmp_path):
    first = small(continuation={"stops": [0.25, 1.0]}, output={"probes": PROBES})
    run(first, tmp_path, quiet=True)
    kept = tmp_path / "notes.txt"
    kept.write_text("mine")
    second = small(continuation={"stops": [0.75, 1.0]}, grips={"top": {"translation": [0.0, 0.01]}})
    result = run(second, tmp_path, quiet=True)
    history = read_history(tmp_path / "history.csv")
    assert "probe0_ux" not in history
    assert history["load"].tolist() == [row.load for row in result.rows]
    assert read_fields(tmp_path).loads.tolist() == [row.load for row in result.rows]
    assert load_case(tmp_path / "case.resolved.toml") == second
    assert "shear_angle_025.png" not in names(tmp_path / "figures")
    assert "shear_angle_075.png" in names(tmp_path / "figures")
    assert kept.read_text() == "mine"
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["last"] == result.rows[-1].columns()


@pytest.mark.parametrize(
    ("output", "left"),
    [
        (
            {"fields": "none"},
            [
                "case.resolved.toml",
                "checkpoint.npz",
                "figures",
                "history.csv",
                "report.html",
                "summary.json",
            ],
        ),
        (
            {"fields": "none", "figures": False},
            ["case.resolved.toml", "checkpoint.npz", "history.csv", "summary.json"],
        ),
    ],
)
def test_a_new_run_leaves_nothing_of_an_old_one(tmp_path, output, left):
    run(small(), tmp_path, quiet=True)
    run(small(output=output), tmp_path, quiet=True)
    assert names(tmp_path) == left
    if "figures" in left:
        assert names(tmp_path / "figures") == ["force_displacement.png"]


def test_any_title_can_be_drawn(tmp_path):
    run(small(title="$x_$ {0} %s \\ [bold]", output={"fields": "none"}), tmp_path, quiet=True)
    assert (tmp_path / "summary.json").is_file()


@pytest.mark.parametrize("stops", [[0.5, 0.5 + 1e-13, 1.0], [1 - 1e-13, 1.0]])
def test_stops_are_found_or_refused_however_close(tmp_path, stops):
    try:
        case = small(continuation={"stops": stops}, output={"figures": False, "fields": "none"})
    except CaseError:
        return
    loads = [row.load for row in run(case, tmp_path, quiet=True).rows]
    assert set(stops) <= set(loads)


def test_results_go_to_a_folder_with_the_name_of_the_case(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run(small(name="by-name.1", output={"figures": False, "fields": "none"}), quiet=True)
    assert result.directory.resolve() == tmp_path / "results" / "by-name.1"
    assert (result.directory / "summary.json").is_file()


@pytest.mark.skipif(SEVERAL, reason="each process would write the files")
def test_a_mesh_file_is_found_again_from_the_resolved_case(tmp_path):
    mesh = meshio.Mesh(
        W * np.array([[0, 0], [1, 0], [1, 3], [0, 3], [0.5, 1.5]]),
        [
            ("triangle", np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])),
            ("line", np.array([[0, 1], [2, 3]])),
        ],
        cell_sets={"bottom": [[], [0]], "top": [[], [1]]},
    )
    (tmp_path / "meshes").mkdir(exist_ok=True)
    meshio.write(tmp_path / "meshes" / "four.inp", mesh)
    (tmp_path / "cases").mkdir(exist_ok=True)
    text = (
        'name = "four"\n[sheet]\nwidth = 0.068\nheight = 0.204\n[material]\nstretch = 1e5\n'
        "bending = 1e-2\nshear = 1e2\n[grips.top]\ntranslation = [0.0, 0.01]\n"
        '[mesh]\nfile = "../meshes/four.inp"\n[discretisation]\ndegree = 2\n'
        '[output]\nfigures = false\nfields = "none"\n'
    )
    (tmp_path / "cases" / "four.toml").write_text(text)
    first = run(load_case(tmp_path / "cases" / "four.toml"), tmp_path / "out", quiet=True)
    resolved = tmp_path / "out" / "case.resolved.toml"
    assert "size" not in tomllib.loads(resolved.read_text())["mesh"]
    second = run(load_case(resolved), tmp_path / "elsewhere" / "again", quiet=True)
    assert first.rows[-1].force == pytest.approx(second.rows[-1].force, rel=1e-10)
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert summary["cells"] == 4


def test_a_probe_in_a_hole_of_an_imported_mesh_is_refused(tmp_path):
    ring = np.array([[0, 0], [3, 0], [3, 3], [0, 3], [1, 1], [2, 1], [2, 2], [1, 2]]) * 0.02
    quads = [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    mesh = meshio.Mesh(
        ring,
        [("triangle", np.array(triangles)), ("line", np.array([[0, 1], [2, 3]]))],
        cell_sets={"bottom": [[], [0]], "top": [[], [1]]},
    )
    meshio.write(tmp_path / "ring.inp", mesh)
    case = small(
        mesh={"file": str(tmp_path / "ring.inp"), "size": None, "corner_size": None},
        output={"probes": [[0.01, 0.01], [0.03, 0.03]]},
    )
    sentence = re.escape("output.probes[1]: [0.03, 0.03] is outside the sheet")
    with pytest.raises(CaseError, match=sentence):
        run(case, tmp_path / "out", quiet=True)
    assert not (tmp_path / "out").exists()
