"""Runs that are killed, or whose disk is full, go on later as if nothing had happened."""

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections import namedtuple
from pathlib import Path

import numpy as np
import pytest

from pantograph_fem.case import load_case
from pantograph_fem.errors import ResultsError
from pantograph_fem.results.fields import read_fields
from pantograph_fem.running import run

CASE = Path(__file__).parent.parent / "cases" / "beam_arc.toml"
#: Many steps, each of which writes its files.
STEPS = ("continuation.max_step=0.02", "mesh.size=0.0625", "output.figures=false")


def history(directory: Path) -> np.ndarray:
    table = np.genfromtxt(directory / "history.csv", delimiter=",", names=True)
    # how many iterations a state took is no part of it
    names = [name for name in table.dtype.names if name != "newton_iterations"]
    return np.column_stack([table[name] for name in names])


def assert_same(directory: Path, whole: Path) -> None:
    found, expected = history(directory), history(whole)
    assert found.shape == expected.shape
    scale = np.abs(expected).max(axis=0)
    assert (np.abs(found - expected) <= 1e-9 * scale).all()
    assert len(read_fields(directory).loads) == len(found)
    assert not list(directory.glob("*.part"))


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> Path:
    """Results of the same case, never interrupted."""
    return run(load_case(CASE, STEPS), tmp_path_factory.mktemp("whole"), quiet=True).directory


def command(directory: Path, *more: str) -> list[str]:
    overrides = [word for value in STEPS for word in ("--set", value)]
    program = [sys.executable, "-m", "pantograph_fem", "run", str(CASE)]
    return [*program, *overrides, *more, "--quiet", "--output", str(directory)]


@pytest.mark.slow
def test_killed_at_random_times(tmp_path: Path, whole: Path) -> None:
    """SIGKILL five times on its way, each time at another moment of a step."""
    chance = random.Random(2016)
    rows, kills = 0, 0
    for _ in range(5):
        process = subprocess.Popen(command(tmp_path, "--resume"))
        # When it has gone on by a few states, somewhere in the next one.
        wanted = rows + chance.randint(1, 6)
        while process.poll() is None and rows < wanted:
            time.sleep(0.002)
            path = tmp_path / "history.csv"
            rows = len(path.read_text().splitlines()) - 1 if path.is_file() else 0
        time.sleep(chance.uniform(0.0, 0.03))
        process.send_signal(signal.SIGKILL)
        kills += process.wait() == -signal.SIGKILL
        rows = len((tmp_path / "history.csv").read_text().splitlines()) - 1
    assert kills == 5
    assert not (tmp_path / "summary.json").exists()
    subprocess.run(command(tmp_path, "--resume"), check=True)
    assert_same(tmp_path, whole)


@pytest.mark.core
def test_a_full_disk_is_explained_and_the_run_goes_on_later(
    tmp_path: Path, whole: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    usage = namedtuple("usage", "total used free")  # as shutil's
    calls = []

    def filling(_: object) -> object:
        calls.append(None)
        return usage(10**9, 0, 10**9 if len(calls) < 8 else 1000)

    monkeypatch.setattr(shutil, "disk_usage", filling)
    with pytest.raises(ResultsError, match=r"could not be written to .*No space left.*--resume"):
        run(load_case(CASE, STEPS), tmp_path, quiet=True)
    monkeypatch.undo()
    assert 0 < len(history(tmp_path)) < len(history(whole))
    run(load_case(CASE, STEPS), tmp_path, quiet=True, resume=True)
    assert_same(tmp_path, whole)


@pytest.mark.slow
@pytest.mark.parametrize("kilobytes", [60, 300, 900])
def test_a_disk_that_is_really_full(tmp_path: Path, whole: Path, kilobytes: int) -> None:
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "none", str(disk)]
    if os.geteuid() or subprocess.run(mount, capture_output=True, check=False).returncode:
        pytest.skip("only a user who may mount can make a small disk")
    try:
        ended = subprocess.run(
            command(disk / "results"), capture_output=True, text=True, check=False
        )
        assert ended.returncode == 1
        assert "No space left" in ended.stderr
        assert "Traceback" not in ended.stderr
        subprocess.run(["mount", "-o", "remount,size=100m", str(disk)], check=True)
        subprocess.run(command(disk / "results", "--resume"), check=True)
        assert_same(disk / "results", whole)
    finally:
        subprocess.run(["umount", str(disk)], check=True)
