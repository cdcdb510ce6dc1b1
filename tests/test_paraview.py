"""What ParaView finds in the files of runs: by VTK's own reader, which ParaView has too."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista
from pyvista import CellType

from pantograph_fem.case import case_from_dict
from pantograph_fem.results.fields import FieldGrid, read_fields
from pantograph_fem.results.fields_writer import FieldsWriter
from pantograph_fem.results.history import read_history
from pantograph_fem.running import run

from .conftest import COARSE, merged

STOPS = [0.1 + 0.2, 1.0]
TRANSLATION, ANGLE = np.array([0.01, 0.02]), np.radians(25.0)
GRIPS = {"top": {"translation": TRANSLATION.tolist(), "rotation": 25.0}}
SHEET = merged(COARSE, {"discretisation": {"degree": 2}, "grips": GRIPS})
LATTICE = merged(
    COARSE, {"kind": "lattice", "mesh": None, "lattice": {"spacing": 0.0192}, "grips": GRIPS}
)
#: A column that loses its stability on its way, at a load that is no stop.
BEAM: dict[str, Any] = {
    "kind": "beam",
    "beam": {"length": 1.0},
    "material": {"stretch": 1e5, "bending": 1e3, "foundation": 10.0},
    "ends": {"right": {"support": "free", "force": [-3e3, 0.0]}},
    "mesh": {"size": 0.25},
}
CHAIN = merged(BEAM, {"kind": "chain", "mesh": None, "chain": {"spacing": 0.1}})
COMMON = {"continuation": {"stops": STOPS}, "output": {"figures": False}}

ENERGY = {"energy_density", "energy_density_stretch", "energy_density_bending"}
SHEAR = {"shear_angle", "energy_density_shear"}
LINE = {"angle", "curvature", "energy_density_foundation"}


@dataclass(frozen=True)
class Kind:
    """A case, the scalars that its files have on nodes and on cells, and VTK's cells of it."""

    case: dict[str, Any]
    scalars: set[str]
    cell_scalars: set[str]
    cell: CellType


FAMILIES = {"stretch_1", "stretch_2", "curvature_1", "curvature_2"}
KINDS = {
    "sheet": Kind(SHEET, ENERGY | SHEAR | FAMILIES, set(), CellType.TRIANGLE),
    "lattice": Kind(LATTICE, ENERGY | SHEAR, {"stretch"}, CellType.POLY_LINE),
    "beam": Kind(
        BEAM,
        ENERGY | LINE | {"stretch", "axial_force", "bending_moment"},
        set(),
        CellType.POLY_LINE,
    ),
    "chain": Kind(CHAIN, ENERGY | LINE, {"stretch"}, CellType.POLY_LINE),
}


@pytest.fixture(scope="module")
def directories(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Results of a run of each kind."""
    return {
        name: run(
            case_from_dict(merged(kind.case, {"name": name, **COMMON})),
            tmp_path_factory.mktemp(name),
            quiet=True,
        ).directory
        for name, kind in KINDS.items()
    }


def states(directory: Path) -> Iterator[tuple[float, pyvista.UnstructuredGrid]]:
    """Each time that the reader offers, with what it reads there."""
    reader = pyvista.get_reader(directory / "fields.xdmf")
    for time in reader.time_values:
        reader.set_active_time_value(time)
        yield time, reader.read()


@pytest.mark.parametrize("name", KINDS)
def test_the_time_is_the_load_of_each_step(directories: dict[str, Path], name: str) -> None:
    times = [time for time, _ in states(directories[name])]
    loads = read_history(directories[name] / "history.csv")["load"].tolist()
    assert times == loads
    assert set(STOPS) < set(times)


@pytest.mark.parametrize("name", KINDS)
def test_fields_have_their_names_and_components(directories: dict[str, Path], name: str) -> None:
    kind = KINDS[name]
    for _, mesh in states(directories[name]):
        assert mesh.n_cells > 0
        assert set(mesh.celltypes) == {kind.cell}
        assert set(mesh.point_data) - {"mode"} == {"displacement", *kind.scalars}
        assert set(mesh.cell_data) == kind.cell_scalars
        for field, values in mesh.point_data.items():
            vector = field in ("displacement", "mode")
            assert values.shape == ((mesh.n_points, 3) if vector else (mesh.n_points,)), field
        for values in mesh.cell_data.values():
            assert values.shape == (mesh.n_cells,)


@pytest.mark.parametrize("name", KINDS)
def test_each_time_has_the_values_of_its_state(directories: dict[str, Path], name: str) -> None:
    series = read_fields(directories[name])
    for index, (_, mesh) in enumerate(states(directories[name])):
        np.testing.assert_array_equal(mesh.points[:, :2], series.grid.points)
        assert not mesh.points[:, 2].any()
        for field, values in series.fields(index).items():
            found = mesh.point_data[field]
            np.testing.assert_array_equal(found[:, :2] if values.ndim == 2 else found, values)
        for field, values in series.cell_fields(index).items():
            np.testing.assert_array_equal(mesh.cell_data[field], values)


@pytest.mark.parametrize("name", ["sheet", "lattice"])
def test_warped_by_displacement_the_top_edge_is_where_its_grip_is(
    directories: dict[str, Path], name: str
) -> None:
    height = COARSE["sheet"]["height"]
    for load, mesh in states(directories[name]):
        warped = mesh.warp_by_vector("displacement", factor=1.0)
        top = np.isclose(mesh.points[:, 1], height)
        assert top.sum() > 2
        along = mesh.points[top, 0] - 0.034
        turned = np.outer(along, [np.cos(load * ANGLE), np.sin(load * ANGLE)])
        expected = [0.034, height] + turned + load * TRANSLATION
        # VTK moves points in single precision.
        np.testing.assert_allclose(warped.points[top, :2], expected, atol=1e-7)
        assert not warped.points[:, 2].any()


@pytest.mark.parametrize("name", ["beam", "chain"])
def test_the_mode_is_there_where_stability_is_lost(directories: dict[str, Path], name: str) -> None:
    with_mode = [
        (load, mesh) for load, mesh in states(directories[name]) if "mode" in mesh.array_names
    ]
    ((critical, mesh),) = with_mode
    history = read_history(directories[name] / "history.csv")
    assert critical == history["load"][history["stable"] == 1].max()
    # It bends sidewise, most at the free end.
    across = np.abs(mesh["mode"][:, 1])
    assert across.argmax() == mesh.points[:, 0].argmax()
    assert across.max() == pytest.approx(1.0)


def test_states_at_the_same_load_are_both_there(tmp_path: Path) -> None:
    """Of equal times the reader would show none: they differ next to nothing."""
    points, triangle = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), np.array([[0, 1, 2]])
    writer = FieldsWriter(tmp_path, FieldGrid(points, triangle))
    for load, value in ((0.0, 1.0), (2 / 3, 2.0), (2 / 3, 3.0), (1.0, 4.0)):
        writer.write(load, {"value": np.full(3, value)})
    found = [(time, mesh["value"][0]) for time, mesh in states(tmp_path)]
    assert [value for _, value in found] == [1.0, 2.0, 3.0, 4.0]
    assert found[2][0] == pytest.approx(2 / 3, rel=1e-11)
