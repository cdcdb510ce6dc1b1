"""The judge of hard cases knows of every critical point, and misses one that is missing."""

from dataclasses import replace

import numpy as np
import pytest

from pantograph_fem.case import case_from_dict
from pantograph_fem.stress.checks import changes_are_located
from pantograph_fem.stress.critical_loads import CriticalLoads
from pantograph_fem.stress.evidence import Evidence
from pantograph_fem.study.process import Ended

CASE = case_from_dict(
    {
        "name": "column",
        "kind": "beam",
        "beam": {"length": 1.0},
        "material": {"stretch": 1e4, "bending": 1.0},
    }
)
KNOWN = CriticalLoads((0.2, 0.5), 1e-5, "bifurcation", "closed form")


def bifurcation(step, load, modes=1):
    return {"step": step, "load": load, "kind": "bifurcation", "modes": modes}


def evidence(excess, *points):
    excess = np.array(excess)
    history = {
        "step": np.arange(len(excess)),
        "load": np.linspace(0.0, 1.0, len(excess)),
        "negative_pivots": 7 + excess,
        "expected_negative_pivots": np.full(len(excess), 7),
        "stable": excess == 0,
    }
    return Evidence(CASE, Ended(0, 1.0), history, {"critical_points": list(points)})


LOST = evidence([0, 0, 1, 1, 2, 2], bifurcation(1, 0.2), bifurcation(3, 0.5))


@pytest.mark.parametrize(
    "found",
    [
        LOST,
        evidence([0, 0, 1, 1, 0, 0], bifurcation(1, 0.2), bifurcation(4, 0.8)),  # regained
        evidence([0, 0, 2, 2], bifurcation(1, 0.3, modes=2)),
        evidence([0, 0, 1, 3, 3], bifurcation(1, 0.2), bifurcation(2, 0.3, modes=2)),
        evidence([0, 0, 0]),
    ],
)
def test_changes_of_inertia_at_critical_points_are_as_they_should_be(found):
    assert changes_are_located(found) == ""


@pytest.mark.parametrize(
    ("found", "complaint"),
    [
        (evidence([0, 0, 1, 1]), "stability is lost before load 0.666667, at no critical point"),
        (evidence([0, 0, 1, 1, 2], bifurcation(1, 0.2)), "change from 1 to 2, at no critical"),
        (evidence([1, 1, 0, 0]), "change from 1 to 0, at no critical"),
        (evidence([0, 0, 2, 2], bifurcation(1, 0.2)), "from 0 to 2, at 1 critical point"),
    ],
)
def test_a_change_that_was_not_located_is_complained_of(found, complaint):
    assert complaint in changes_are_located(found)


def test_all_critical_loads_are_compared():
    assert KNOWN.objection(LOST, {}) == ""
    first, second = LOST.summary["critical_points"]

    def said(*points):
        return KNOWN.objection(replace(LOST, summary={"critical_points": points}), {})

    assert "critical points found: 1, of which there are 2" in said(first)
    assert "critical load 2 is 0.51, not 0.5" in said(first, second | {"load": 0.51})
    assert "critical point 1 is a limit point" in said(first | {"kind": "limit point"}, second)
