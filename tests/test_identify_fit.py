"""Constants are found again from data that were made with them."""

import json

import numpy as np
import pytest

from pantograph_fem.case import case_from_dict
from pantograph_fem.identify.advice import advice
from pantograph_fem.identify.data import Datum, collect
from pantograph_fem.identify.estimates import estimates_of
from pantograph_fem.identify.fit import fit
from pantograph_fem.identify.parameters import Parameter
from pantograph_fem.identify.paths import Paths
from pantograph_fem.identify.problem import Experiment
from pantograph_fem.identify.profile import profile_of
from pantograph_fem.identify.responses import response_columns

from .conftest import COARSE, merged

#: The bias test with few, cheap elements.
BIAS = {
    "grips": {"top": {"translation": [0.0, 0.0567]}},
    "mesh": {"size": 0.03, "corner_size": 0.03},
    "discretisation": {"scheme": "hinge", "degree": 2},
    "measurements": {
        "psi1": {"kind": "shear_angle", "point": [0.034, 0.102]},
        "psi2": {"kind": "shear_angle", "point": [0.0136, 0.0204]},
        "b1": {"kind": "elongation", "points": [[0.0, 0.0], [0.0034, 0.0034]]},
        "m": {"kind": "marker", "point": [0.017, 0.034]},
    },
}
TRUE = {"stretch": 1.34e5, "bending": 1.92e-2, "shear": 159.0, "shear_exponent": 1.36}
LOADS = (0.25, 0.41, 0.57, 0.72, 0.88, 1.0)
ALL = ("force_y", "psi1", "psi2", "b1", "m_x", "m_y")


def model(factors, **changes):
    """Paths of the bias test whose constants start at the true ones times some factors."""
    case = case_from_dict(merged(merged(COARSE, BIAS), changes))
    parameters = []
    for name, factor in factors.items():
        origin = float(name == "shear_exponent")
        start = origin + factor * (TRUE[name] - origin)
        low, high = (1.01, 4.0) if origin else (1e-3 * start, 1e3 * start)
        parameters.append(Parameter(name, start, low, high))
    experiment = Experiment(case, tuple(parameters), response_columns(case), 0.0567)
    return Paths(experiment.model_case, parameters, LOADS), experiment.columns


def truth(paths):
    return np.array([p.coordinate(TRUE[p.name]) for p in paths.parameters])


def observe(paths, columns, used, relative_error):
    """Exact data, with errors that are a share of a column's largest value."""
    values = paths.at(truth(paths)).values
    numbers = [columns.index(name) for name in used]
    sizes = np.abs(values).max(axis=0)
    return collect(
        [
            Datum(load, columns[c], float(values[i, c]), relative_error * float(sizes[c]))
            for i, load in enumerate(LOADS)
            for c in numbers
        ],
        columns,
    )


THIRDS = {"stretch": 3.0, "bending": 1 / 3, "shear": 3.0, "shear_exponent": 1 / 3}


@pytest.mark.parametrize("scheme", ["hinge", "micromorphic"])
@pytest.mark.parametrize("factors", [THIRDS, {name: 1 / f for name, f in THIRDS.items()}])
def test_constants_are_found_again_from_a_factor_of_three_off(factors, scheme):
    source, columns = model(factors, discretisation={"scheme": scheme})
    observations = observe(source, columns, ALL, 0.01)
    paths, _ = model(factors, discretisation={"scheme": scheme})  # which has not seen the truth
    found = fit(paths, observations)
    assert found.converged
    for parameter, q in zip(paths.parameters, found.q.tolist(), strict=True):
        assert parameter.value(q) == pytest.approx(TRUE[parameter.name], rel=1e-4)
    # at most twenty paths from rest, counted in what dominates their time
    assert paths.cost.tangents[0] <= 20 * paths.cost.tangents[1]


def test_any_subset_of_constants_can_be_looked_for():
    paths, columns = model({"shear": 3.0, "shear_exponent": 3.0})
    found = fit(paths, observe(paths, columns, ("force_y",), 0.01))
    np.testing.assert_allclose(found.q, truth(paths), atol=1e-6)


def test_a_bias_test_alone_hardly_sees_the_bending_stiffness():
    """Force alone tells K_b many times worse than with the angle in the most bent region."""
    ones = dict.fromkeys(TRUE, 1.0)
    paths, columns = model(ones)
    q = truth(paths)
    deviations = {}
    for used in (("force_y",), ("force_y", "psi2")):
        found = fit(paths, observe(paths, columns, used, 0.01), q)
        estimates = estimates_of(found, paths.parameters, 0.95)
        deviations[used] = [e.deviation for e in estimates]
    alone, with_angle = deviations.values()
    assert alone[1] > 0.3  # K_b is not known
    assert alone[1] > 5 * alone[2]  # as K_p is
    assert with_angle[1] < 0.5 * alone[1]


def test_advice_is_kept_by_what_it_promises():
    """Data with the column and the error that are advised tell the constant within 10 %."""
    paths, columns = model(dict.fromkeys(TRUE, 1.0))
    observations = observe(paths, columns, ("force_y",), 0.01)
    found = fit(paths, observations, truth(paths))
    one = advice(found, observations, columns, number=1)
    assert one is not None
    c = columns.index(one.column)
    more = np.concatenate([found.jacobian, found.path.slopes[:, c] / one.error])
    assert np.sqrt(np.linalg.inv(more.T @ more)[1, 1]) == pytest.approx(0.1, rel=1e-2)


def test_a_profile_rises_as_the_standard_error_says():
    """Where data are many the profile is the parabola of the covariance."""
    paths, columns = model({"stretch": 1.0, "bending": 1.0})
    observations = observe(paths, columns, ALL, 0.002)
    found = fit(paths, observations, truth(paths))
    profile = profile_of(paths, observations, found, 1)
    deviation = np.sqrt(found.covariance[1, 1])
    assert len(profile.q) == 5
    rise = ((profile.q - found.q[1]) / deviation) ** 2
    np.testing.assert_allclose(profile.chi2, rise, atol=0.1)


@pytest.mark.slow
def test_intervals_hold_the_true_constants_as_often_as_they_say():
    """Data with 1 % errors, a hundred times: 95 % intervals hold each constant 90 to 99 times."""
    paths, columns = model(dict.fromkeys(TRUE, 1.2))
    exact = observe(paths, columns, ALL, 0.01)
    q = truth(paths)
    held = np.zeros(len(q), dtype=int)
    chi2 = []
    for seed in range(100):
        noise = np.random.default_rng(seed).standard_normal(exact.values.shape)
        found = fit(paths, exact.with_values(exact.values + exact.errors * noise))
        for i, estimate in enumerate(estimates_of(found, paths.parameters, 0.95)):
            low, high = estimate.interval
            held[i] += low <= TRUE[estimate.parameter.name] <= high
        chi2.append(found.chi2)
    assert held.min() >= 90, held
    assert held.max() <= 99, held
    # and χ² is what it should be: its mean has the standard error (2 n / 100)^½
    freedom = len(exact.values) - len(q)
    assert np.mean(chi2) == pytest.approx(freedom, abs=4 * np.sqrt(2 * freedom / 100))


@pytest.mark.slow
def test_the_command_makes_data_finds_the_constants_and_draws_figures(tmp_path):
    import tomli_w

    from .test_cli import pantograph

    case = merged(COARSE, BIAS)
    (tmp_path / "case.toml").write_text(tomli_w.dumps(case))
    study = {
        "case": "case.toml",
        "constants": {"shear": {"start": 400.0}, "bending": {"start": 0.01}},
        "data": [{"file": "a.csv", "errors": {"force_y": 0.3, "psi*": 0.01, "m_*": 1e-4}}],
        "synthetic": {"seed": 3, "loads": [0.5, 1.0]},
    }
    (tmp_path / "study.toml").write_text(tomli_w.dumps(study))
    run = pantograph("identify", "study.toml", "--synthetic", cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    assert "All constants are known from these data." in run.stdout
    results = tmp_path / "results" / "study"
    names = {path.name for path in results.glob("*.*")}
    assert names == {
        *("identify.json", "fit.csv", "case.identified.toml"),
        *("fit.png", "residuals.png", "states.png", "profile.png"),
    }
    found = json.loads((results / "identify.json").read_text())
    shear = found["estimates"]["shear"]
    assert shear["value"] == pytest.approx(159.0, abs=5 * shear["standard_error"])
    assert not (tmp_path / "a.csv").exists()  # what was measured is never overwritten

    run = pantograph("identify", "study.toml", cwd=tmp_path)
    assert run.returncode == 2
    assert "a.csv cannot be read" in run.stderr
