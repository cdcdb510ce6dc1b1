"""Study files and measured data: what is read, and what is refused in which words."""

from pathlib import Path

import numpy as np
import pytest

from pantograph_fem.errors import CaseError
from pantograph_fem.identify.data import collect, read_data
from pantograph_fem.identify.estimates import estimates_of, sentences
from pantograph_fem.identify.fit import Fit, covariance_of
from pantograph_fem.identify.parameters import Parameter
from pantograph_fem.identify.problem import experiment_of
from pantograph_fem.identify.study import DataFile
from pantograph_fem.identify.study_file import load_identify_study

COLUMNS = ("force_x", "force_y", "psi1", "m_x", "m_y")
STUDIES = Path(__file__).parents[1] / "studies"


def read(tmp_path, text, distance=0.05, **keys):
    path = tmp_path / "data.csv"
    path.write_text(text)
    return read_data(DataFile(file="data.csv", **keys), path, COLUMNS, distance)


def test_a_table_is_read_with_its_own_errors_before_those_of_the_study(tmp_path):
    text = "displacement,force_y,force_y_error,psi1\n0.0,0,1,0\n0.025,10,0.5,\n0.05,20,0.6,0.7\n"
    data = read(tmp_path, text, errors={"force_*": 9.0, "psi1": 0.01})
    observed = collect(data, COLUMNS)
    assert observed.loads.tolist() == [0.5, 1.0]  # the state of rest says nothing
    assert observed.column.tolist() == [1, 1, 2]
    assert observed.load.tolist() == [0, 1, 1]
    assert observed.values.tolist() == [10.0, 20.0, 0.7]
    assert observed.errors.tolist() == [0.5, 0.6, 0.01]


def test_columns_of_a_file_can_be_chosen_by_pattern(tmp_path):
    text = "load,force_y,step,m_x,m_y\n1.0,10,7,0.1,0.2\n"
    data = read(tmp_path, text, columns=["m_*"], errors={"m_*": 1e-4})
    assert [datum.column for datum in data] == ["m_x", "m_y"]


@pytest.mark.parametrize(
    ("text", "keys", "sentence"),
    [
        ("force_y\n1\n", {}, "neither a column load nor a column displacement"),
        ("load,force_z\n1,2\n", {}, 'the case measures no force_z; did you mean "force_y"?'),
        ("load,psi1\n1,2\n", {}, "row 1: psi1 has no standard error; give a column psi1_error"),
        ("load,psi1\n1,two\n", {"errors": {"psi1": 1.0}}, 'row 1: psi1 is "two"; it must be a nu'),
        ("load,psi1,psi1_error\n1,2,0\n", {}, "row 1: psi1 has the error 0; give"),
        ("displacement,psi1\n0.06,1\n", {"errors": {"psi1": 1.0}}, "0.06 is outside of the case's"),
        ("load,psi1\n", {}, "holds no data"),
        ("load,psi1\n1,1\n", {"columns": ["q*"]}, 'is called "q*", which the study asks for'),
    ],
)
def test_wrong_data_are_refused_by_file_and_row(tmp_path, text, keys, sentence):
    with pytest.raises(CaseError) as caught:
        read(tmp_path, text, **keys)
    assert sentence in str(caught.value)
    assert "data.csv" in str(caught.value)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (
            "[constants.bendin]\nstart = 1.0",
            'constants.bendin: unknown key; did you mean "bending"',
        ),
        (
            "[constants.bending]\nstrat = 1.0",
            'constants.bending.strat: unknown key; did you mean "s',
        ),
        ("[constants.bending]\nstart = -1.0", "constants.bending.start: -1.0 is not allowed"),
        ("[constants]", "constants: none is given"),
        (
            "[constants.shear]\nstart = 1.0\nbounds = [2.0, 3.0]",
            "constants.shear.start: 1.0 is not allowed; it must lie between its bounds, 2 and 3",
        ),
        (
            "[constants.shear_exponent]\nstart = 1.5\nbounds = [1.0, 3.0]",
            "constants.shear_exponent.bounds: 1.0 is not allowed; it must be greater than 1",
        ),
        ("[constants.shear]\nstart = 1.0\n[[data]]\nfile = 3", "data[0].file: 3 is not allowed"),
        ("[constants.shear]\nstart = 1.0", "data: missing; it must be at least one table [[data]]"),
    ],
)
def test_a_wrong_study_is_refused_by_its_key(tmp_path, text, sentence):
    path = tmp_path / "study.toml"
    data = "" if "data" in sentence else '\n[[data]]\nfile = "a.csv"\n'
    path.write_text(f'case = "case.toml"\n{text}{data}')
    with pytest.raises(CaseError) as caught:
        load_identify_study(path)
    assert sentence in str(caught.value)


@pytest.mark.parametrize(
    "path", sorted(STUDIES.glob("identify_*.toml")), ids=lambda path: path.stem
)
def test_the_studies_that_are_shipped_are_right(path):
    study = load_identify_study(path)
    experiment = experiment_of(study, path.parent)
    assert len(experiment.parameters) == 4
    for file in study.data:
        assert read_data(file, path.parent / file.file, experiment.columns, experiment.distance)


@pytest.mark.parametrize("name", ["stretch", "shear_exponent"])
@pytest.mark.parametrize("logarithmic", [True, False])
def test_coordinates_and_values_are_inverse_and_slopes_their_derivative(name, logarithmic):
    p = Parameter(name, 1.5, 1.2, 3.0, logarithmic)
    assert p.coordinate(p.start) == 0.0
    assert p.value(p.coordinate(2.3)) == pytest.approx(2.3)
    q, h = 0.3, 1e-6
    assert (p.value(q + h) - p.value(q - h)) / (2 * h) == pytest.approx(p.slope(q))


def _fit(jacobian, residuals):
    return Fit(np.zeros(2), None, np.asarray(residuals), np.asarray(jacobian), True, ())


PAIR = (Parameter("stretch", 1e5, 1e2, 1e8), Parameter("bending", 0.02, 2e-5, 20.0))


def test_a_constant_that_the_data_do_not_see_is_named():
    jacobian = np.array([[100.0, 0.0], [0.0, 0.5]])
    fit = _fit(jacobian, [0.5, -0.5])
    first, second = estimates_of(fit, PAIR, 0.95)
    assert (first.known, second.known) == (True, False)
    assert first.standard_error == pytest.approx(1e3)
    assert second.interval == pytest.approx((0.02 * np.exp(-3.92), 0.02 * np.exp(3.92)), rel=1e-3)
    told = sentences(fit, (first, second), 0.95, np.eye(2))
    assert told[0].startswith("K_b (bending) is not known from these data: its 95 % interval")


def test_constants_that_are_seen_together_are_named():
    jacobian = np.array([[100.0, 100.0], [100.0, 101.0], [0.0, 10.0]])
    fit = _fit(jacobian, [0.1, 1.0, 1.0])
    correlation = covariance_of(jacobian)
    correlation = correlation / np.sqrt(np.outer(np.diag(correlation), np.diag(correlation)))
    told = sentences(fit, estimates_of(fit, PAIR, 0.95), 0.95, correlation)
    assert told[0].startswith("K_e and K_b are told apart badly (correlation -0.99")


def test_a_model_that_misses_the_data_is_told():
    fit = _fit(np.eye(2).repeat(10, axis=0) * 100, np.full(20, 3.0))
    told = sentences(fit, estimates_of(fit, PAIR, 0.95), 0.95, np.eye(2))
    assert told[-1].startswith("The model misses the data by more than their standard errors allow")
