"""Tangents of the hinge scheme extrapolate stresses: what that changes, and what it is for."""

from pathlib import Path

import numpy as np
import pytest

from pantograph_fem.case import load_case
from pantograph_fem.running import run
from pantograph_fem.solve.origin import Origin

ARC = Path(__file__).parents[1] / "cases" / "beam_arc.toml"


def tangent(equilibrium, x, origin=None):
    A = equilibrium.matrix()
    equilibrium.tangent(x, 0.0, A, origin)
    return A


@pytest.mark.parametrize("hold", ["position", "clamp"])
def test_extrapolated_stresses_are_those_of_the_state_to_second_order(coarse_path, hold):
    simulation, steps = coarse_path(
        stops=(0.1,),
        grips={end: {"hold": hold} for end in ("top", "bottom")},
        discretisation={"scheme": "hinge", "degree": 2},
    )
    equilibrium = simulation.equilibrium
    direction = np.random.default_rng(3).standard_normal(steps[0].x.shape) * 1e-3
    direction[equilibrium._owned_dofs] = 0.0
    differences = []
    for size in (1e-2, 1e-3):
        origin = Origin(steps[-1].x, size * direction)
        x = origin.x + origin.step
        D = tangent(equilibrium, x, origin)
        D.axpy(-1.0, tangent(equilibrium, x))
        differences.append(D.norm())
    assert differences[1] > 0.0
    assert np.log10(differences[0] / differences[1]) == pytest.approx(2.0, abs=0.1)


def test_a_state_is_its_own_origin(coarse_path):
    simulation, steps = coarse_path(discretisation={"scheme": "hinge", "degree": 2})
    x = steps[-1].x
    D = tangent(simulation.equilibrium, x, Origin(x, np.zeros_like(x)))
    exact = tangent(simulation.equilibrium, x)
    D.axpy(-1.0, exact)
    assert D.norm() <= 1e-12 * exact.norm()


def test_finer_elements_take_no_more_tangents(tmp_path):
    counts = []
    for size in (1 / 16, 1 / 128):
        overrides = ("discretisation.scheme=hinge", f"mesh.size={size}", "output.figures=false")
        rows = run(load_case(ARC, overrides), tmp_path / str(size), quiet=True).rows
        counts.append(sum(row.newton_iterations for row in rows) + len(rows))
    assert counts[1] < 2 * counts[0], counts
