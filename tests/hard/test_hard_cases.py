"""The quick ones of the hard cases, as `pantograph stress` runs and judges them."""

import pytest

from pantograph_fem.stress import run_suite, select
from pantograph_fem.stress.registry import HARD_CASES

QUICK = [hard.name for hard in HARD_CASES if hard.quick]


@pytest.mark.slow
@pytest.mark.parametrize("name", QUICK)
def test_quick_hard_case(tmp_path, name):
    results = run_suite(select([name]), tmp_path)
    failures = {result.hard.name: result.verdict.failures for result in results}
    assert not any(failures.values()), failures
