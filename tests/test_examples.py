"""The examples run as they are, and what they show is right."""

import runpy
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from PIL import Image

EXAMPLES = Path(__file__).parents[1] / "examples"


@pytest.fixture
def example(tmp_path, monkeypatch):
    """Run an example by its number; returns its names. It must have saved a figure."""

    def run(number):
        (path,) = EXAMPLES.glob(f"{number:02}_*.py")
        monkeypatch.setenv("PANTOGRAPH_RESULTS", str(tmp_path))
        with plt.rc_context({"backend": "agg"}):
            names = runpy.run_path(str(path), run_name="__main__")
        plt.close("all")
        (figure,) = tmp_path.glob("*.png")
        assert np.ptp(np.asarray(Image.open(figure).convert("L"))) > 200
        return names

    return run


@pytest.mark.slow
def test_bias_extension(example):
    names = example(1)
    history = names["result"].history
    force = history["force_y"]
    assert np.all(np.diff(force) > 0)
    assert force[-1] == pytest.approx(56.81, rel=0.05)  # of a fine mesh
    assert history["energy_shear"][-1] > 0.5 * history["energy"][-1]
    # the fibres turn most in the middle, where they nearly lock
    state = names["state"]
    middle = np.linalg.norm(state.points - [0.034, 0.102], axis=1).argmin()
    assert state["shear_angle"][middle] == pytest.approx(1.2, abs=0.1)


def test_cantilever(example):
    names = example(2)
    assert names["angle_error"] < 1e-6
    assert names["place_error"] < 1e-7


@pytest.mark.slow
def test_lattice_and_sheet(example):
    names = example(3)
    coarse, fine = (abs(names["difference"][f"lattice, {mm} mm"]) for mm in (9.6, 4.8))
    assert fine < 0.6 * coarse < 0.06


def test_buckling(example):
    names = example(4)
    assert abs(names["error"]) < 1e-5
    assert names["fork"]["kind"] == "bifurcation"
    assert names["result"].last["stable"]
    assert abs(names["result"].last["tip_uy"]) > 0.1


def test_each_example_has_its_test():
    tested = sum(name.startswith("test_") for name in globals()) - 1
    assert len(list(EXAMPLES.glob("*.py"))) == tested
