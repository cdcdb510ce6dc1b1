"""The page report.html: what is on it, what it needs, and when it is written."""

import base64
import io
import json
import re
import shutil
import subprocess
from html.parser import HTMLParser

import numpy as np
import pytest
from PIL import Image

from pantograph_fem import recorder
from pantograph_fem.case import case_from_dict, case_to_toml
from pantograph_fem.errors import CaseError, PathError
from pantograph_fem.results.column_texts import column_texts
from pantograph_fem.results.history import HistoryRow, HistoryWriter, read_history
from pantograph_fem.results.report import MOST_ROWS, write_report
from pantograph_fem.results.summary import write_summary
from pantograph_fem.results.units import PREFIXES, column_unit
from pantograph_fem.running import run

from .conftest import COARSE, merged

CHAIN = {
    "name": "chain",
    "title": "Chain <script>alert('x')</script> & more",
    "kind": "chain",
    "beam": {"length": 1.0},
    "material": {"stretch": 4.05e8, "bending": 7.59e5},
    "chain": {"spacing": 0.125},
    "ends": {"right": {"support": "free", "moment": 2.0e6}},
    "continuation": {"max_step": 0.5},
}


class Page(HTMLParser):
    """The page taken apart."""

    def __init__(self, html):
        super().__init__()
        self.tags, self.tables, self.images = [], [], []
        self.text, self.title = "", ""
        self._open = []
        self.feed(html)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))
        if tag not in ("meta", "link", "img", "wbr"):
            self._open.append(tag)
        if tag == "table":
            self.tables.append([])
        elif tag == "tr":
            self.tables[-1].append([])
        elif tag in ("th", "td"):
            self.tables[-1][-1].append("")
        elif tag == "img":
            self.images.append(dict(attributes))
        self.text += " " * (tag == "dd")

    def handle_endtag(self, tag):
        assert self._open.pop() == tag

    def handle_data(self, data):
        if "style" in self._open:
            return
        if "title" in self._open:
            self.title += data
        self.text += data
        if {"th", "td"} & set(self._open):
            self.tables[-1][-1][-1] += ("|" if "span" in self._open else "") + data

    @property
    def steps(self):
        """Column heads (name, unit) and rows of the table of steps."""
        (head, *rows) = next(t for t in self.tables if t and t[0][0].startswith("step|"))
        return [tuple(cell.strip().split("|")) for cell in head], rows


def png(path, colour):
    path.parent.mkdir(exist_ok=True)
    Image.new("RGB", (8, 8), colour).save(path)


def results(directory, rows=3, case=CHAIN, **summary):
    """Files of a run, with numbers that are easy to recognise."""
    directory.mkdir(exist_ok=True)
    (directory / "case.resolved.toml").write_text(case_to_toml(case_from_dict(case)))
    made = []
    with HistoryWriter(directory / "history.csv", 0, 0, ("tip_ux",)) as writer:
        for i, load in enumerate(np.linspace(0, 1, rows)):
            energies = {"stretch": 1500.0 * load, "bending": 4500.0 * load}
            force, extra = (-2.5e6 * load, 1e-9 * load), {"tip_ux": -0.0125 * load}
            row = HistoryRow(
                i, load, force, 0.0, energies, 3, 2 * (load > 0.6), 0, load <= 0.6, 0, 0, (), extra
            )
            made.append(row)
            writer.write(row)
    usual = {
        "status": "done",
        "last": made[-1] if made else None,
        "dofs": {"displacement": 1234},
        "cells": 8,
        "seconds": {"solve": 0.25, "total": 1.5},
        "versions": {"python": "3.11.2"},
    }
    write_summary(directory / "summary.json", **(usual | summary))
    return directory


def page(directory):
    return Page(write_report(directory).read_text(encoding="utf-8"))


def test_a_title_is_shown_as_text(tmp_path):
    made = page(results(tmp_path / "r"))
    assert made.title == CHAIN["title"]
    assert CHAIN["title"] in made.text
    assert not [tag for tag, _ in made.tags if tag in ("script", "iframe", "object")]


def test_the_page_needs_nothing_but_itself(tmp_path):
    png(results(tmp_path / "r") / "figures" / "shapes.png", "red")
    html = write_report(tmp_path / "r").read_text()
    for _, attributes in Page(html).tags:
        for name in ("src", "href", "srcset", "data"):
            assert attributes.get(name, "data:").startswith("data:")
    assert "url(" not in html
    assert "@import" not in html


def test_figures_are_inside_the_page_curves_first_and_states_by_load(tmp_path):
    folder = results(tmp_path / "r") / "figures"
    names = {
        "shear_angle_100.png": "red",
        "shear_angle_025.22.png": "blue",
        "energy_density_100.png": "green",
        "force_displacement.png": "white",
        "mine.png": "black",
        "shear_angle_mine.png": "black",
    }
    for name, colour in names.items():
        png(folder / name, colour)
    images = page(tmp_path / "r").images
    assert [image["alt"] for image in images] == [
        "Force and displacement",
        "Shear angle at 25.22 % of the load",
        "Shear angle at 100 % of the load",
        "Energy density at 100 % of the load",
    ]
    for image, colour in zip(images, ["white", "blue", "red", "green"], strict=True):
        kind, _, data = image["src"].partition(",")
        assert kind == "data:image/png;base64"
        shown = Image.open(io.BytesIO(base64.b64decode(data)))
        assert shown.getpixel((0, 0)) == Image.new("RGB", (1, 1), colour).getpixel((0, 0))


def test_numbers_of_the_last_state_have_units(tmp_path):
    text = " ".join(page(results(tmp_path / "r")).text.split())
    for sentence in (
        "Force x of the right end -2.5 MN",
        "Force y of the right end 0 N",  # rounding, beside the other
        "Energy 6 kJ",
        "Energy of bending 4.5 kJ 75.0%",
        "Displacement x of the right end -12.5 mm",
        "Stable no +2 negative pivots",
    ):
        assert sentence in text
    assert "Energy of shear" not in text  # a chain has none
    assert "shear angle" not in text


def test_the_table_holds_the_history(tmp_path):
    history = read_history(results(tmp_path / "r", rows=11) / "history.csv")
    heads, rows = page(tmp_path / "r").steps
    assert [name for name, _ in heads] == list(history)
    assert len(rows) == 11
    factors = {prefix: factor for factor, prefix in PREFIXES.items()}
    for (name, unit), texts in zip(heads, zip(*rows, strict=True), strict=True):
        if name == "stable":
            assert [text == "yes" for text in texts] == history[name].tolist()
            continue
        si = column_unit(name)
        assert unit.strip().endswith(si)
        factor = factors[unit.strip().removesuffix(si)] if si else 1.0
        scale = np.abs(history["force_x" if si == "N" else name]).max()
        shown = factor * np.array(texts, float)
        np.testing.assert_allclose(shown, history[name], atol=1e-5 * scale, rtol=0)


def test_values_have_the_digits_that_can_be_read_and_no_signed_zeros():
    history = {
        "load": np.array([0.0, 0.25, 1.0]),
        "force_x": np.array([0.0, -1e-9, 1234.5678]),
        "eigenvalue": np.array([np.nan, 1.5e-7, -2e-7]),
        "shear_max": np.array([0.0, 0.5, 1.2345678]),
    }
    units = {name: column_unit(name) for name in history}
    columns = {column.name: column for column in column_texts(history, units)}
    assert columns["load"].texts == ("0.00", "0.25", "1.00")
    assert columns["force_x"].unit == "kN"
    assert columns["force_x"].texts == ("0.00000", "0.00000", "1.23457")
    assert columns["eigenvalue"].texts[0] == "–"
    power = columns["eigenvalue"].unit.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
    exponent = int(power.removeprefix("10"))
    assert float(columns["eigenvalue"].texts[2]) * 10.0**exponent == pytest.approx(-2e-7)
    assert columns["shear_max"].unit == "rad"


def test_a_long_history_is_thinned_but_keeps_critical_and_last_states(tmp_path):
    load = float(np.linspace(0, 1, 901)[452])
    point = {"step": 452, "load": load, "kind": "limit point"}
    results(tmp_path / "r", rows=901, critical_points=[point])
    made = page(tmp_path / "r")
    _, rows = made.steps
    assert len(rows) <= MOST_ROWS + 2
    assert {"452", "900"} <= {row[0] for row in rows}
    assert f"{len(rows)} of 901 states" in made.text


@pytest.mark.parametrize(
    ("summary", "sentences"),
    [
        ({}, ["Done: the path was followed to load factor 1.", "1 of 3 states are unstable"]),
        (
            {
                "status": "stopped at a critical load",
                "critical_points": [{"step": 2, "load": 1.0, "kind": "bifurcation"}],
            },
            ["Stopped at a critical load, as asked for: load factor 1, a bifurcation."],
        ),
        ({"status": "stopped: No equilibrium <beyond> it."}, ["No equilibrium <beyond> it."]),
        ({"cutbacks": 1}, ["A step was rejected"]),
        ({"message": "Warning: mesh.accuracy is NOT reached."}, ["accuracy is NOT reached."]),
    ],
)
def test_the_outcome_and_warnings_are_sentences(tmp_path, summary, sentences):
    text = page(results(tmp_path / "r", **summary)).text
    for sentence in sentences:
        assert sentence in text


def test_what_is_known_of_a_failure_is_shown(tmp_path):
    results(tmp_path / "r", status="stopped: It ends.")
    known = {
        "message": "It ends.",
        "last_load": 0.5,
        "worst_at": "displacement at (0, 1) m",
        "condition": None,
        "residuals": [1.0, 1e-3],
    }
    (tmp_path / "r" / "failure.json").write_text(json.dumps(known))
    (table,) = (t for t in page(tmp_path / "r").tables if t[0][0] == "Last load")
    assert table == [
        ["Last load", "0.5"],
        ["Worst at", "displacement at (0, 1) m"],
        ["Residuals", "1, 0.001"],
    ]


def test_accuracy_of_an_adapted_mesh_is_a_table(tmp_path):
    meshes = [
        {"cells": 10, "dofs": 99, "estimated_error_force": None, "estimated_error_energy": None},
        {"cells": 40, "dofs": 999, "estimated_error_force": 2e-3, "estimated_error_energy": 1e-3},
    ]
    made = page(results(tmp_path / "r", accuracy={"meshes": meshes}, message="It is reached."))
    (table,) = (t for t in made.tables if t[0][:2] == ["mesh", "cells"])
    assert table[1:] == [
        ["1", "10", "99", "unknown", "unknown"],
        ["2", "40", "999", "2.0e-03", "1.0e-03"],
    ]


@pytest.mark.parametrize("rows", [0, 3])
def test_an_interrupted_run_has_a_page_that_says_so(tmp_path, rows):
    (results(tmp_path / "r", rows=rows) / "summary.json").unlink()
    made = page(tmp_path / "r")
    assert "Not finished" in made.text
    assert len(made.steps[1]) == rows


def test_damaged_results_are_refused(tmp_path):
    (results(tmp_path / "r") / "summary.json").write_text("[1")
    with pytest.raises(CaseError, match=r"summary\.json is damaged"):
        write_report(tmp_path / "r")


@pytest.mark.parametrize(
    ("output", "written"),
    [
        ({}, True),
        ({"figures": False}, False),
        ({"figures": False, "report": True}, True),
        ({"report": False}, False),
    ],
)
def test_a_run_ends_with_a_report_where_figures_or_it_are_asked_for(tmp_path, output, written):
    case = case_from_dict(CHAIN | {"output": output})
    tmp_path.joinpath("report.html").write_text("of an earlier run")
    run(case, tmp_path, quiet=True)
    path = tmp_path / "report.html"
    assert path.is_file() == written
    if written:
        made = Page(path.read_text())
        assert len(made.images) == len(list(tmp_path.glob("figures/*.png")))
        assert bool(made.images) == case.output.figures
        # the settings are there as they are in the file
        assert (tmp_path / "case.resolved.toml").read_text().strip() in made.text
        summary = json.loads((tmp_path / "summary.json").read_text())
        assert f"{summary['seconds']['total']:.2f}" in made.text


def test_a_run_that_stops_has_a_report_that_says_why(tmp_path, coarse_case):
    hard = {"initial_step": 1.0, "min_step": 1.0, "max_step": 1.0, "max_iterations": 2}
    case = coarse_case(continuation=hard, output={"figures": False, "report": True})
    with pytest.raises(PathError) as caught:
        run(case, tmp_path, quiet=True)
    text = page(tmp_path).text
    assert str(caught.value) in text
    assert "Why the path ends" in text


def test_a_report_that_fails_loses_no_run(tmp_path, monkeypatch, capsys):
    def fail(directory):
        raise OSError("the disk is full")

    monkeypatch.setattr(recorder, "write_report", fail)
    run(case_from_dict(CHAIN), tmp_path)
    assert json.loads((tmp_path / "summary.json").read_text())["status"] == "done"
    assert "report.html could not be written: the disk is full" in capsys.readouterr().out


#: Appended to a copy of the page: what the browser has made of it.
PROBE = """<script>addEventListener("load", () => {
  const images = [...document.images], root = document.documentElement;
  document.body.dataset.widths = images.map(image => image.naturalWidth).join();
  document.body.dataset.loaded = performance.getEntriesByType("resource")
    .filter(entry => !entry.name.startsWith("data:")).length;
  document.body.dataset.overflow = root.scrollWidth - root.clientWidth;
});</script></body>"""


@pytest.fixture
def chromium(tmp_path):
    program = shutil.which("chromium")
    if program is None:
        pytest.skip("chromium is not on PATH: apt-get install chromium")

    def call(*arguments):
        flags = "--headless --no-sandbox --disable-gpu --disable-quic --no-first-run"
        flags += " --disable-background-networking --disable-component-update --disable-sync"
        done = subprocess.run(
            [
                program,
                *flags.split(),
                "--enable-logging=stderr",
                f"--user-data-dir={tmp_path / 'profile'}",
                *map(str, arguments),
            ],
            capture_output=True,
            text=True,
            timeout=120,
        )
        assert done.returncode == 0, done.stderr
        assert not re.findall(r".*CONSOLE.*", done.stderr)
        return done.stdout

    return call


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["chain", "sheet"])
def test_a_browser_shows_it(tmp_path, chromium, kind):
    sheet = merged(COARSE, {"kind": "sheet", "discretisation": {"degree": 2}})
    directory = tmp_path / "results"
    run(case_from_dict(CHAIN if kind == "chain" else sheet), directory, quiet=True)
    report = directory / "report.html"
    probed = tmp_path / "probed.html"
    probed.write_text(report.read_text().replace("</body>", PROBE))
    # as wide as a phone: tables scroll, the page does not
    dom = Page(chromium("--dump-dom", "--window-size=500,800", probed.as_uri()))
    (body,) = (attributes for tag, attributes in dom.tags if tag == "body")
    sizes = [Image.open(path).width for path in directory.glob("figures/*.png")]
    assert sizes
    assert sorted(map(int, body["data-widths"].split(","))) == sorted(sizes)
    assert int(body["data-overflow"]) <= 0
    assert int(body["data-loaded"]) == 0
    last = read_history(directory / "history.csv")
    assert f"step {last['step'][-1]}" in dom.text

    chromium("--screenshot=" + str(tmp_path / "s.png"), "--window-size=1100,1600", report.as_uri())
    shown = np.asarray(Image.open(tmp_path / "s.png").convert("RGB"), int)
    coloured = np.ptp(shown, axis=2) > 60  # figures, and nothing else, are as colourful
    assert coloured.sum() > 1000
    assert (shown.min(axis=2) > 240).mean() > 0.5
