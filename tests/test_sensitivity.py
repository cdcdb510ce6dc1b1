"""Derivatives of an equilibrium with respect to the constants are those of the equilibria."""

import numpy as np
import pytest

from pantograph_fem.case import case_from_dict
from pantograph_fem.identify.parameters import Parameter
from pantograph_fem.identify.paths import Paths
from pantograph_fem.identify.problem import Experiment
from pantograph_fem.identify.responses import response_columns

from .conftest import COARSE, merged

#: Pulled, sheared and turned, so that nothing vanishes by symmetry.
SKEW = {
    "grips": {"top": {"translation": [0.01, 0.03], "rotation": 5.0}},
    "mesh": {"size": 0.03, "corner_size": 0.015},
    "measurements": {
        "psi": {"kind": "shear_angle", "point": [0.0136, 0.0204]},
        "b": {"kind": "elongation", "points": [[0.0, 0.0], [0.01, 0.01]]},
        "m": {"kind": "marker", "point": [0.02, 0.12]},
        "turn": {"kind": "angle", "lines": [[[0.0, 0.05], [0.06, 0.05]], [[0.0, 0.0], [0.0, 0.1]]]},
        "w": {"kind": "width", "height": 0.1},
    },
}
CONSTANTS = ("stretch", "bending", "shear", "shear_exponent")
LOADS = (0.5, 1.0)


def paths_of(constants=CONSTANTS, **changes):
    case = case_from_dict(merged(merged(COARSE, SKEW), changes))
    values = {name: getattr(case.material, name) for name in constants}
    parameters = tuple(Parameter(n, v, 1e-3 * v, 1e3 * v) for n, v in values.items())
    experiment = Experiment(case, parameters, response_columns(case), 0.03)
    return Paths(experiment.model_case, parameters, LOADS)


@pytest.fixture(
    scope="module",
    params=[
        {"discretisation": {"scheme": "micromorphic", "degree": 2}},
        {"discretisation": {"scheme": "hinge", "degree": 2}},
        {
            "discretisation": {"scheme": "hinge", "degree": 2},
            "grips": {"bottom": {"hold": "clamp"}, "top": {"hold": "clamp"}},
        },
    ],
    ids=["micromorphic", "hinge", "hinge with clamps"],
)
def paths(request):
    return paths_of(**request.param)


def error_of_the_slopes(paths, sabotage=1.0, step=1e-3):
    """Largest difference to central differences, relative to the largest of a column's slopes."""
    slopes = sabotage * paths.at(np.zeros(4)).slopes
    steps = step * np.eye(4)
    differences = np.stack(
        [(paths.at(h).values - paths.at(-h).values) / (2 * step) for h in steps], axis=-1
    )
    return (np.abs(slopes - differences) / np.abs(slopes).max(axis=(0, 2))[:, None]).max()


def test_slopes_agree_with_finite_differences(paths):
    assert error_of_the_slopes(paths) < 1e-5


def test_finite_differences_would_tell_slopes_that_are_off_by_a_hundredth_of_a_per_cent(paths):
    assert error_of_the_slopes(paths, sabotage=1.0001) > 5e-5


@pytest.mark.parametrize(("sabotage", "order"), [(1.0, 2.0), (1.01, 1.0)])
def test_the_prediction_of_a_state_misses_it_to_second_order(paths, sabotage, order):
    here, direction = paths.at(np.zeros(4)), np.array([1.0, -0.7, 0.5, 0.8])
    sizes = paths.simulation.equilibrium.typical_sizes

    def miss(h):
        there = paths.at(h * direction)
        step = sabotage * h * np.tensordot(direction, here.rates, (0, 1))
        return np.linalg.norm((there.states - here.states - step) / sizes)

    assert np.log2(miss(2e-3) / miss(1e-3)) == pytest.approx(order, abs=0.15)


def test_a_stiffness_common_to_all_changes_no_shape_and_scales_the_force():
    """Constants times c: the same shape, force times c."""
    paths = paths_of(constants=CONSTANTS[:3], discretisation={"scheme": "hinge", "degree": 2})
    here = paths.at(np.zeros(3))
    together = here.slopes.sum(axis=2)
    np.testing.assert_allclose(together[:, :2], here.values[:, :2], rtol=1e-7)
    np.testing.assert_allclose(together[:, 2:], 0.0, atol=1e-8)


def test_a_path_is_the_same_from_a_neighbour_as_from_rest():
    options = {"discretisation": {"scheme": "hinge", "degree": 2}}
    warm, cold = paths_of(**options), paths_of(**options)
    q = np.array([0.4, -0.5, 0.3, 0.2])
    warm.at(np.zeros(4))
    np.testing.assert_allclose(warm.at(q).values, cold.at(q).values, rtol=1e-8, atol=1e-10)
    assert (warm.cost.from_rest, warm.cost.paths) == (1, 2)
