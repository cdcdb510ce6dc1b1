"""What several processes find together is what one finds alone."""

import json
from contextlib import nullcontext

import numpy as np
import pytest
from scipy.spatial import cKDTree

from mpi4py import MPI

from pantograph_fem import checkpoint, running
from pantograph_fem.case import case_from_dict, load_case
from pantograph_fem.results.fields import read_fields
from pantograph_fem.results.history import read_history

from .conftest import COARSE, merged
from .processes import SEVERAL, WORLD
from .test_adapt_run import EASY
from .test_resume import PowerCut, mortal
from .test_run_kinds import BEAM, CHAIN, LATTICE
from .test_stability_cases import COLUMN, UPRIGHT, critical_load

pytestmark = [
    pytest.mark.core,
    pytest.mark.skipif(not SEVERAL, reason="compares several processes with one"),
]

#: Pulled, pushed aside and turned, so that nothing vanishes by symmetry.
SHEET = merged(
    COARSE,
    {
        "grips": {"top": {"translation": [0.01, 0.03], "rotation": 10.0}},
        "discretisation": {"degree": 2},
        "measurements": {"w": {"kind": "width", "height": 0.1}},
        "output": {"probes": [[0.034, 0.102], [0.0, 0.0]], "figures": False, "eigenvalues": True},
    },
)
HINGE = {"discretisation": {"scheme": "hinge"}}
CLAMPS = {
    "grips": {"bottom": {"hold": "clamp"}, "top": {"hold": "clamp"}},
    "mesh": {"grip_size": 0.01},
}
BUCKLED = merged(COLUMN, {"ends": {"right": {"force": [-1.5 * critical_load(2.0), 0.0]}}})
#: Pushed together: it sways to a side.
SWAYING = merged(UPRIGHT, {"grips": {"top": {"translation": [0.0, -0.005]}}})
ARC = {"continuation": {"method": "arc_length"}}
BRANCH = {"continuation": {"on_instability": "branch"}}
CASES = {
    "micromorphic": SHEET,
    "clamps": merged(SHEET, CLAMPS),
    "hinge": merged(SHEET, HINGE),
    "clamped hinges": merged(merged(SHEET, HINGE), CLAMPS),
    "without bending": merged(SHEET, {"material": {"bending": None}}),
    "arc length": merged(SHEET, ARC),
    "unstable": merged(SWAYING, HINGE),
    "branch": merged(SWAYING, BRANCH),
    "adapted": EASY,
    "beam": BEAM,
    "buckling beam": merged(merged(BUCKLED, BRANCH), ARC),
    "chain": CHAIN,
    "lattice": LATTICE,
}
#: Columns in which processes have to agree to the last digit.
COUNTS = ("step", "negative_pivots", "expected_negative_pivots", "stable")
#: Relative, of what a column and those like it reach; and of a load that is searched for.
SAME, CRITICAL = 1e-9, 1e-6


@pytest.fixture(params=CASES)
def both(request, tmp_path):
    """Folders of a case run by all processes and, in each of them, by that one alone."""
    case = case_from_dict(CASES[request.param])
    alone = tmp_path / f"alone_{WORLD.rank}"
    running.run(case, tmp_path / "shared", quiet=True)
    running.run(case, alone, quiet=True, comm=MPI.COMM_SELF)
    return tmp_path / "shared", alone


def assert_same(shared, alone, size, what):
    np.testing.assert_allclose(shared, alone, rtol=0, atol=SAME * size, err_msg=what)


def test_histories_and_fields_are_the_same(both):
    summaries = [json.loads((folder / "summary.json").read_text()) for folder in both]
    for name in ("status", "dofs", "cells", "cutbacks"):
        assert summaries[0][name] == summaries[1][name], name
    points = [summary.get("critical_points", []) for summary in summaries]
    for one, other in zip(*points, strict=True):
        assert one == other | {"load": pytest.approx(other["load"], rel=CRITICAL)}

    shared, alone = (read_history(folder / "history.csv") for folder in both)
    assert shared.keys() == alone.keys()
    assert len(shared["load"]) > 2
    critical = [point["step"] for point in points[1]]
    common = ~np.isin(alone["step"], critical)
    # An arc that leaves from a critical point has its loads as exactly as the point was found.
    arc = load_case(both[0] / "case.resolved.toml").continuation.method == "arc_length"
    beyond = arc & (alone["step"][common] > min(critical, default=np.inf))
    for name, values in alone.items():
        if name in COUNTS:
            assert shared[name][common].tolist() == values[common].tolist(), name
        elif name != "newton_iterations":
            found, expected = shared[name][common], values[common]
            size = size_of(name, alone)
            assert_same(found[~beyond], expected[~beyond], size, name)
            assert_same(found[beyond], expected[beyond], size * CRITICAL / SAME, name)
    if (both[0] / "fields.xdmf").exists():
        assert_same_fields(*map(read_fields, both))


@pytest.mark.parametrize("name", ["micromorphic", "hinge", "adapted", "beam", "lattice"])
@pytest.mark.parametrize("after", [MPI.COMM_WORLD, MPI.COMM_SELF], ids=["more", "fewer"])
def test_a_run_is_taken_up_by_more_or_fewer_processes(name, after, tmp_path, monkeypatch):
    case = case_from_dict(merged(CASES[name], {"continuation": {"max_step": 0.25}}))
    before = MPI.COMM_WORLD if after == MPI.COMM_SELF else MPI.COMM_SELF
    whole, parts = tmp_path / f"whole_{WORLD.rank}", tmp_path / "parts"
    running.run(case, whole, quiet=True, comm=MPI.COMM_SELF)

    def by(comm, **options):
        if comm == MPI.COMM_WORLD or WORLD.rank == 0:
            return running.run(case, parts, quiet=True, comm=comm, **options)
        return None

    with monkeypatch.context() as patch:
        patch.setattr(checkpoint, "save", mortal(checkpoint.save, survived=2))
        mine = WORLD.rank == 0 or before == MPI.COMM_WORLD
        with pytest.raises(PowerCut) if mine else nullcontext():
            by(before)
    WORLD.Barrier()
    by(after, resume=True)
    WORLD.Barrier()

    found, expected = (read_history(folder / "history.csv") for folder in (parts, whole))
    assert found["load"].tolist() == expected["load"].tolist()
    for column in ("force_x", "force_y", "moment", "energy"):
        assert_same(found[column], expected[column], size_of(column, expected), column)
    if (parts / "fields.xdmf").exists():
        assert_same_fields(*map(read_fields, (parts, whole)))


def size_of(column, history):
    """What an error of a column is small against, though the column itself may vanish."""
    force = np.hypot(history["force_x"], history["force_y"]).max()
    probes = [np.abs(values).max() for name, values in history.items() if name.startswith("probe")]
    kinds = {
        "force": force,
        "moment": force * 0.1,
        "energy": history["energy"].max(),
        "shear": 1.0,
        "probe": max(probes, default=0.0),  # one of them is held
        "tip_angle": 1.0,
    }
    own = np.abs(history[column]).max()
    return next((size for kind, size in kinds.items() if column.startswith(kind)), own)


def assert_same_fields(shared, alone):
    """In the last state, whatever the order of its nodes."""
    assert len(shared.loads) == len(alone.loads)
    distances, node = cKDTree(shared.grid.points).query(alone.grid.points)
    assert distances.max() < 1e-12
    assert sorted(node) == list(range(len(shared.grid.points)))
    found, expected = shared.fields(-1), alone.fields(-1)
    assert found.keys() == expected.keys()
    for name, values in expected.items():
        # the mode is known less well than the state
        size = np.abs(values).max() * (1e3 if name == "mode" else 10)
        assert_same(found[name][node], values, size, name)
