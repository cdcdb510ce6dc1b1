"""Comparisons of made-up results whose differences and orders are known, and of real ones."""

import csv
import io
import json
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
import tomli_w
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image
from rich.console import Console

from pantograph_fem.case import case_to_toml
from pantograph_fem.compare import compare, write
from pantograph_fem.compare.curves_figure import legend_text
from pantograph_fem.compare.drive import LOAD, Drive, common_drive, drive_of
from pantograph_fem.compare.table import print_table, relative_text
from pantograph_fem.errors import CaseError, PathError

from .conftest import COARSE, merged

COLUMNS = [
    *("step", "load", "force_x", "force_y", "moment"),
    *("energy", "energy_stretch", "energy_bending", "energy_shear"),
    *("newton_iterations", "negative_pivots", "expected_negative_pivots", "stable"),
    *("shear_min", "shear_max", "probe0_ux", "probe0_uy"),
]
PROBES = {"output": {"probes": [[0.034, 0.102]]}}


def force(load, h):
    """Magnitude of a force that tends to 5 N with the square of the size h."""
    return 5.0 * load + 0.1 * load * h**2


class MadeUp:
    """A runner that makes up results; the fibre angle of the case stands for h."""

    def __init__(self):
        self.runs = []
        self.last = {}
        self.columns = COLUMNS

    def __call__(self):
        return self.run

    def run(self, case, directory):
        self.runs.append(directory.name)
        end = self.last.get(directory.name, 1.0)
        load = np.unique([0.0, *(stop for stop in case.continuation.stops if stop <= end), end])
        table = {name: np.zeros_like(load) for name in self.columns}
        h = case.sheet.fibre_angle
        table["load"] = load
        # the direction of the force does not matter
        table["force_x"], table["force_y"] = -0.6 * force(load, h), 0.8 * force(load, h)
        table["energy_stretch"], table["energy_shear"] = load**2 * (2 + h), load**2 * (1 - h)
        table["energy"] = table["energy_stretch"] + table["energy_shear"]
        table["probe0_ux"] = 1e-14 * load * h
        table["probe0_uy"] = 0.03 * load * (1 + h**3)
        table["stable"] = np.ones_like(load)
        directory.mkdir(parents=True, exist_ok=True)
        lines = [",".join(map(repr, map(float, row))) for row in zip(*table.values(), strict=True)]
        (directory / "history.csv").write_text("\n".join([",".join(table), *lines]) + "\n")
        (directory / "case.resolved.toml").write_text(case_to_toml(case))
        status = "done" if end == 1.0 else f"stopped: nothing beyond {end}; try a smaller step"
        (directory / "summary.json").write_text(json.dumps({"status": status}))
        if end < 1.0:
            raise PathError(status.removeprefix("stopped: "))


@pytest.fixture
def made_up():
    return MadeUp()


def write_study(folder, sizes=(4.0, 2.0, 1.0), reference=None, case=None, **keys):
    """A study of the coarse case with several fibre angles, which are also its parameters."""
    base = merged(COARSE, merged(PROBES, {"continuation": {"stops": [0.25, 0.5]}}))
    (folder / "case.toml").write_text(tomli_w.dumps(merged(base, case or {})))
    runs = [
        {"case": "case.toml", "label": f"h{h:g}", "set": [f"sheet.fibre_angle={h}"], "parameter": h}
        for h in sizes
    ]
    if reference is not None:
        last = {"case": "case.toml", "label": "exact", "set": [f"sheet.fibre_angle={reference}"]}
        runs.append(last | {"reference": True})
    path = folder / "study.toml"
    path.write_text(tomli_w.dumps({**keys, "runs": runs}))
    return path


def compared(folder, made_up, **keys):
    path = write_study(folder, **keys)
    return compare([path], folder / "out", runner=made_up)


def rows(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def shown(comparison, width=300):
    console = Console(width=width, record=True, file=io.StringIO(), force_terminal=True)
    print_table(comparison, console)
    return console.export_text()


def test_differences_and_orders_against_a_reference(tmp_path, made_up):
    comparison = compared(tmp_path, made_up, reference=1e-9).comparison
    # zero up to rounding everywhere: energy_bending, probe0_ux
    assert comparison.quantities == (
        *("force", "energy", "energy_stretch", "energy_shear", "probe0_uy"),
    )
    assert comparison.load == 1.0
    for i, h in enumerate((4.0, 2.0, 1.0)):
        found = comparison.numbers[i, "force"]
        assert found.value == pytest.approx(5 + 0.1 * h**2)
        assert found.reference == pytest.approx(5.0)
        assert found.difference == pytest.approx(0.1 * h**2)
        assert found.relative_difference == pytest.approx(0.02 * h**2)
    for quantity, order in (("force", 2.0), ("energy_stretch", 1.0), ("probe0_uy", 3.0)):
        orders = [comparison.numbers[i, quantity].order for i in range(4)]
        assert orders == pytest.approx([np.nan, order, order, np.nan], rel=1e-6, nan_ok=True)
        assert comparison.limits[quantity].order == pytest.approx(order, rel=1e-6)
        assert comparison.limits[quantity].relative_difference == pytest.approx(0, abs=1e-8)
    # the parts differ, their sum does not: no difference, no order, no limit
    assert [comparison.numbers[i, "energy"].difference for i in range(3)] == [0.0, 0.0, 0.0]
    assert np.isnan([comparison.numbers[i, "energy"].order for i in range(3)]).all()
    assert "energy" not in comparison.limits


def test_without_a_reference_three_runs_give_the_order(tmp_path, made_up):
    comparison = compared(tmp_path, made_up, sizes=(1.0, 4.0, 2.0)).comparison
    # the runs need not be in order
    orders = [comparison.numbers[i, "force"].order for i in range(3)]
    assert orders == pytest.approx([2.0, np.nan, np.nan], nan_ok=True)
    assert np.isnan(comparison.numbers[0, "force"].difference)
    assert comparison.limits["force"].limit == pytest.approx(5.0)
    assert np.isnan(comparison.limits["force"].difference)


def test_an_inexact_reference_is_told_by_the_limit(tmp_path, made_up):
    comparison = compared(tmp_path, made_up, reference=0.9).comparison
    # measured against it the finest run seems to converge too fast
    assert comparison.numbers[2, "force"].order > 3
    limit = comparison.limits["force"]
    assert limit.order == pytest.approx(2.0)
    assert limit.difference == pytest.approx(-0.1 * 0.9**2)


def test_the_load_and_the_quantities_can_be_chosen(tmp_path, made_up):
    keys = {"load": 0.5, "quantities": ["force_x", "force"], "reference": 1e-9}
    comparison = compared(tmp_path, made_up, **keys).comparison
    assert comparison.quantities == ("force_x", "force")
    assert comparison.numbers[1, "force_x"].value == pytest.approx(-0.6 * force(0.5, 2.0))
    assert comparison.numbers[1, "force"].value == pytest.approx(force(0.5, 2.0))


def test_a_quantity_that_no_run_has_is_refused(tmp_path, made_up):
    with pytest.raises(CaseError) as caught:
        compared(tmp_path, made_up, quantities=["force", "energi"])
    assert 'quantities: "energi" is not allowed; it must be one of force, step' in str(caught.value)


def test_probes_at_other_points_are_not_compared(tmp_path, made_up):
    path = write_study(tmp_path)
    other = merged(COARSE, {"name": "moved", "output": {"probes": [[0.0, 0.1]]}})
    (tmp_path / "other.toml").write_text(tomli_w.dumps(other))
    result = compare([path, tmp_path / "other.toml"], tmp_path / "out", runner=made_up)
    assert "probe0_uy" not in result.comparison.quantities


def test_finished_results_are_not_run_again_and_changed_ones_are(tmp_path, made_up):
    compared(tmp_path, made_up)
    assert made_up.runs == ["h4", "h2", "h1"]
    history = tmp_path / "out" / "h4" / "history.csv"
    before = history.stat().st_mtime_ns
    compared(tmp_path, made_up)
    assert len(made_up.runs) == 3
    assert history.stat().st_mtime_ns == before

    compared(tmp_path, made_up, sizes=(4.0, 2.0, 1.0, 0.5))
    assert made_up.runs[3:] == ["h0.5"]
    compared(tmp_path, made_up, case={"material": {"shear": 160.0}})
    assert made_up.runs[4:] == ["h4", "h2", "h1"]
    (tmp_path / "out" / "h2" / "summary.json").unlink()
    compared(tmp_path, made_up, case={"material": {"shear": 160.0}})
    assert made_up.runs[7:] == ["h2"]
    compare([tmp_path / "study.toml"], tmp_path / "out", runner=made_up, rerun=True)
    assert made_up.runs[8:] == ["h4", "h2", "h1"]
    compare(
        *([tmp_path / "study.toml"], tmp_path / "out"),
        runner=made_up,
        overrides=["material.shear=161.0"],
    )
    assert len(made_up.runs) == 14


def test_a_run_that_stops_is_kept_and_shown(tmp_path, made_up):
    made_up.last = {"h2": 0.3}
    result = compared(tmp_path, made_up, sizes=(4.0, 2.0, 1.0), reference=1e-9)
    assert made_up.runs == ["h4", "h2", "h1", "exact"]
    assert result.stopped == ("h2",)
    comparison = result.comparison
    assert comparison.load == 1.0
    found = comparison.numbers[1, "force"]
    assert (found.load, found.value) == (0.3, pytest.approx(force(0.3, 2.0)))
    assert np.isnan([found.difference, found.order]).all()
    # the others are measured past it
    assert comparison.numbers[2, "force"].order == pytest.approx(2.0)
    assert "stopped at 0.3" in shown(comparison)
    write(comparison, result.directory)
    message = str(result.stopped_error())
    assert "h2: nothing beyond 0.3; try a smaller step" in message
    assert result.stopped_error().exit_code == 3
    # it is tried again
    made_up.last = {}
    assert compared(tmp_path, made_up, reference=1e-9).stopped == ()
    assert made_up.runs[4:] == ["h2"]


def test_a_stopped_run_that_has_the_load_takes_part(tmp_path, made_up):
    made_up.last = {"h2": 0.5}
    comparison = compared(tmp_path, made_up, reference=1e-9, load=0.25).comparison
    assert comparison.numbers[1, "force"].order == pytest.approx(2.0)


def test_a_stopped_reference_sets_the_load(tmp_path, made_up):
    made_up.last = {"exact": 0.6}
    comparison = compared(tmp_path, made_up, reference=1e-9).comparison
    assert comparison.load == 0.5
    assert comparison.numbers[2, "force"].difference == pytest.approx(0.05)


def test_runs_without_a_common_load_are_shown_at_their_ends(tmp_path, made_up):
    made_up.last = {"h4": 0.1, "h2": 0.2}
    result = compared(tmp_path, made_up, sizes=(4.0, 2.0))
    assert np.isnan(result.comparison.load)
    loads = [result.comparison.numbers[i, "force"].load for i in range(2)]
    assert loads == [0.1, 0.2]
    write(result.comparison, result.directory)
    assert "stopped at 0.1" in shown(result.comparison)


def test_an_error_that_shows_only_in_the_run_names_it(tmp_path):
    def wrong(case, directory):
        raise CaseError("the mesh has no group bottom")

    with pytest.raises(CaseError, match="h4: the mesh has no group bottom"):
        compared(tmp_path, lambda: wrong)


def test_folders_are_read_without_running_anything(tmp_path, made_up):
    compared(tmp_path, made_up)

    def none():
        raise AssertionError

    folders = [tmp_path / "out" / name for name in ("h1", "h4")]
    comparison = compare(folders, tmp_path / "two", runner=none).comparison
    assert comparison.numbers[1, "force"].difference == pytest.approx(1.5)
    assert comparison.numbers[1, "force"].reference == pytest.approx(5.1)


@pytest.mark.parametrize("name", ["case.resolved.toml", "history.csv", "summary.json"])
def test_folders_without_results_are_refused_before_anything_is_run(tmp_path, made_up, name):
    path = write_study(tmp_path)
    compare([path], tmp_path / "out", runner=made_up)
    (tmp_path / "out" / "h1" / name).unlink()
    with pytest.raises(CaseError, match=rf"h1 holds no results to compare: {name} is missing"):
        compare([path, tmp_path / "out" / "h1"], tmp_path / "new", runner=made_up)
    assert len(made_up.runs) == 3


def test_a_damaged_summary_is_refused(tmp_path, made_up):
    compared(tmp_path, made_up)
    (tmp_path / "out" / "h1" / "summary.json").write_text("{}")
    with pytest.raises(CaseError, match="it must give the status"):
        compare([tmp_path / "out" / "h1"], tmp_path / "new")


def test_tables_hold_all_numbers(tmp_path, made_up):
    made_up.last = {"h4": 0.3}
    result = compared(tmp_path, made_up, reference=1e-9)
    write(result.comparison, result.directory)
    table = rows(tmp_path / "out" / "comparison.csv")
    assert ",".join(table[0]) == (
        "run,label,parameter,load,quantity,value,reference,difference,relative_difference,order"
    )
    assert len(table) == 4 * 5
    by_key = {(row["label"], row["quantity"]): row for row in table}
    stopped, finest = by_key["h4", "force"], by_key["h1", "force"]
    assert [stopped[name] for name in ("run", "parameter", "load")] == ["1", "4.0", "0.3"]
    assert stopped["difference"] == stopped["order"] == ""
    assert float(finest["value"]) == force(1.0, 1.0)
    assert float(finest["order"]) == pytest.approx(2.0)
    assert by_key["exact", "force"]["parameter"] == ""

    curves = rows(tmp_path / "out" / "curves.csv")
    assert len(curves) == 3 + 3 * 4
    assert float(curves[-1]["displacement"]) == 0.03
    assert float(curves[2]["force"]) == pytest.approx(force(0.3, 4.0))


def test_what_no_longer_belongs_is_removed(tmp_path, made_up):
    result = compared(tmp_path, made_up, reference=1e-9)
    written = {path.name for path in write(result.comparison, result.directory)}
    assert written == {
        *("comparison.csv", "limits.csv", "curves.csv", "curves.png", "convergence.png"),
    }
    result = compared(tmp_path, made_up, sizes=(4.0, 2.0))
    written = {path.name for path in write(result.comparison, result.directory)}
    assert written == {"comparison.csv", "curves.csv", "curves.png"}
    assert not (tmp_path / "out" / "limits.csv").exists()
    assert not (tmp_path / "out" / "convergence.png").exists()


def test_figures_take_any_label(tmp_path, made_up):
    path = write_study(
        tmp_path,
        *((4.0, 2.0), 1e-9),
        title="$x_$ [bold] " * 12,
        parameter="h_$ [m",
        expected_order=2.0,
        marks=[{"x": 0.01, "label": "$_"}],
    )
    text = path.read_text().replace('"h4"', '"$K_{ [red] "').replace('"exact"', '"_ex$act"')
    path.write_text(text)
    result = compare([path], tmp_path / "out", runner=made_up)
    for picture in write(result.comparison, result.directory)[-2:]:
        with Image.open(picture) as image:
            assert min(image.size) > 500
            assert len(image.getcolors(maxcolors=10**6)) > 20
    assert "$K_{ [red]" in shown(result.comparison)


def test_a_legend_shows_labels_as_they_are():
    axes = Figure().subplots()
    for label in ("plain", "_hidden", "$x_"):
        axes.plot([0, 1], label=legend_text(label))
    texts = axes.legend().get_texts()
    assert [text.get_text() for text in texts] == ["plain", " _hidden", r"\$x_"]
    FigureCanvasAgg(axes.figure).draw()  # broken mathematics would show now


def test_the_table_shows_values_differences_and_orders(tmp_path, made_up):
    keys = {"title": "Finer and finer", "parameter": "size (m)", "expected_order": 2.0}
    result = compared(tmp_path, made_up, reference=1e-9, **keys)
    text = shown(result.comparison)
    assert "Finer and finer, at load factor 1, differences to exact, expected order p = 2" in text
    for part in ("size (m)", "force", "(N)", "(J)", "5.1", "+2 %", "p = 2.00", "extrapolated"):
        assert part in text
    # narrow: the quantities go to several tables, and nothing is cut
    narrow = shown(result.comparison, width=60)
    assert narrow.count("size (m)") > text.count("size (m)")
    assert "…" not in narrow
    for quantity in result.comparison.quantities:
        assert narrow.count(quantity) >= 1


@pytest.mark.parametrize(
    ("relative", "text"),
    [(0.0123, "+1.23 %"), (-2.5, "-250 %"), (1.23e-5, "+1.2e-05"), (0.0, "0"), (-1e3, "-1.0e+03")],
)
def test_relative_differences_are_readable(relative, text):
    assert relative_text(relative) == text


def test_drives_of_grips_and_ends():
    def grips(bottom, top):
        bottom, top = SimpleNamespace(translation=bottom), SimpleNamespace(translation=top)
        return SimpleNamespace(grips=SimpleNamespace(bottom=bottom, top=top))

    def end(translation):
        return SimpleNamespace(ends=SimpleNamespace(right=SimpleNamespace(translation=translation)))

    assert drive_of(grips((0.01, 0.0), (0.04, 0.04))) == Drive("grip displacement", 0.05)
    assert drive_of(grips((0.01, 0.0), (0.01, 0.0))) == LOAD
    assert drive_of(end((0.3, -0.4))) == Drive("end displacement", 0.5)
    assert drive_of(end((0.0, 0.0))) == LOAD
    assert drive_of(SimpleNamespace()) == LOAD
    assert common_drive([Drive("grip displacement", 1.0), Drive("grip displacement", 2.0)]) == (
        "grip displacement"
    )
    assert common_drive([Drive("grip displacement", 1.0), Drive("end displacement", 1.0)]) == (
        "load factor"
    )


def pantograph(*arguments, cwd):
    return subprocess.run(
        [sys.executable, "-m", "pantograph_fem", "compare", *map(str, arguments)],
        cwd=cwd,
        capture_output=True,
        text=True,
        timeout=300,
    )


def test_the_command_refuses_what_is_wrong(tmp_path):
    path = write_study(tmp_path, case={"mesh": {"size": -1.0}})
    done = pantograph(path, cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert "mesh.size: -1.0 is not allowed; it must be greater than 0" in done.stderr
    assert "Traceback" not in done.stderr
    assert pantograph(cwd=tmp_path).returncode == 2
    assert not (tmp_path / "results").exists()


def test_the_command_reads_folders_without_dolfinx(tmp_path, made_up):
    compared(tmp_path, made_up)
    done = subprocess.run(
        [
            *(sys.executable, "-X", "importtime", "-m", "pantograph_fem", "compare"),
            *("out/h1", "out/h2", "--output", "here", "--quiet"),
        ],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    assert "differences to h1" in done.stdout
    imported = {line.split("|")[-1].strip() for line in done.stderr.splitlines()}
    assert not imported & {"dolfinx", "petsc4py", "mpi4py", "gmsh"}
    assert (tmp_path / "here" / "curves.png").is_file()


@pytest.mark.slow
def test_two_sheets_of_which_one_is_stopped(tmp_path):
    """The force of a sheet grows with the stiffness of its fibres."""
    small = {"discretisation": {"degree": 2}, "output": {"fields": "none", "figures": False}}
    steps = dict.fromkeys(("initial_step", "min_step", "max_step"), 1.0)
    hard = {"continuation": {"max_iterations": 2, **steps}}
    (tmp_path / "soft.toml").write_text(tomli_w.dumps(merged(COARSE, small | {"name": "soft"})))
    stiff = merged(COARSE, small | {"name": "stiff", "material": {"stretch": 1.34e6}})
    (tmp_path / "stiff.toml").write_text(tomli_w.dumps(stiff))
    (tmp_path / "hard.toml").write_text(
        tomli_w.dumps(merged(COARSE, merged(small | {"name": "hard"}, hard)))
    )
    arguments = ("soft.toml", "hard.toml", "stiff.toml", "--output", "out")
    done = pantograph(*arguments, cwd=tmp_path)
    assert done.returncode == 3, done.stderr
    assert "hard: " in done.stderr
    assert "continuation.max_iterations" in done.stderr
    assert "Traceback" not in done.stderr
    by_key = {(r["label"], r["quantity"]): r for r in rows(tmp_path / "out" / "comparison.csv")}
    difference = float(by_key["stiff", "force"]["relative_difference"])
    assert 0.01 < difference < 1.0
    assert float(by_key["hard", "force"]["load"]) == 0.0
    before = (tmp_path / "out" / "stiff" / "history.csv").stat().st_mtime_ns
    again = pantograph("soft.toml", "stiff.toml", "--output", "out", cwd=tmp_path)
    assert again.returncode == 0, again.stderr
    assert "Running" not in again.stdout
    assert (tmp_path / "out" / "stiff" / "history.csv").stat().st_mtime_ns == before
