"""Figures of lattices, beams and chains: what is drawn, and the files it becomes."""

from __future__ import annotations

import pickle
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize, to_rgba
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image

from pantograph_fem.results.axis import Axis, state_colours
from pantograph_fem.results.colours import node_weights
from pantograph_fem.results.deformed_figure import Colouring
from pantograph_fem.results.draw import draw_all
from pantograph_fem.results.end_panels import EndLoading, end_panels
from pantograph_fem.results.fields import FieldGrid, read_fields
from pantograph_fem.results.fields_writer import FieldsWriter
from pantograph_fem.results.history import HistoryRow, HistoryWriter
from pantograph_fem.results.lattice_picture import paint_links
from pantograph_fem.results.profiles_figure import draw_profiles
from pantograph_fem.results.shapes_figure import draw_shapes
from pantograph_fem.results.units import power_of_ten, prefixed

Array = NDArray[np.float64]
LENGTH = 2.0
TIP = ("tip_ux", "tip_uy", "tip_angle")


@pytest.fixture
def saved(monkeypatch: pytest.MonkeyPatch) -> list[Figure]:
    """Figures that are drawn while the test runs."""
    figures: list[Figure] = []
    save = Figure.savefig

    def keep(figure: Figure, *args: Any, **options: Any) -> None:
        figures.append(figure)
        save(figure, *args, **options)

    monkeypatch.setattr(Figure, "savefig", keep)
    return figures


def lattice() -> FieldGrid:
    """Two squares of 10 mm side by side, with links along the sides."""
    points = 0.01 * np.array([[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]])
    return FieldGrid(points, np.array([[0, 1], [1, 2], [3, 4], [4, 5], [0, 3], [1, 4], [2, 5]]))


def test_weight_of_a_node_is_half_the_lengths_of_its_links() -> None:
    np.testing.assert_allclose(node_weights(lattice()), 0.005 * np.array([2, 3, 2, 2, 3, 2]))


@pytest.mark.parametrize(("scale", "pivots"), [(72 * 6 / 0.02, True), (200.0, False)])
def test_links_are_where_their_ends_are_with_the_mean_of_their_values(
    scale: float, pivots: bool
) -> None:
    grid = lattice()
    displacement = grid.points @ np.array([[0.5, 0.0], [0.2, 0.1]])
    values = np.arange(6.0)
    axes = Figure().add_subplot()
    colouring = Colouring(values, colormaps["viridis"], Normalize(0.0, 5.0))
    links = paint_links(axes, grid, displacement, colouring, scale)
    assert isinstance(links, LineCollection)
    deformed = 1e3 * (grid.points + displacement)
    np.testing.assert_allclose(links.get_segments(), deformed[grid.cells])
    np.testing.assert_allclose(links.get_array(), [0.5, 1.5, 3.5, 4.5, 1.5, 2.5, 3.5])
    assert [len(line.get_xdata()) for line in axes.lines] == ([6] if pivots else [])
    (box,) = axes.collections[0].get_segments()
    np.testing.assert_allclose([box.min(axis=0), box.max(axis=0)], [[0, 0], [20, 10]])


def test_units_keep_numbers_short() -> None:
    assert prefixed(9.3e6, "N") == (1e-6, "MN")
    assert prefixed(-1.0, "m") == (1.0, "m")
    assert prefixed(0.2, "m") == (1e3, "mm")
    assert prefixed(0.0, "N m") == (1.0, "N m")
    assert power_of_ten(0.5) == (1.0, "")
    factor, power = power_of_ten(-2.5e-5)
    assert (round(-2.5e-5 * factor, 12), power) == (-25.0, "10⁻⁶")


def history(**columns: list[float]) -> dict[str, Array]:
    return {name: np.array(values) for name, values in columns.items()}


RUN = history(
    load=[0.0, 0.5, 1.0],
    force_x=[0.0, 3e3, 6e3],
    force_y=[0.0, 4e3, -8e3],
    moment=[0.0, 7.0, 9.0],
    tip_ux=[0.0, 0.0, 0.0],
    tip_uy=[0.0, -0.1, -0.3],
    tip_angle=[0.0, -0.1, -np.pi / 6],
)


def test_translated_end_shows_the_force_along_its_way() -> None:
    (panel,) = end_panels(RUN, EndLoading(translation=(0.0, -0.2), clamped=True))
    assert (panel.xlabel, panel.ylabel) == (
        "end displacement (mm)",
        "force along the translation (kN)",
    )
    np.testing.assert_allclose(panel.x, [0.0, 100.0, 200.0])
    np.testing.assert_allclose(panel.curves["along the translation"], [0.0, -4.0, 8.0])


def test_turned_end_shows_the_force_against_the_angle_and_a_clamp_its_moment() -> None:
    (force,) = end_panels(RUN, EndLoading(rotation=180.0))
    assert (force.xlabel, force.ylabel) == ("angle travelled (degrees)", "force (kN)")
    np.testing.assert_allclose(force.x, [0.0, 90.0, 180.0])
    np.testing.assert_allclose(force.curves["in x"], [0.0, 3.0, 6.0])
    np.testing.assert_allclose(force.curves["in y"], [0.0, 4.0, -8.0])
    _, moment = end_panels(RUN, EndLoading(rotation=180.0, clamped=True))
    np.testing.assert_allclose(moment.curves["moment"], RUN["moment"])
    both, _ = end_panels(RUN, EndLoading((0.1, 0.0), rotation=-30.0, clamped=True))
    np.testing.assert_allclose(both.curves["across, to its left"], [0.0, 4.0, -8.0])


def test_loaded_end_shows_the_load_against_how_it_gives_way() -> None:
    (along,) = end_panels(RUN, EndLoading(force=(0.0, -3e3)))
    assert (along.xlabel, along.ylabel) == (
        "end displacement along the force (mm)",
        "force (kN)",
    )
    np.testing.assert_allclose(along.x, [0.0, 100.0, 300.0])
    np.testing.assert_allclose(along.curves["force"], [0.0, 1.5, 3.0])
    # Pushed along its axis, it gives way to the side.
    along, across = end_panels(RUN, EndLoading(force=(-5.0, 0.0)))
    np.testing.assert_allclose(along.x, 0.0)
    np.testing.assert_allclose(across.x, [0.0, 100.0, 300.0])
    assert across.xlabel == "end displacement across it, to its left (mm)"
    (moment,) = end_panels(RUN, EndLoading(moment=-2.0))
    np.testing.assert_allclose(moment.x[-1], -30.0)
    np.testing.assert_allclose(moment.curves["moment"], [0.0, -1.0, -2.0])


def test_end_that_neither_moves_nor_is_loaded_has_its_reaction() -> None:
    (panel,) = end_panels(RUN, EndLoading())
    np.testing.assert_allclose(panel.curves["force"], [0.0, 5.0, 10.0])
    assert panel.ylabel == "magnitude of force (kN)"


def axis_run(
    directory: Path, number: int, loads: list[float], links: bool
) -> tuple[FieldGrid, Array]:
    """An axis bent to arcs of growing angle, its nodes numbered out of order; its abscissa too."""
    S = np.linspace(0.0, LENGTH, number + 1)
    order = np.random.default_rng(0).permutation(number + 1)
    number_of = np.argsort(order)
    grid = FieldGrid(
        np.column_stack([S, 0 * S])[order],
        np.column_stack([number_of[:-1], number_of[1:]])[::-1].copy(),
    )
    fields = FieldsWriter(directory, grid)
    with HistoryWriter(directory / "history.csv", probes=0, extra_columns=TIP) as table:
        for step, load in enumerate(loads):
            kappa = 4.0 * load / LENGTH
            phi, r = kappa * S, 1 / kappa if kappa else 0.0
            bent = np.column_stack([r * np.sin(phi), r * (1 - np.cos(phi))])
            u = bent - np.column_stack([S, 0 * S]) if load else np.zeros((number + 1, 2))
            wrapped = np.arctan2(np.sin(phi), np.cos(phi))
            nodal = {"displacement": u[order], "angle": wrapped[order]}
            stretch = {"stretch": 1 + 1e-4 * load * np.arange(number)[::-1]}
            if links:
                fields.write(load, nodal, stretch)
            else:
                fields.write(load, nodal | {"curvature": np.full(number + 1, kappa)})
            tip = dict(zip(TIP, (*u[-1], phi[-1]), strict=True))
            table.write(
                HistoryRow(step, load, (load, 0.0), 0.0, {}, 3, 0, 0, True, 0.0, 0.0, extra=tip)
            )
    return grid, S


def curves(axes: Axes, colour: Any) -> list[Array]:
    """Data of the solid curves in a colour, but for dots."""
    return [
        line.get_xydata()
        for line in axes.lines
        if to_rgba(line.get_color()) == to_rgba(colour) and len(line.get_xdata()) > 1
    ]


def test_axis_runs_from_left_to_right_however_nodes_are_numbered(tmp_path: Path) -> None:
    grid, S = axis_run(tmp_path, 8, [0.0], links=True)
    axis = Axis.of(grid)
    np.testing.assert_allclose(axis.nodal_abscissa, S)
    np.testing.assert_allclose(axis.cell_abscissa, (S[1:] + S[:-1]) / 2)
    np.testing.assert_allclose(grid.points[axis.nodes, 0], S)
    assert axis.length == LENGTH


def test_shapes_are_true_and_the_end_leaves_its_path(tmp_path: Path, saved: list[Figure]) -> None:
    loads = [0.0, 0.25, 0.5, 0.75, 1.0]
    _, S = axis_run(tmp_path, 40, loads, links=True)
    draw_shapes(read_fields(tmp_path), [2, 4], tmp_path / "shapes.png", "Cantilever")
    axes = saved[0].axes[0]
    assert axes.get_aspect() == 1.0
    assert axes.get_xlabel() == "x (m)"
    for load, colour in zip([0.5, 1.0], state_colours(2), strict=True):
        (shape,) = curves(axes, colour)
        kappa = 4.0 * load / LENGTH
        np.testing.assert_allclose(shape[:, 0], np.sin(kappa * S) / kappa, atol=1e-12)
        np.testing.assert_allclose(shape[:, 1], (1 - np.cos(kappa * S)) / kappa, atol=1e-12)
    (path,) = (line.get_xydata() for line in axes.lines if line.get_linestyle() == ":")
    assert len(path) == len(loads)
    np.testing.assert_allclose(path[0], [LENGTH, 0.0], atol=1e-12)
    np.testing.assert_allclose(path[-1], shape[-1])
    (reference,) = curves(axes, "0.7")
    np.testing.assert_allclose(reference[:, 0], S)


def panels(figure: Figure) -> dict[str, Axes]:
    return {axes.get_ylabel(): axes for axes in figure.axes if axes.get_ylabel()}


def test_profiles_are_of_the_fields_there_are(tmp_path: Path, saved: list[Figure]) -> None:
    _, S = axis_run(tmp_path, 40, [0.0, 0.5, 1.0], links=True)
    draw_profiles(read_fields(tmp_path), [1, 2], tmp_path / "profiles.png")
    found = panels(saved[0])
    assert list(found) == ["stretch − 1 (10⁻³)", "angle (degrees)"]
    last = state_colours(2)[1]
    (stretch,) = curves(found["stretch − 1 (10⁻³)"], last)
    np.testing.assert_allclose(stretch[:, 0], (S[1:] + S[:-1]) / 2)  # in the middles of links
    np.testing.assert_allclose(stretch[:, 1], 0.1 * np.arange(40), atol=1e-9)
    (angle,) = curves(found["angle (degrees)"], last)
    np.testing.assert_allclose(angle[:, 0], S)
    np.testing.assert_allclose(angle[:, 1], np.degrees(4 * S / LENGTH))  # beyond 180 degrees


def test_profile_that_is_rounding_is_drawn_as_nothing(tmp_path: Path, saved: list[Figure]) -> None:
    grid = axis_run(tmp_path, 5, [0.0], links=False)[0]
    writer = FieldsWriter(tmp_path, grid)
    noise = 1 + 1e-14 * np.arange(6)
    writer.write(1.0, {"displacement": np.zeros((6, 2)), "stretch": noise})
    draw_profiles(read_fields(tmp_path), [0], tmp_path / "profiles.png")
    assert panels(saved[0])["stretch − 1"].get_ylim() == (-1.0, 1.0)


def case(kind: str, **sections: Any) -> Any:
    still = {"translation": (0.0, 0.0), "rotation": 0.0, "force": (0.0, 0.0), "moment": 0.0}
    grip = SimpleNamespace(**still)
    moved = SimpleNamespace(**still | {"translation": (0.0, 0.01)})
    return SimpleNamespace(
        kind=kind,
        name="a",
        title="",
        continuation=SimpleNamespace(stops=(0.5, 1.0)),
        grips=SimpleNamespace(bottom=grip, top=moved),
        ends=SimpleNamespace(
            left=SimpleNamespace(support="clamped", **still),
            right=SimpleNamespace(support="free", **still | {"moment": 5.0}),
        ),
    )


@pytest.mark.parametrize("kind", ["beam", "chain"])
def test_figures_of_a_beam_replace_those_of_a_sheet(tmp_path: Path, kind: str) -> None:
    axis_run(tmp_path, 100, [0.0, 0.5, 0.8], links=kind == "chain")
    (tmp_path / "figures").mkdir()
    for name in ("shear_angle_100.png", "energy_density_050.png", "mine.png"):
        (tmp_path / "figures" / name).touch()
    files = draw_all(tmp_path, case(kind))
    assert [path.name for path in files] == [
        "force_displacement.png",
        "profiles.png",
        "shapes.png",
    ]
    assert {path.name for path in (tmp_path / "figures").iterdir()} == {
        "mine.png",
        *(path.name for path in files),
    }
    for path in files:
        assert np.ptp(np.asarray(Image.open(path).convert("L"))) > 200


def test_figures_of_a_lattice_are_named_as_those_of_a_sheet(
    tmp_path: Path, saved: list[Figure]
) -> None:
    grid = lattice()
    fields = FieldsWriter(tmp_path, grid)
    with HistoryWriter(tmp_path / "history.csv", probes=0) as table:
        for step, load in enumerate([0.0, 0.5, 1.0]):
            u = load * 0.3 * grid.points
            x, y = grid.points.T
            fields.write(load, {"displacement": u, "shear_angle": load * y, "energy_density": x})
            table.write(HistoryRow(step, load, (0, load), 0.0, {}, 3, 0, 0, True, 0.0, 0.0))
    files = draw_all(tmp_path, case("lattice"))
    assert [path.name for path in files] == [
        "energy_density_050.png",
        "energy_density_100.png",
        "force_displacement.png",
        "shear_angle_050.png",
        "shear_angle_100.png",
    ]
    # The force curve, then pictures with a bar beside them.
    assert [len(figure.axes) for figure in saved] == [1, 2, 2, 2, 2]
    x = saved[1].axes[0].get_xlim()
    assert x[0] < 0.0
    assert 20.0 < x[1] < 30.0


def test_only_the_drawing_of_the_kind_is_imported(tmp_path: Path) -> None:
    axis_run(tmp_path, 4, [0.0, 1.0], links=False)
    code = (
        "import pickle, sys, pathlib; from pantograph_fem.results.draw import draw_all\n"
        "draw_all(pathlib.Path(sys.argv[1]), pickle.load(sys.stdin.buffer))\n"
        "print(*sys.modules)"
    )
    run = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path)],
        input=pickle.dumps(case("beam")),
        capture_output=True,
        check=True,
    )
    imported = run.stdout.decode().split()
    assert "pantograph_fem.results.shapes_figure" in imported
    assert "pantograph_fem.results.deformed_figure" not in imported
    assert "dolfinx" not in imported
