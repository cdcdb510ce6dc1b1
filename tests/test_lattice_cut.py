"""Lattices cut from rectangles: what is kept, what is held, what it stands for."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pantograph_fem.case.lattice_spacing import fits, fitted_spacing
from pantograph_fem.errors import CaseError
from pantograph_fem.lattice.chain import chain
from pantograph_fem.lattice.cut import cut
from pantograph_fem.lattice.equilibrium import LatticeEquilibrium
from pantograph_fem.lattice.grid import cut_grid, directions
from pantograph_fem.lattice.tributary import clipped_area
from pantograph_fem.solve.newton import NewtonSolver

W, H = 0.068, 0.204
PAPER = {
    "stretch": (1.34e5, 1.34e5),
    "bending": (1.92e-2, 1.92e-2),
    "shear": 1.59e2,
    "exponent": 1.36,
}


def test_the_specimen_has_ten_by_thirty_periods():
    spacing = fitted_spacing(W, H, 45.0, 0.0048)
    assert spacing == pytest.approx(W / (10 * math.sqrt(2)), rel=1e-12)
    assert fits(W, H, 45.0, spacing)


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ((0.1, 0.3, 0.0, 0.011), 0.1 / 9),
        ((0.1, 0.3, -90.0, 0.011), 0.1 / 9),
        ((0.1, 0.3, 135.0, 0.1 / math.sqrt(2)), 0.1 / math.sqrt(2)),
        ((0.1, 0.31, 45.0, 0.011), 0.011),  # no common period
        ((0.1, 0.3, 30.0, 0.011), 0.011),
        ((0.1, 0.3, 45.0, 0.5), 0.5),  # larger than the rectangle
    ],
)
def test_a_spacing_is_changed_only_where_that_makes_it_fit(arguments, expected):
    assert fitted_spacing(*arguments) == pytest.approx(expected, rel=1e-12)


def test_a_fitting_lattice_has_the_constants_of_30():
    spacing = fitted_spacing(W, H, 45.0, 0.0048)
    net = cut(W, H, 45.0, spacing, pivots="literal", clamped=("bottom",), **PAPER)
    assert net.size == 11 * 31 + 10 * 30
    assert len(net.links) == 4 * 10 * 30
    for stiffness, constant in (
        (net.stiffness, 1.34e5),
        (net.turns.stiffness, 1.92e-2),
        (net.walls.stiffness, 2 * 1.92e-2),
        (net.pivots.stiffness, 1.59e2 * spacing**2),
    ):
        np.testing.assert_allclose(stiffness, constant, rtol=1e-9)
    for name, y in (("bottom", 0.0), ("top", H)):
        held = net.nodes[net.ends[name].nodes]
        np.testing.assert_allclose(held, [[i * W / 10, y] for i in range(11)], atol=1e-12)
        assert net.ends[name].centre == (W / 2, y)
    assert len(net.walls.links) == 20


def test_fibres_on_an_edge_have_half_the_constants():
    net = cut(0.04, 0.08, 0.0, 0.01, **PAPER)
    middles = net.nodes[net.links].mean(axis=1)
    on_edge = np.isclose(middles % [0.04, 0.08], 0.0, atol=1e-12).any(axis=1)
    np.testing.assert_allclose(net.stiffness, np.where(on_edge, 0.67e5, 1.34e5), rtol=1e-9)


def test_constants_of_one_family_go_to_its_links():
    net = cut(W, H, 30.0, 0.01, stretch=(1.0, 3.0), bending=(0.0, 2.0))
    span = np.diff(net.nodes[net.links], axis=1)[:, 0]
    D = directions(30.0)
    np.testing.assert_allclose(span, np.linalg.norm(span, axis=1)[:, None] * D[net.family])
    assert (net.stiffness[net.family == 1] >= 3.0 - 1e-9).all()
    assert (net.family[net.turns.links] == 1).all()


def test_a_fibre_that_ends_at_a_grip_is_held_by_a_shorter_and_stiffer_link():
    net = cut(0.04, 0.085, 0.0, 0.01, clamped=("bottom", "top"), **PAPER)
    length = np.linalg.norm(np.diff(net.nodes[net.links], axis=1)[:, 0], axis=1)
    short = length < 0.009
    gripped = np.isin(net.links, np.concatenate([end.nodes for end in net.ends.values()]))
    np.testing.assert_array_equal(short, gripped.any(axis=1))
    np.testing.assert_allclose(length[short], 0.0025, rtol=1e-9)
    strip = net.stiffness * length / 1.34e5
    np.testing.assert_allclose(
        net.walls.stiffness, 2 * 1.92e-2 * strip[net.walls.links] / 0.0025, rtol=1e-9
    )
    assert sorted(net.walls.links) == np.flatnonzero(short).tolist()


def test_a_node_right_below_a_grip_is_held_where_it_is():
    net = cut(0.04, 0.0806, 0.0, 0.01, **PAPER)  # 0.3 mm from the edges, less than 0.05 ε
    np.testing.assert_allclose(net.nodes[net.ends["bottom"].nodes, 1], 3e-4, rtol=1e-9)
    np.testing.assert_allclose(net.nodes[net.ends["top"].nodes, 1], 0.0803, rtol=1e-9)


@settings(deadline=None, max_examples=40)
@given(st.floats(-90.0, 90.0), st.floats(0.04, 0.5), st.sampled_from(["averaged", "literal"]))
def test_no_node_is_loose(fibre_angle, spacing, pivots):
    """At rest and held at its grips, any lattice resists every motion."""
    net = cut(W, H, fibre_angle, spacing * W, pivots=pivots, **PAPER)
    assert net.nodes.min() >= 0
    assert (net.nodes <= np.array([W, H]) + 1e-12).all()
    equilibrium = LatticeEquilibrium(net)
    newton = NewtonSolver(
        lambda x, r: equilibrium.residual(x, 0.0, r),
        lambda x, A, _: equilibrium.tangent(x, 0.0, A),
        equilibrium.matrix(),
        equilibrium.typical_sizes,
        equilibrium.typical_energy,
    )
    inertia = newton.factorise(equilibrium.undeformed()).inertia
    assert (inertia.negative, inertia.zero) == (0, 0)


@pytest.mark.parametrize("fibre_angle", [0.0, 45.0, -45.0, 90.0])
def test_averaged_pivots_stand_for_the_whole_sheet(fibre_angle):
    spacing = fitted_spacing(W, H, fibre_angle, 0.0068)
    net = cut(W, H, fibre_angle, spacing, shear=2.0)
    assert net.pivots.stiffness.sum() == pytest.approx(2.0 * W * H, rel=1e-9)


def test_a_corner_with_one_link_hands_its_part_of_the_sheet_to_its_neighbour():
    """At 45°: the quarter square goes to the first node inside, on top of its own whole one."""
    spacing = fitted_spacing(W, H, 45.0, 0.0068)
    net = cut(W, H, 45.0, spacing, shear=1.0)
    grid = cut_grid(W, H, 45.0, spacing)
    neighbour = np.argmin(np.hypot(*(grid.nodes - spacing / math.sqrt(2)).T))
    at_node = np.array([np.intersect1d(*grid.links[pair]) for pair in net.pivots.links]).ravel()
    share = net.pivots.stiffness[at_node == neighbour].sum()
    assert share == pytest.approx(1.25 * spacing**2, rel=1e-9)


@given(st.floats(0, 2 * math.pi), st.floats(0.1, 3.0), st.integers(0, 1000))
def test_clipped_areas_of_a_polygon_and_of_what_lies_beyond_are_its_area(angle, side, seed):
    """The plane around the rectangle in eight pieces, each found by clipping a shifted polygon."""
    x, y = np.random.default_rng(seed).uniform(-1, 3, 2)
    turns = angle + np.pi / 4 + np.pi / 2 * np.arange(4)
    polygon = np.column_stack([x + side * np.cos(turns), y + side * np.sin(turns)])
    far = 10.0
    pieces = [
        clipped_area(polygon + np.array([dx, dy]), w, h)
        for dx, w in ((far, far), (0.0, 2.0), (-2.0, far))
        for dy, h in ((far, far), (0.0, 1.0), (-1.0, far))
    ]
    assert sum(pieces) == pytest.approx(2 * side**2, rel=1e-9)


def test_a_spacing_that_leaves_nothing_between_the_grips_is_refused():
    with pytest.raises(CaseError, match=r"spacing of 0.3 m is too large for a lattice of 0.068 m"):
        cut(W, H, 45.0, 0.3, **PAPER)
    with pytest.raises(CaseError, match=r"spacing of 0.8 m is too large for a chain of 1 m"):
        chain(1.0, 0.8, stretch=1.0)
