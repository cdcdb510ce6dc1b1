"""Designs of sweeps: where their points lie, and what is refused."""

from itertools import product
from pathlib import Path

import numpy as np
import pytest
import tomli_w

from pantograph_fem.errors import CaseError
from pantograph_fem.sweep.design import make_design
from pantograph_fem.sweep.plan import make_plan
from pantograph_fem.sweep.study_file import load_sweep

CASES = Path(__file__).parents[1] / "cases"
STRETCH = {"key": "material.stretch", "low": 1e7, "high": 1e9, "scale": "log"}
BENDING = {"key": "material.bending", "low": 1e5, "high": 3e5}


def write_sweep(folder, *vary, case=CASES / "beam_arc.toml", **tables):
    path = folder / "made_up.toml"
    path.write_text(tomli_w.dumps({"case": str(case), **tables, "vary": list(vary)}))
    return path


def design(folder, *vary, **tables):
    return make_design(load_sweep(write_sweep(folder, *vary, **tables)))


def refused(folder, *vary, **tables):
    with pytest.raises(CaseError) as error:
        make_plan(write_sweep(folder, *vary, **tables), None, ())
    return str(error.value)


def test_a_grid_has_all_combinations_and_the_last_key_changes_first(tmp_path):
    found = design(
        tmp_path,
        {"key": "material.bending", "values": [3.0, 1.0, 2.0]},
        {"key": "material.stretch", "low": 10.0, "high": 1000.0, "count": 3, "scale": "log"},
    )
    stretches = [10.0, 100.0, 1000.0]
    assert np.allclose(found.values, list(product([3.0, 1.0, 2.0], stretches)), rtol=1e-14)
    # the ends themselves
    assert (found.values[0][1], found.values[2][1]) == (10.0, 1000.0)


@pytest.mark.parametrize("name", ["latin_hypercube", "sobol"])
def test_each_stratum_of_each_range_has_one_point(tmp_path, name):
    n = 64
    x, y = np.array(design(tmp_path, STRETCH, BENDING, design=name, samples=n).values).T
    for u in (np.log(x / 1e7) / np.log(100), (y - 1e5) / 2e5):
        assert sorted(np.floor(n * u).astype(int)) == list(range(n))


@pytest.mark.parametrize("name", ["latin_hypercube", "sobol", "saltelli"])
def test_values_of_a_sample_are_equally_frequent(tmp_path, name):
    degree = {"key": "discretisation.degree", "values": [2, 3, 4, 5]}
    found = design(tmp_path, degree, BENDING, design=name, samples=64).values
    counts = {value: sum(v[0] == value for v in found) for value in (2, 3, 4, 5)}
    assert sum(counts.values()) == len(found)
    # of Saltelli's points each value of a column comes from two samples, each evenly filled
    assert set(counts.values()) == {len(found) // 4}


def test_a_step_of_a_trajectory_changes_one_key_by_two_thirds_of_its_range(tmp_path):
    found = design(tmp_path, STRETCH, BENDING, design="morris", samples=5)
    unit = found.unit.reshape(5, 3, 2)
    steps = np.abs(np.diff(unit, axis=1))
    assert np.allclose(np.sort(steps, axis=2), [0.0, 2 / 3])
    assert np.allclose(steps.sum(axis=1), 2 / 3)
    values = np.array(found.values)
    assert np.allclose(np.log10(values[:, 0]), 7 + 2 * found.unit[:, 0])
    assert np.allclose(values[:, 1], 1e5 * (1 + 2 * found.unit[:, 1]))


@pytest.mark.parametrize("name", ["latin_hypercube", "sobol", "morris", "saltelli"])
def test_the_seed_makes_the_points(tmp_path, name):
    def values(seed):
        return design(tmp_path, STRETCH, BENDING, design=name, samples=8, seed=seed).values

    assert values(0) == values(0)
    assert values(3) == values(3)
    assert values(0) != values(3)


def test_entries_of_lists_are_varied_on_their_own(tmp_path):
    path = write_sweep(
        tmp_path,
        {"key": "ends.right.pivot[1]", "values": [0.1, 0.2]},
        {"key": "ends.right.pivot[0]", "values": [0.4]},
    )
    plan = make_plan(path, tmp_path, ())
    assert [point.case.ends.right.pivot for point in plan.points] == [(0.4, 0.1), (0.4, 0.2)]
    with pytest.raises(CaseError, match=r"vary\[0\]\.key.*has a list of 2 at ends\.right\.pivot"):
        make_plan(write_sweep(tmp_path, {"key": "ends.right.pivot[2]", "values": [1.0]}), None, ())
    with pytest.raises(CaseError, match="has no list at material"):
        make_plan(write_sweep(tmp_path, {"key": "material.bending[0]", "values": [1.0]}), None, ())


def test_points_with_the_same_case_share_their_folder(tmp_path):
    # a chain has a whole number of links
    path = write_sweep(
        tmp_path,
        {"key": "chain.spacing", "values": [0.1, 0.1001, 0.05]},
        case=CASES / "chain_arc.toml",
    )
    folders = [point.directory for point in make_plan(path, tmp_path, ()).points]
    assert folders[0] == folders[1] != folders[2]


def test_the_outputs_are_those_of_the_kind(tmp_path):
    def outputs(case, key, value, **tables):
        return make_plan(
            write_sweep(
                tmp_path, {"key": key, "values": [value]}, case=CASES / f"{case}.toml", **tables
            ),
            None,
            (),
        ).outputs

    parts = [name for name in outputs("beam_arc", "beam.length", 2.0) if "energy_" in name]
    assert parts == ["energy_stretch", "energy_bending"]
    # what is looked at is tabulated, too
    assert outputs("beam_euler", "beam.length", 2.0, responses=["load", "energy"])[-1] == "load"
    assert "energy_foundation" in outputs("beam_winkler_a1", "material.stretch", 1e7)
    assert "energy_shear" in outputs("lattice_bias_extension", "lattice.spacing", 0.01)
    assert "energy_shear" in outputs("a_bias_extension", "material.shear", 160.0)
    read = ["psi1", "force"]
    wanted = {"outputs": read, "responses": ["psi1"]}
    assert outputs("bias_experiment", "material.shear", 160.0, **wanted) == tuple(read)


@pytest.mark.parametrize(
    ("vary", "words"),
    [
        ({"key": "material.bending"}, "values, or low and high, are missing"),
        ({"key": "material.bending", "low": 2.0, "high": 1.0}, "greater than low (2.0)"),
        ({"key": "material.bending", "low": 0.0, "high": 1.0, "scale": "log"}, "greater than 0"),
        ({"key": "material.bending", "values": []}, "a list of different numbers"),
        ({"key": "material.bending", "values": [1.0, 1.0]}, "a list of different numbers"),
        ({"key": "material.bending", "values": [1.0], "low": 1.0}, "low: not allowed beside"),
        ({"key": "material.bending", "low": 1.0, "high": 2.0}, "count: missing; a grid needs"),
        ({"key": "a b", "values": [1]}, "be a key of the case"),
        ({"keys": "material.bending", "values": [1]}, 'did you mean "key"'),
        ({"key": "material.bend", "values": [1.0]}, 'did you mean "bending"'),
        ({"key": "material.bending", "values": [-1.0]}, "material.bending: -1.0 is not allowed"),
    ],
)
def test_what_varies_is_checked(tmp_path, vary, words):
    assert words in refused(tmp_path, vary)


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        ({"design": "lhs"}, "design: "),
        ({"design": "sobol"}, "samples: missing"),
        ({"design": "sobol", "samples": 12}, "samples: 12 is not allowed; it must be a power of 2"),
        ({"design": "morris", "samples": 1}, "samples: 1 is not allowed; it must be 2 or greater"),
        ({"outputs": ["force"], "samples": 4, "design": "sobol"}, 'responses: "energy"'),
        ({"outputs": ["forces", "energy", "force"], "samples": 4, "design": "sobol"}, '"forces"'),
        ({"sample": 4}, 'did you mean "samples"'),
        ({"samples": 4}, "samples: not allowed in a grid"),
    ],
)
def test_the_sweep_is_checked(tmp_path, tables, words):
    assert words in refused(tmp_path, BENDING, **tables)


def test_a_key_is_varied_once_and_not_set_as_well(tmp_path):
    whole = {"key": "ends.right.pivot", "values": [[0.5, 0.0], [0.5, 0.1]]}
    entry = {"key": "ends.right.pivot[0]", "values": [0.4]}
    assert "apart from ends.right.pivot" in refused(tmp_path, whole, entry)
    value = {"key": "material.bending", "values": [1e5]}
    words = refused(tmp_path, value, set=["material.bending=2e5"])
    assert "--set material.bending=2e5: material.bending is varied" in words
    assert "vary: [] is not allowed; it must be at least one table" in refused(tmp_path)
    assert "x.toml is not found" in refused(tmp_path, value, case="x.toml")
    morris = {"key": "material.bending", "values": [1e5, 2e5]}
    assert "elementary effects need a range" in refused(
        tmp_path, morris, design="morris", samples=2
    )
