"""Tangents extrapolate stresses: what that changes, and what it is for."""

import json
from pathlib import Path

import numpy as np
import pytest

from pantograph_fem.case import load_case
from pantograph_fem.solve.origin import Origin

from .conftest import run
from .distributed import own_blocks, rough
from .processes import SEVERAL

pytestmark = pytest.mark.core

ARC = Path(__file__).parents[1] / "cases" / "beam_arc.toml"


def tangent(equilibrium, x, origin=None):
    A = equilibrium.matrix()
    equilibrium.tangent(x, 0.0, A, origin)
    return A


@pytest.mark.parametrize(
    ("scheme", "hold"), [("hinge", "position"), ("hinge", "clamp"), ("micromorphic", "position")]
)
def test_extrapolated_stresses_are_those_of_the_state_to_second_order(coarse_path, scheme, hold):
    simulation, steps = coarse_path(
        stops=(0.1,),
        grips={end: {"hold": hold} for end in ("top", "bottom")},
        discretisation={"scheme": scheme, "degree": 2},
    )
    equilibrium = simulation.equilibrium
    dofs, places = own_blocks(equilibrium, "displacement")
    direction = np.zeros_like(steps[0].x)
    direction[dofs] = 1e-3 * rough(places, 2, seed=3, wavelength=0.01)
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


@pytest.mark.parametrize("scheme", ["micromorphic", "hinge"])
def test_fibres_that_hardly_stretch_take_no_more_tangents(tmp_path, scheme):
    counts = []
    for stretch in (4.05e8, 4.05e12):  # the paper's, and one of K_e L²/K_b = 5e6
        overrides = (f"discretisation.scheme={scheme}", f"material.stretch={stretch}")
        case = load_case(ARC, (*overrides, "output.figures=false"))
        rows = run(case, tmp_path / str(stretch), quiet=True).rows
        counts.append(sum(row.newton_iterations for row in rows) + len(rows))
    assert counts[1] < 2 * counts[0], counts


@pytest.mark.skipif(SEVERAL, reason="long")
def test_tiny_elements_at_the_corners_shorten_no_step(coarse_case, tmp_path):
    """They are a million times as stiff as they are free to turn: predictions must fit exactly."""
    for growth in (0.5, 1.0):
        case = coarse_case(
            grips={"top": {"translation": [0.0, 0.01], "rotation": 20.0}},
            discretisation={"scheme": "hinge", "degree": 4},
            mesh={"size": 0.03, "corner_size": 5e-5, "growth": growth},
            output={"figures": False, "fields": "none"},
        )
        result = run(case, tmp_path / str(growth), quiet=True)
        summary = json.loads((result.directory / "summary.json").read_text())
        assert summary["cutbacks"] == 0
        assert sum(row.newton_iterations for row in result.rows) <= 3 * len(result.rows)
