"""What `output.elements` leaves: the displacement at the degree of the elements, read by VTK."""

import numpy as np
import pytest
import pyvista
from pyvista import CellType

from pantograph_fem import checkpoint
from pantograph_fem.case import case_from_dict
from pantograph_fem.errors import CaseError
from pantograph_fem.results.history import read_history
from pantograph_fem.running import run

from .conftest import COARSE, merged
from .test_resume import PowerCut
from .test_run_kinds import BEAM, CHAIN, LATTICE

PROBES = [[0.031, 0.1], [0.01, 0.01], [0.055, 0.19]]
SHEET = merged(
    COARSE,
    {
        "grips": {"top": {"translation": [0.01, 0.03], "rotation": 10.0}},
        "discretisation": {"scheme": "hinge"},
        "output": {"probes": PROBES, "elements": True, "figures": False},
    },
)


def with_elements(case):
    output = {"elements": True, "figures": False, "probes": []}
    return case_from_dict(merged(case, {"output": output}))


def displacement_at(grid, place):
    """What VTK finds there by the shape functions of its cell, and the cell's type."""
    dimension = 1 if grid.celltypes[0] == CellType.LAGRANGE_CURVE else 2
    for i in range(grid.n_cells):
        cell = grid.GetCell(i)
        nodes = [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())]
        corners = grid.points[nodes[: dimension + 1], :dimension]
        edges = (corners[1:] - corners[0]).T
        inside = np.linalg.solve(edges, np.asarray(place)[:dimension] - corners[0])
        if inside.min() > -1e-9 and inside.sum() < 1 + 1e-9:
            weights = np.zeros(len(nodes))
            cell.InterpolateFunctions([*inside, *[0.0] * (3 - dimension)], weights)
            return weights @ grid["displacement"][nodes], grid.celltypes[i]
    raise LookupError(place)


def states(directory):
    """Times of the list, and what VTK reads of each state."""
    reader = pyvista.get_reader(directory / "elements.pvd")
    for time in reader.time_values:
        reader.set_active_time_value(time)
        yield time, reader.read()[0]


@pytest.mark.core
@pytest.mark.parametrize("degree", [2, 3, 5])
def test_vtk_finds_the_displacement_of_the_probes(tmp_path, degree):
    case = case_from_dict(merged(SHEET, {"discretisation": {"degree": degree}}))
    run(case, tmp_path, quiet=True)
    history = read_history(tmp_path / "history.csv")
    found = list(states(tmp_path))
    assert [time for time, _ in found] == history["load"].tolist()
    for k, (_, grid) in enumerate(found):
        assert set(grid.celltypes) == {CellType.LAGRANGE_TRIANGLE}
        assert grid.GetCell(0).GetNumberOfPoints() == (degree + 1) * (degree + 2) // 2
        for i, place in enumerate(PROBES):
            ux, uy, uz = displacement_at(grid, place)[0]
            expected = history[f"probe{i}_ux"][k], history[f"probe{i}_uy"][k]
            assert (ux, uy) == pytest.approx(expected, rel=1e-12, abs=1e-15)
            assert uz == 0.0


def test_a_beam_is_of_curves(tmp_path):
    run(with_elements(BEAM), tmp_path, quiet=True)
    history = read_history(tmp_path / "history.csv")
    *_, (_, grid) = states(tmp_path)
    tip, kind = displacement_at(grid, [grid.points[:, 0].max()])
    assert kind == CellType.LAGRANGE_CURVE
    expected = history["tip_ux"][-1], history["tip_uy"][-1]
    assert tip[:2] == pytest.approx(expected, rel=1e-12)


def test_those_at_stops_alone(tmp_path):
    case = merged(SHEET, {"output": {"fields": "stops"}, "continuation": {"stops": [0.4, 1.0]}})
    run(case_from_dict(case), tmp_path, quiet=True)
    assert [time for time, _ in states(tmp_path)] == [0.4, 1.0]


def test_a_run_without_them_removes_those_of_an_earlier_one(tmp_path):
    run(case_from_dict(SHEET), tmp_path, quiet=True)
    run(case_from_dict(merged(SHEET, {"output": {"elements": False}})), tmp_path, quiet=True)
    assert not list(tmp_path.glob("elements*"))


def test_an_interrupted_list_is_gone_on_with(tmp_path, monkeypatch):
    def mortal(*arguments):
        if arguments[-1].states == 3:  # its state is already in the list
            raise PowerCut
        save(*arguments)

    save = checkpoint.save
    with monkeypatch.context() as patch:
        patch.setattr(checkpoint, "save", mortal)
        with pytest.raises(PowerCut):
            run(case_from_dict(SHEET), tmp_path, quiet=True)
    assert len(list(states(tmp_path))) == 4
    run(case_from_dict(SHEET), tmp_path, resume=True, quiet=True)
    loads = read_history(tmp_path / "history.csv")["load"].tolist()
    assert [time for time, _ in states(tmp_path)] == loads
    assert not list((tmp_path / "elements").glob("*.pvd"))


@pytest.mark.parametrize("case", [LATTICE, CHAIN], ids=["lattice", "chain"])
def test_springs_have_none(case):
    with pytest.raises(CaseError, match=r"output\.elements.*made of springs"):
        with_elements(case)
