"""Grips that move at random: a judged state, or an end of the path with a message, always."""

import tempfile
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pantograph_fem.case import case_from_dict
from pantograph_fem.errors import PathError
from pantograph_fem.running import run
from pantograph_fem.stress.evidence import read_evidence
from pantograph_fem.stress.hard_case import HardCase
from pantograph_fem.stress.judge import judge
from pantograph_fem.stress.time_limit import time_limit
from pantograph_fem.study.process import Ended

from ..conftest import COARSE, merged

OUTPUT = {"figures": False, "fields": "none", "eigenvalues": True}
RANDOM = settings(
    max_examples=15,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)


def motions(way, turn):
    place = st.floats(-way, way)
    return st.fixed_dictionaries(
        {
            "translation": st.tuples(place, place).map(list),
            "rotation": st.floats(-turn, turn),
        }
    )


def is_judged_sound(data):
    case = case_from_dict(data)
    hard = HardCase("random", "random motion", "", may_stop=True)
    with tempfile.TemporaryDirectory() as folder:
        ended = Ended(0, 0.0)
        with time_limit(200.0):  # nothing but the end of a path may be raised
            try:
                run(case, Path(folder), quiet=True)
            except PathError as error:
                ended = Ended(3, 0.0, str(error))
        found = read_evidence(case, ended, Path(folder))
    verdict = judge(hard, found)
    assert verdict.passed, (verdict, ended.message)


@pytest.mark.slow
@RANDOM
@given(
    bottom=motions(0.01, 40.0), top=motions(0.06, 60.0), hold=st.sampled_from(["position", "clamp"])
)
def test_a_sheet_between_grips_that_move_at_random(bottom, top, hold):
    grips = {"bottom": {**bottom, "hold": hold}, "top": top}
    is_judged_sound(
        merged(
            COARSE,
            {
                "grips": grips,
                "discretisation": {"scheme": "hinge", "degree": 2},
                "output": OUTPUT,
            },
        )
    )


@pytest.mark.slow
@RANDOM
@given(bottom=motions(0.01, 40.0), top=motions(0.06, 60.0))
def test_a_lattice_between_grips_that_move_at_random(bottom, top):
    changes = {
        "kind": "lattice",
        "mesh": None,
        "lattice": {"spacing": 0.0096},
        "grips": {"bottom": bottom, "top": top},
        "output": OUTPUT,
    }
    is_judged_sound(merged(COARSE, changes))


@pytest.mark.slow
@RANDOM
@given(left=motions(0.2, 180.0), right=motions(0.6, 180.0))
def test_a_beam_between_clamps_that_move_at_random(left, right):
    is_judged_sound(
        {
            "name": "random",
            "kind": "beam",
            "beam": {"length": 1.0},
            "material": {"stretch": 4.05e8, "bending": 7.59e5},
            "ends": {
                "left": {"support": "clamped", **left},
                "right": {"support": "clamped", **right},
            },
            "mesh": {"size": 0.05},
            "output": OUTPUT,
        }
    )
