"""Fields on disk: what other programs read, and what survives a run that is killed."""

from __future__ import annotations

import io
from pathlib import Path

import h5py
import meshio
import numpy as np
import pytest
import pyvista
from numpy.typing import NDArray

from pantograph_fem.errors import CaseError
from pantograph_fem.results.fields import FieldGrid, read_fields
from pantograph_fem.results.fields_writer import FieldsWriter, append_step

LOADS = (0.0, 0.1 + 0.2, 1.0)


def sheet() -> FieldGrid:
    """Three by two squares of 0.1 m, each cut in two."""
    x, y = np.meshgrid(0.1 * np.arange(4), 0.1 * np.arange(3), indexing="ij")
    node = np.arange(12).reshape(4, 3)
    a, b, c, d = node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]
    lower, upper = np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)
    triangles = np.concatenate([lower.reshape(-1, 3), upper.reshape(-1, 3)])
    return FieldGrid(np.column_stack([x.ravel(), y.ravel()]), triangles)


def state(grid: FieldGrid, load: float) -> dict[str, NDArray[np.float64]]:
    x, y = grid.points.T
    return {
        "displacement": load * np.column_stack([0.3 * y, np.sin(x)]),
        "shear_angle": load * x * y - 0.1,
        "energy_density": np.exp(load + x / 3),
    }


def written(directory: Path) -> tuple[FieldGrid, FieldsWriter]:
    grid = sheet()
    writer = FieldsWriter(directory, grid)
    for load in LOADS:
        writer.write(load, state(grid, load))
    return grid, writer


def test_states_read_back_exactly(tmp_path: Path) -> None:
    grid, _ = written(tmp_path)
    series = read_fields(tmp_path)
    assert series.loads.tolist() == list(LOADS)
    np.testing.assert_array_equal(series.grid.points, grid.points)
    np.testing.assert_array_equal(series.grid.cells, grid.cells)
    for i, load in enumerate(LOADS):
        fields = series.fields(i)
        assert fields.keys() == state(grid, load).keys()
        for name, values in state(grid, load).items():
            np.testing.assert_array_equal(fields[name], values)


def test_meshio_reads_states_on_one_grid(tmp_path: Path) -> None:
    grid, _ = written(tmp_path)
    with meshio.xdmf.TimeSeriesReader(tmp_path / "fields.xdmf") as reader:
        points, cells = reader.read_points_cells()
        np.testing.assert_array_equal(points[:, :2], grid.points)
        np.testing.assert_array_equal(cells[0].data, grid.cells)
        assert reader.num_steps == len(LOADS)
        for i, load in enumerate(LOADS):
            time, data, _ = reader.read_data(i)
            expected = state(grid, load)
            assert time == load
            assert data["displacement"].shape == (12, 3)
            np.testing.assert_array_equal(data["displacement"][:, :2], expected["displacement"])
            np.testing.assert_array_equal(data["energy_density"], expected["energy_density"])


def test_paraview_reader_warps_and_colours_the_same_grid(tmp_path: Path) -> None:
    grid, _ = written(tmp_path)
    reader = pyvista.get_reader(tmp_path / "fields.xdmf")
    assert reader.time_values == list(LOADS)
    reader.set_active_time_value(1.0)
    mesh = reader.read()
    expected = state(grid, 1.0)
    assert set(mesh.point_data) == set(expected)
    assert mesh.n_cells == len(grid.cells)
    warped = mesh.warp_by_vector("displacement")
    deformed = grid.points + expected["displacement"]
    np.testing.assert_allclose(warped.points[:, :2], deformed, rtol=1e-6)
    np.testing.assert_array_equal(warped["shear_angle"], expected["shear_angle"])


def chain() -> FieldGrid:
    """A closed ring of four links: as many nodes as links."""
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    return FieldGrid(points, np.array([[0, 1], [1, 2], [2, 3], [3, 0]]))


RING = {"displacement": np.full((4, 2), 0.5), "angle": np.arange(4.0)}
LINKS = {"stretch": np.array([1.1, 1.2, 1.3, 1.4]), "force": np.arange(8.0).reshape(4, 2)}


def written_chain(directory: Path) -> FieldGrid:
    writer = FieldsWriter(directory, chain())
    writer.write(0.0, RING)
    writer.write(1.0, RING, LINKS)
    return chain()


def test_fields_of_lines_and_of_their_nodes_are_kept_apart(tmp_path: Path) -> None:
    grid = written_chain(tmp_path)
    FieldsWriter(tmp_path, grid, kept=2).write(2.0, RING, {"angle": LINKS["stretch"]})
    series = read_fields(tmp_path)
    np.testing.assert_array_equal(series.grid.cells, grid.cells)
    assert series.cell_fields(0) == {}
    for index, expected in ((1, LINKS), (2, {"angle": LINKS["stretch"]})):
        for found, given in ((series.fields(index), RING), (series.cell_fields(index), expected)):
            assert found.keys() == given.keys()
            for name, values in given.items():
                np.testing.assert_array_equal(found[name], values)


def test_meshio_reads_lines_with_their_fields(tmp_path: Path) -> None:
    grid = written_chain(tmp_path)
    with meshio.xdmf.TimeSeriesReader(tmp_path / "fields.xdmf") as reader:
        _, cells = reader.read_points_cells()
        assert [block.type for block in cells] == ["line"]
        np.testing.assert_array_equal(cells[0].data, grid.cells)
        _, nodal, of_cells = reader.read_data(1)
    assert nodal.keys() == RING.keys()
    np.testing.assert_array_equal(nodal["angle"], RING["angle"])
    np.testing.assert_array_equal(of_cells["stretch"][0], LINKS["stretch"])


def test_paraview_reader_finds_lines_with_their_fields(tmp_path: Path) -> None:
    grid = written_chain(tmp_path)
    reader = pyvista.get_reader(tmp_path / "fields.xdmf")
    reader.set_active_time_value(1.0)
    mesh = reader.read()
    assert [mesh.get_cell(i).point_ids for i in range(mesh.n_cells)] == grid.cells.tolist()
    assert set(mesh.point_data) == set(RING)
    assert set(mesh.cell_data) == set(LINKS)
    np.testing.assert_array_equal(mesh.cell_data["stretch"], LINKS["stretch"])
    np.testing.assert_array_equal(mesh.point_data["angle"], RING["angle"])


def test_field_of_cells_has_a_value_for_each_cell(tmp_path: Path) -> None:
    grid = sheet()
    writer = FieldsWriter(tmp_path, FieldGrid(grid.points, grid.cells[:7]))
    with pytest.raises(ValueError, match=r"flux has shape \(12,\); allowed: \(7,\), \(7, 2\)"):
        writer.write(0.0, {}, {"flux": np.zeros(12)})


def test_each_step_is_readable_while_the_run_goes_on(tmp_path: Path) -> None:
    grid = sheet()
    writer = FieldsWriter(tmp_path, grid)
    for i, load in enumerate(LOADS):
        writer.write(load, state(grid, load))
        assert len(read_fields(tmp_path).loads) == i + 1
        mesh = pyvista.get_reader(tmp_path / "fields.xdmf").read()
        assert mesh.n_points == len(grid.points)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["fields.h5", "fields.xdmf"]


def test_mesh_is_stored_once(tmp_path: Path) -> None:
    written(tmp_path)
    with h5py.File(tmp_path / "fields.h5", "r") as file:
        assert set(file) == {"points", "cells", "steps"}
        assert all(set(step) == set(state(sheet(), 0.0)) for step in file["steps"].values())


def test_new_run_replaces_an_old_one(tmp_path: Path) -> None:
    grid, _ = written(tmp_path)
    writer = FieldsWriter(tmp_path, grid)
    with pytest.raises(CaseError, match=r"holds no results.*pantograph run"):
        read_fields(tmp_path)
    writer.write(0.5, state(grid, 0.5))
    assert read_fields(tmp_path).loads.tolist() == [0.5]


def test_continued_run_drops_later_states(tmp_path: Path) -> None:
    grid, _ = written(tmp_path)
    writer = FieldsWriter(tmp_path, grid, kept=2)
    assert read_fields(tmp_path).loads.tolist() == list(LOADS[:2])
    writer.write(0.7, state(grid, 0.7))
    series = read_fields(tmp_path)
    assert series.loads.tolist() == [*LOADS[:2], 0.7]
    for i, load in enumerate([*LOADS[:2], 0.7]):
        expected = state(grid, load)["energy_density"]
        np.testing.assert_array_equal(series.fields(i)["energy_density"], expected)
    with h5py.File(tmp_path / "fields.h5", "r") as file:
        assert len(file["steps"]) == 3


def test_a_grid_in_another_order_is_continued_in_that_of_the_first(tmp_path: Path) -> None:
    grid, _ = written(tmp_path)
    rng = np.random.default_rng(0)
    order = rng.permutation(len(grid.points))  # of its nodes
    numbers = np.argsort(order)
    shuffled = FieldGrid(grid.points[order], rng.permutation(numbers[grid.cells]))
    FieldsWriter(tmp_path, shuffled, kept=1).write(0.7, state(shuffled, 0.7))
    series = read_fields(tmp_path)
    np.testing.assert_array_equal(series.grid.points, grid.points)
    np.testing.assert_array_equal(series.grid.cells, grid.cells)
    for name, values in state(grid, 0.7).items():
        np.testing.assert_allclose(series.fields(1)[name], values, rtol=1e-14)


def test_run_on_another_mesh_is_not_continued(tmp_path: Path) -> None:
    grid, _ = written(tmp_path)
    with pytest.raises(CaseError, match="3 states; 4"):
        FieldsWriter(tmp_path, grid, kept=4)
    with pytest.raises(CaseError, match="another mesh"):
        FieldsWriter(tmp_path, FieldGrid(1.01 * grid.points, grid.cells), kept=1)


def test_field_of_wrong_size_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    _, writer = written(tmp_path)
    with pytest.raises(ValueError, match=r"shear_angle has shape \(11,\)"):
        writer.write(2.0, {"shear_angle": np.zeros(11)})
    assert len(read_fields(tmp_path).loads) == len(LOADS)


@pytest.mark.parametrize(
    "content", ["", "<Xdmf/>", "<Xdmf><Domain><Grid><Grid/></Grid></Domain></Xdmf>"]
)
def test_damaged_index_is_explained(tmp_path: Path, content: str) -> None:
    written(tmp_path)
    (tmp_path / "fields.xdmf").write_text(content)
    with pytest.raises(CaseError, match=r"fields\.xdmf with fields\.h5 cannot be read"):
        read_fields(tmp_path)


class RecordedFile(io.BytesIO):
    """A file in memory that remembers what was done to it, in order."""

    def __init__(self, content: bytes = b"") -> None:
        super().__init__(content)
        self.log: list[tuple[int, bytes | None]] = []

    def write(self, data) -> int:  # type: ignore[no-untyped-def,override]
        self.log.append((self.tell(), bytes(data)))
        return super().write(data)

    def truncate(self, size: int | None = None) -> int:
        end = self.tell() if size is None else size
        self.log.append((end, None))
        if end > len(self.getbuffer()):  # BytesIO only shortens
            position = self.seek(0, io.SEEK_END)
            super().write(bytes(end - position))
            return end
        return super().truncate(end)


def test_steps_survive_a_kill_between_any_two_writes_of_the_next() -> None:
    arrays = {name: np.arange(5.0) for name in "abc"}
    content = RecordedFile()
    with h5py.File(content, "w") as file:
        file.create_group("steps")
    for step in range(12):
        partial, recorded = RecordedFile(content.getvalue()), RecordedFile(content.getvalue())
        with h5py.File(recorded, "r+") as file:
            append_step(file, step, {name: values + step for name, values in arrays.items()})
        assert len(recorded.log) > 3
        for position, data in recorded.log:
            partial.seek(position)
            partial.truncate(position) if data is None else partial.write(data)
            with h5py.File(io.BytesIO(partial.getvalue()), "r") as file:
                for earlier in range(step):
                    for name, values in arrays.items():
                        found = file[f"steps/{earlier:05d}/{name}"][()]
                        np.testing.assert_array_equal(found, values + earlier)
        content = recorded
