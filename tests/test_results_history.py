"""The table of accepted steps, the summary and what is shown during a run."""

from __future__ import annotations

import io
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pantograph_fem.errors import CaseError
from pantograph_fem.results.history import HistoryRow, HistoryWriter, read_history
from pantograph_fem.results.progress import Progress
from pantograph_fem.results.summary import package_versions, write_summary

HEADER = (
    "step,load,force_x,force_y,moment,energy,energy_stretch,energy_bending,energy_shear,"
    "newton_iterations,negative_pivots,expected_negative_pivots,stable,shear_min,shear_max"
)
ROW = HistoryRow(
    step=4,
    load=0.1 + 0.2,
    force=(-1 / 3, 11.276),
    moment=1e-17,
    energies={"stretch": 0.1, "shear": 0.0402},
    newton_iterations=4,
    negative_pivots=13,
    expected_negative_pivots=12,
    stable=False,
    shear_min=-0.1,
    shear_max=np.float64(0.7),
    probes=((0.01, -0.02), (np.float64(1 / 7), 0.0)),
)


def test_table_has_the_agreed_columns(tmp_path: Path) -> None:
    with HistoryWriter(tmp_path / "history.csv", probes=0):
        pass
    assert (tmp_path / "history.csv").read_text() == HEADER + "\n"
    with HistoryWriter(tmp_path / "history.csv", probes=2):
        pass
    probes = ",probe0_ux,probe0_uy,probe1_ux,probe1_uy"
    assert (tmp_path / "history.csv").read_text() == HEADER + probes + "\n"


def test_rows_read_back_exactly_and_at_once(tmp_path: Path) -> None:
    path = tmp_path / "history.csv"
    with HistoryWriter(path, probes=2) as writer:
        writer.write(ROW)
        writer.write(replace(ROW, step=5, stable=True, moment=2.5))
        history = read_history(path)  # before the file is closed
    assert history["load"].tolist() == [ROW.load, ROW.load]
    assert history["force_x"][0] == ROW.force[0]
    assert history["moment"].tolist() == [1e-17, 2.5]
    assert history["probe1_ux"][0] == 1 / 7
    assert history["stable"].tolist() == [False, True]
    assert history["step"].tolist() == [4, 5]
    assert history["negative_pivots"].dtype.kind == "i"


def test_columns_of_a_kind_stand_before_the_probes(tmp_path: Path) -> None:
    path, extra = tmp_path / "history.csv", ("energy_foundation", "tip_ux", "tip_angle")
    row = replace(
        ROW,
        energies={"foundation": 2.0, "stretch": 0.5},
        extra={"tip_ux": -0.25, "tip_angle": np.float64(1 / 3)},
    )
    with HistoryWriter(path, probes=2, extra_columns=extra) as writer:
        writer.write(row)
        with pytest.raises(ValueError, match=r"other columns.*energy_foundation"):
            writer.write(ROW)
    probes = "probe0_ux,probe0_uy,probe1_ux,probe1_uy"
    expected = f"{HEADER},energy_foundation,tip_ux,tip_angle,{probes}"
    assert path.read_text().splitlines()[0] == expected
    history = read_history(path)
    assert history["energy"].tolist() == [2.5]
    assert history["energy_foundation"].tolist() == [2.0]
    assert history["tip_angle"].tolist() == [1 / 3]
    assert history["probe1_ux"].tolist() == [1 / 7]
    with HistoryWriter(path, probes=2, kept=1, extra_columns=extra) as writer:
        writer.write(row)
    assert len(read_history(path)["load"]) == 2
    with pytest.raises(CaseError, match="other columns"):
        HistoryWriter(path, probes=2, kept=1, extra_columns=extra[1:])


def test_absent_effect_has_no_energy(tmp_path: Path) -> None:
    with HistoryWriter(tmp_path / "history.csv", probes=2) as writer:
        writer.write(ROW)
    history = read_history(tmp_path / "history.csv")
    assert history["energy_bending"].tolist() == [0.0]
    np.testing.assert_allclose(history["energy"], 0.1402)


def test_numpy_reads_the_table_as_numbers(tmp_path: Path) -> None:
    with HistoryWriter(tmp_path / "history.csv", probes=2) as writer:
        writer.write(ROW)
    table = np.genfromtxt(tmp_path / "history.csv", delimiter=",", names=True)
    assert table["stable"] == 0
    assert table["expected_negative_pivots"] == 12


def test_line_cut_short_by_a_kill_is_left_out(tmp_path: Path) -> None:
    path = tmp_path / "history.csv"
    with HistoryWriter(path, probes=2) as writer:
        writer.write(ROW)
    with path.open("a") as file:
        file.write("5,0.4,1.")
    assert read_history(path)["step"].tolist() == [4]


def test_continued_table_drops_later_rows(tmp_path: Path) -> None:
    path = tmp_path / "history.csv"
    with HistoryWriter(path, probes=2) as writer:
        for step in range(4):
            writer.write(replace(ROW, step=step))
    with HistoryWriter(path, probes=2, kept=2) as writer:
        writer.write(replace(ROW, step=9))
    assert read_history(path)["step"].tolist() == [0, 1, 9]
    with pytest.raises(CaseError, match="cannot be continued after 7 rows"):
        HistoryWriter(path, probes=2, kept=7)
    with pytest.raises(CaseError, match="cannot be continued"):
        HistoryWriter(path, probes=1, kept=2)
    assert read_history(path)["step"].tolist() == [0, 1, 9]


def test_row_with_other_probes_is_refused(tmp_path: Path) -> None:
    with (
        HistoryWriter(tmp_path / "history.csv", probes=1) as writer,
        pytest.raises(ValueError, match="2 probes"),
    ):
        writer.write(ROW)


def test_missing_or_foreign_table_is_explained(tmp_path: Path) -> None:
    path = tmp_path / "history.csv"
    with pytest.raises(CaseError, match=r"is missing.*pantograph run"):
        read_history(path)
    path.write_text("time,force\n0,1\n")
    with pytest.raises(CaseError, match="not the history of a run"):
        read_history(path)
    path.write_text(f"{HEADER}\n1,2\n")
    with pytest.raises(CaseError, match="damaged"):
        read_history(path)


def summary(path: Path, **changed: object) -> dict[str, object]:
    arguments = {
        "status": "done",
        "last": ROW,
        "dofs": {"displacement": np.int32(7)},
        "cells": 12,
        "seconds": {"solve": 1.25, "total": 2.0},
        "versions": package_versions(),
    }
    write_summary(path, **(arguments | changed))  # type: ignore[arg-type]
    return json.loads(path.read_text())


def test_summary_tells_how_the_run_ended(tmp_path: Path) -> None:
    found = summary(tmp_path / "summary.json", message="Results are in results/a.")
    assert found["status"] == "done"
    assert found["message"] == "Results are in results/a."
    assert found["last"]["load"] == ROW.load
    assert list(found["last"])[:15] == HEADER.split(",")
    assert found["dofs"] == {"displacement": 7}
    assert found["cells"] == 12
    assert list(found["seconds"]) == ["mesh", "compile", "assemble", "solve", "output", "total"]
    assert found["seconds"]["solve"] == 1.25
    assert found["seconds"]["mesh"] == 0.0
    assert found["versions"]["numpy"] == np.__version__
    assert [file.name for file in tmp_path.iterdir()] == ["summary.json"]


def test_summary_of_a_run_without_steps(tmp_path: Path) -> None:
    found = summary(tmp_path / "s.json", status="stopped: no equilibrium at load 0.1", last=None)
    assert found["last"] is None


def test_summary_refuses_other_words(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"status is 'failed'.*stopped"):
        summary(tmp_path / "summary.json", status="failed")
    with pytest.raises(ValueError, match=r"unknown phases \['plot'\]"):
        summary(tmp_path / "summary.json", seconds={"plot": 1.0})
    assert not list(tmp_path.iterdir())


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def shown(stream: io.StringIO, quiet: bool = False) -> str:
    with Progress("Bias test [a]", quiet=quiet, stream=stream) as progress:
        progress.accepted(replace(ROW, force=(3.0, 4.0), stable=True), 12.3)
        progress.rejected(0.45, 0.1, "Newton's method diverged")
        progress.accepted(replace(ROW, load=1.0), 20.0)
    return stream.getvalue()


def test_lines_where_there_is_no_terminal() -> None:
    assert shown(io.StringIO()).splitlines() == [
        "step 4  load 0.3000  iterations 4  force 5 N  energy 0.1402 J",
        "cut back: load 0.4500 not reached with a step of 0.1: Newton's method diverged",
        "step 4  load 1.0000  iterations 4  force 11.28 N  energy 0.1402 J  unstable",
    ]


def test_bar_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "140")
    text = shown(Terminal())
    assert "\x1b[" in text
    assert "Bias test [a]" in text
    assert "cut back: load 0.4500" in text
    assert "load 1.0000  step 4  iterations 4  force 11.28 N  20 s  unstable" in text


@pytest.mark.parametrize("stream", [io.StringIO(), Terminal()])
def test_quiet_shows_nothing(stream: io.StringIO) -> None:
    assert shown(stream, quiet=True) == ""
