"""Measurements: what instruments read on a deformed sheet, and how a case asks for them."""

import numpy as np
import pytest

from pantograph_fem.case import case_from_dict, case_to_toml
from pantograph_fem.errors import CaseError
from pantograph_fem.measure import InstrumentPanel

from .conftest import COARSE, merged

MEASUREMENTS = {
    "m": {"kind": "marker", "point": [0.02, 0.05]},
    "turn": {
        "kind": "angle",
        "lines": [[[0.01, 0.02], [0.03, 0.02]], [[0.01, 0.02], [0.03, 0.05]]],
    },
    "psi": {"kind": "shear_angle", "point": [0.034, 0.102]},
    "b": {"kind": "elongation", "points": [[0.0, 0.0], [0.0034, 0.0034]]},
    "w": {"kind": "width", "height": 0.1},
}
COLUMNS = ("m_x", "m_y", "turn", "psi", "b", "w")


def case_with(measurements, **changes):
    return case_from_dict(merged(COARSE, changes) | {"measurements": measurements})


def panel(**changes):
    case = case_with(MEASUREMENTS, **changes)
    return InstrumentPanel(case.measurements, case.sheet)


def test_readings_of_a_homogeneous_stretch_are_those_of_the_closed_forms():
    """With F = diag(λx, λy) and fibres at 45°, ψ = 2 atan(λy/λx) - π/2."""
    lx, ly = 0.8, 1.3
    board = panel()
    readings = dict(zip(board.columns, board.values(board.points * [lx - 1, ly - 1]), strict=True))
    assert board.columns == COLUMNS
    assert readings["m_x"] == pytest.approx(lx * 0.02)
    assert readings["m_y"] == pytest.approx(ly * 0.05)
    assert readings["turn"] == pytest.approx(np.arctan2(ly * 0.03, lx * 0.02))
    # fibres are drawn together along y: the angle that opens upwards closes
    assert abs(readings["psi"]) == pytest.approx(2 * np.arctan(ly / lx) - np.pi / 2)
    assert readings["b"] == pytest.approx(np.sqrt((lx**2 + ly**2) / 2) - 1)
    assert readings["w"] == pytest.approx(lx * 0.068)


def test_a_rigid_motion_turns_no_angle_and_stretches_nothing():
    board = panel(sheet={"fibre_angle": 30.0})
    c, s = np.cos(2.5), np.sin(2.5)
    moved = board.points @ np.array([[c, -s], [s, c]]).T + [0.3, -0.1]
    rest = board.values(np.zeros_like(board.points))
    assert board.values(moved - board.points)[2:5] == pytest.approx(rest[2:5], abs=1e-12)
    assert rest[3:5] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("sabotage", "order"), [(1.0, 2.0), (1.01, 1.0)])
def test_rates_are_the_derivatives_of_the_readings(sabotage, order):
    """Off by 1 %, the remainder would be of first order."""
    board = panel()
    rng = np.random.default_rng(0)
    u, v = 1e-3 * rng.standard_normal((2, *board.points.shape))
    slope = sabotage * board.rates(u, v)

    def remainder(h):
        return np.abs(board.values(u + h * v) - board.values(u) - h * slope)[2:5].max()

    assert np.log2(remainder(1e-2) / remainder(5e-3)) == pytest.approx(order, abs=0.1)


@pytest.mark.core
def test_measurements_are_columns_behind_those_of_every_table(solve):
    run = solve(measurements=MEASUREMENTS, output={"probes": [[0.02, 0.05]]})
    row = run.last.columns()
    assert tuple(row)[15:] == (*COLUMNS, "probe0_ux", "probe0_uy")
    assert row["m_x"] == pytest.approx(0.02 + row["probe0_ux"], rel=1e-12)
    assert row["m_y"] == pytest.approx(0.05 + row["probe0_uy"], rel=1e-12)


def test_a_case_with_measurements_survives_the_file():
    import tomllib

    case = case_with(MEASUREMENTS)
    assert case_from_dict(tomllib.loads(case_to_toml(case))) == case


@pytest.mark.parametrize(
    ("name", "table", "sentence"),
    [
        ("m", {"kind": "marker", "pont": [0, 0]}, 'm.pont: unknown key; did you mean "point"?'),
        ("m", {"kind": "marker"}, "measurements.m.point: missing"),
        ("m", {"point": [0.0, 0.0]}, "measurements.m.kind: missing; it is required and must be "),
        ("m", {"kind": "camera"}, 'measurements.m.kind: "camera" is not allowed; it must be "mark'),
        (
            "m",
            {"kind": "marker", "point": [0.1, 0.0]},
            "m.point: [0.1, 0.0] is not allowed; it mus",
        ),
        ("p", {"kind": "shear_angle", "point": [0.001, 0.1]}, "p.gauge: 0.0048 is not allowed"),
        ("w", {"kind": "width", "height": 0.3}, "w.height: 0.3 is not allowed; it must be from 0"),
        ("b", {"kind": "elongation", "points": [[0, 0], [0, 0]]}, "two different points"),
        ("force_y", {"kind": "width", "height": 0.1}, "the column force_y would be that of hist"),
        ("two words", {"kind": "width", "height": 0.1}, "letters, digits and _"),
    ],
)
def test_a_wrong_measurement_is_refused_by_its_key(name, table, sentence):
    with pytest.raises(CaseError) as caught:
        case_with({name: table})
    assert sentence in str(caught.value)


def test_two_measurements_must_not_share_a_column():
    with pytest.raises(CaseError, match=r"the column a_x would be that of measurements\.a;"):
        case_with({"a": MEASUREMENTS["m"], "a_x": MEASUREMENTS["w"]})
