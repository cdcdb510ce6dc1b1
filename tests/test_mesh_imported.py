"""Meshes from files: what is read, and what is refused and why."""

from pathlib import Path

import gmsh
import meshio
import numpy as np
import pytest

from pantograph_fem.errors import CaseError
from pantograph_fem.mesh import Triangulation, read_mesh, rectangle
from pantograph_fem.mesh.checks import coincident

W, H = 0.068, 0.204
SPECIMEN = Path(__file__).parent.parent / "meshes" / "specimen_with_hole.msh"


@pytest.fixture
def users_gmsh():
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    yield
    gmsh.finalize()


def save_with_gmsh(mesh, path, version, binary):
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    gmsh.model.add("saved")
    curves = {"bottom": 1, "top": 2}
    gmsh.model.addDiscreteEntity(2, 1)
    for tag in curves.values():
        gmsh.model.addDiscreteEntity(1, tag)
    # A point of no triangle, as the centre of an arc, between those of the sheet.
    xyz = np.insert(np.pad(mesh.points, ((0, 0), (0, 1))), 5, (9.0, 9.0, 0.0), axis=0)
    number = np.arange(1, len(mesh.points) + 1)
    number[5:] += 1
    gmsh.model.mesh.addNodes(2, 1, np.arange(1, len(xyz) + 1), xyz.ravel())
    gmsh.model.mesh.addElementsByType(1, 2, [], number[mesh.triangles].ravel())
    gmsh.model.setPhysicalName(2, gmsh.model.addPhysicalGroup(2, [1]), "sheet")
    for name, tag in curves.items():
        gmsh.model.mesh.addElementsByType(tag, 1, [], number[mesh.edges[name]].ravel())
        gmsh.model.setPhysicalName(1, gmsh.model.addPhysicalGroup(1, [tag]), name)
    gmsh.write(str(path))


@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("version", [2.2, 4.1])
def test_file_of_gmsh_gives_back_the_mesh(users_gmsh, tmp_path, version, binary):
    mesh = rectangle(W, H, 0.016, 0.004, (0.004, None))
    save_with_gmsh(mesh, tmp_path / "sheet.msh", version, binary)
    same_mesh(read_mesh(tmp_path / "sheet.msh"), mesh)


def same_mesh(read: Triangulation, mesh: Triangulation):
    np.testing.assert_allclose(read.points, mesh.points, rtol=1e-15)
    assert np.array_equal(read.triangles, mesh.triangles)
    assert list(read.edges) == ["bottom", "top"]
    for grip in read.edges:
        assert np.array_equal(read.edges[grip], mesh.edges[grip])


def test_element_sets_of_other_formats_name_the_grips(tmp_path):
    mesh = rectangle(W, H, 0.016, 0.004)
    none = np.zeros(0, dtype=int)
    lines = [mesh.edges["bottom"], mesh.edges["top"]]
    meshio.Mesh(
        mesh.points,
        [("triangle", mesh.triangles), ("line", np.vstack(lines))],
        cell_sets={
            "bottom": [none, np.arange(len(lines[0]))],
            "top": [none, len(lines[0]) + np.arange(len(lines[1]))],
        },
    ).write(tmp_path / "sheet.inp")
    same_mesh(read_mesh(tmp_path / "sheet.inp"), mesh)


def test_shipped_specimen_reads():
    mesh = read_mesh(SPECIMEN)
    hole = np.pi * 0.012**2
    assert mesh.area == pytest.approx(W * H - hole, rel=1e-3)
    assert mesh.area > W * H - hole  # its hole is an inscribed polygon
    assert mesh.quality.min() > 0.6
    for grip, y in (("bottom", 0.0), ("top", H)):
        ends = mesh.points[mesh.edges[grip]]
        np.testing.assert_allclose(ends[:, :, 1], y, atol=1e-15)
        assert np.ptp(ends[:, :, 0]) == pytest.approx(W, rel=1e-12)
    at_corner = np.linalg.norm(mesh.points[mesh.triangles].mean(axis=1), axis=1) < 0.002
    assert 1 / 1.5 < mesh.edge_lengths[at_corner].mean() / 0.001 < 1.5
    assert SPECIMEN.stat().st_size < 300_000


# Two unit squares on top of each other, four triangles, and ways to spoil them:
#
#   4 - 5
#   | / |
#   2 - 3
#   | / |
#   0 - 1

POINTS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 2, 0), (1, 2, 0)]
TRIANGLES = [(0, 1, 3), (0, 3, 2), (2, 3, 5), (2, 5, 4)]
GROUPS = {"bottom": ("line", [(0, 1)]), "top": ("line", [(4, 5)])}
DIMENSION = {"vertex": 0, "line": 1}


def read_sheet(tmp_path, points=POINTS, triangles=TRIANGLES, groups=GROUPS, others=()):
    """Write a .msh 2.2 file with a group "sheet" and the given ones, and read it."""
    cells = [("triangle", triangles)] if triangles else []
    tags = [1] * len(cells)
    names = {"sheet": np.array([1, 2])}
    for tag, (name, (kind, rows)) in enumerate(groups.items(), start=2):
        names[name] = np.array([tag, DIMENSION[kind]])
        if rows:
            cells.append((kind, rows))
            tags.append(tag)
    for cell in others:
        cells.append(cell)
        tags.append(1)
    data = [np.full(len(rows), tag) for tag, (_, rows) in zip(tags, cells, strict=True)]
    path = tmp_path / "sheet.msh"
    meshio.Mesh(
        np.array(points, dtype=float),
        [(kind, np.array(rows)) for kind, rows in cells],
        cell_data={"gmsh:physical": data, "gmsh:geometrical": data},
        field_data=names,
    ).write(path, file_format="gmsh22", binary=False)
    return read_mesh(path)


def moved(index, *point):
    """Points of the two squares with one of them elsewhere."""
    return [*POINTS[:index], point, *POINTS[index + 1 :]]


def test_two_squares_read(tmp_path):
    mesh = read_sheet(tmp_path)
    assert mesh.area == pytest.approx(2.0)
    assert mesh.edges["bottom"].tolist() == [[0, 1]]
    assert mesh.edges["top"].tolist() == [[5, 4]]


def test_clockwise_mesh_is_turned_round(tmp_path):
    mesh = read_sheet(tmp_path, triangles=[t[::-1] for t in TRIANGLES])
    assert (mesh.areas > 0).all()
    assert mesh.edges["bottom"].tolist() == [[0, 1]]


def test_plane_at_another_height_is_a_plane(tmp_path):
    mesh = read_sheet(tmp_path, points=[(x, y, 7.0) for x, y, _ in POINTS])
    assert mesh.area == pytest.approx(2.0)


def test_cells_that_the_file_repeats_count_once(tmp_path):
    # .msh 2.2 writes a cell once for each of its groups.
    mesh = read_sheet(tmp_path, triangles=TRIANGLES + TRIANGLES[:2])
    assert mesh.area == pytest.approx(2.0)


BAD = {
    "nothing to mesh": (
        {"triangles": []},
        "has no triangles; label the surface of the sheet as well as the grips (in gmsh: a "
        "physical surface), or it is not saved",
    ),
    "quadrilaterals": (
        {"triangles": TRIANGLES[:2], "others": [("quad", [(2, 3, 5, 4)])]},
        "has cells that are not allowed: 1 quad; allowed are first-order triangles for the sheet "
        "and first-order lines for its grips",
    ),
    "second order": (
        {"others": [("triangle6", [(0, 1, 2, 3, 4, 5)]), ("line3", [(0, 1, 2)])]},
        "has cells that are not allowed: 1 triangle6, 1 line3; allowed are first-order triangles "
        "for the sheet and first-order lines for its grips",
    ),
    "not finite": (
        {"points": moved(3, 1, np.nan, 0)},
        "points with a coordinate that is not a finite number: 1, the first at (1, nan, 0); every "
        "point needs x and y",
    ),
    "not plane": (
        {"points": moved(5, 1, 2, 0.5)},
        "the points are not in one plane: z = 0 at (0, 0, 0) and 0.5 at (1, 2, 0.5); the sheet "
        "must lie in a plane z = constant",
    ),
    "coincident": (
        {
            "points": [*POINTS, (0, 1, 0), (1, 1 + 1e-10, 0)],
            "triangles": [*TRIANGLES[:2], (6, 7, 5), (6, 5, 4)],
        },
        "points that coincide with another point: 2, the first at (0, 1); the mesh is not "
        "connected there; merge them (in gmsh: Coherence, or removeDuplicateNodes; a cut needs a "
        "width)",
    ),
    "degenerate": (
        {
            "points": [*POINTS, (1, 0.5, 0)],
            "triangles": [(0, 1, 6), (0, 6, 3), (1, 6, 3), *TRIANGLES[1:]],
        },
        "degenerate triangles (area below 1e-12 of the squared longest edge): 1, the first at "
        "(1, 0.5); move their points apart or mesh again",
    ),
    "three on an edge": (
        {"points": [*POINTS, (2, 1.5, 0)], "triangles": [*TRIANGLES, (2, 3, 6)]},
        "edges of more than two triangles: 1, the first at (0.5, 1); an edge belongs to one "
        "triangle on the boundary and to two inside",
    ),
    "folded": (
        {"points": moved(5, 1, 0.5, 0)},
        "triangles that turn against the others: 1, the first at (0.666667, 0.833333); the sheet "
        "folds over itself there, or its surfaces are oriented differently (in gmsh: reverse the "
        "curve loop of one); all must turn the same way",
    ),
    "overlapping": (
        {"points": [*POINTS, (0.2, 0.4, 0)], "triangles": [*TRIANGLES, (0, 1, 6)]},
        "edges with both triangles on the same side: 1, the first at (0.5, 0); triangles overlap "
        "there; they must lie on either side",
    ),
    "two parts": (
        {
            "points": [*POINTS, (3, 0, 0), (4, 0, 0), (3, 1, 0)],
            "triangles": [*TRIANGLES, (6, 7, 8)],
        },
        "the sheet falls into 2 parts that have no edge in common; one has 1 of the 5 triangles, "
        "at (3.33333, 0.333333); it must be in one piece",
    ),
    "touching in a point": (
        {"points": [*POINTS, (2, 2, 0), (2, 3, 0)], "triangles": [*TRIANGLES, (5, 6, 7)]},
        "the sheet falls into 2 parts that have no edge in common; one has 1 of the 5 triangles, "
        "at (1.66667, 2.33333); it must be in one piece",
    ),
    "no group": (
        {"groups": {"bottom": GROUPS["bottom"], "Top": GROUPS["top"], "spare": ("vertex", [])}},
        'has no group "top"; its groups: "Top" (line), "bottom" (line), "sheet" (triangle), '
        '"spare" (empty); the lines of the top grip must be in a group "top" (in gmsh: a '
        "physical curve)",
    ),
    "empty group": (
        {"groups": {**GROUPS, "bottom": ("line", [])}},
        'group "bottom" has no lines (it is empty); it must hold the lines of the bottom grip',
    ),
    "group of points": (
        {"groups": {**GROUPS, "top": ("vertex", [(4,), (5,)])}},
        'group "top" has no lines (only cells of kind vertex); it must hold the lines of the top '
        "grip",
    ),
    "line inside": (
        {"groups": {**GROUPS, "top": ("line", [(5, 4), (2, 3)])}},
        'lines of group "top" that are not on the boundary of the sheet: 1 of 2, the first at '
        "(0.5, 1, 0); each must be an edge of exactly one triangle",
    ),
    "line outside": (
        {"points": [*POINTS, (1, 3, 0)], "groups": {**GROUPS, "top": ("line", [(4, 6)])}},
        'lines of group "top" that are not on the boundary of the sheet: 1 of 1, the first at '
        "(0.5, 2.5, 0); each must be an edge of exactly one triangle",
    ),
    "folded, most triangles clockwise": (
        {"points": moved(5, 1, 0.5, 0), "triangles": [t[::-1] for t in TRIANGLES]},
        "triangles that turn against the others: 1, the first at (0.666667, 0.833333); the sheet "
        "folds over itself there, or its surfaces are oriented differently (in gmsh: reverse the "
        "curve loop of one); all must turn the same way",
    ),
    "grips that meet": (
        {"groups": {"bottom": ("line", [(0, 1)]), "top": ("line", [(1, 3), (3, 5)])}},
        'groups "bottom" and "top" meet at (1, 0); the grips must have no point in common',
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_mesh_is_refused_with_its_cause(tmp_path, name):
    spoiled, message = BAD[name]
    with pytest.raises(CaseError) as error:
        read_sheet(tmp_path, **spoiled)
    assert str(error.value) == f"mesh file {tmp_path / 'sheet.msh'}: {message}"


def test_cells_need_the_points_that_they_name(users_gmsh, tmp_path):
    path = tmp_path / "sheet.msh"
    save_with_gmsh(rectangle(W, H, 0.016, 0.004), path, 2.2, binary=False)
    # The second point gets another number.
    path.write_text(path.read_text().replace("\n2 0.", "\n999 0.", 1))
    with pytest.raises(CaseError) as error:
        read_mesh(path)
    assert str(error.value) == (
        f"mesh file {path}: has cells with corners that are not among its points"
    )


@pytest.mark.parametrize(("distance", "found"), [(0.5e-9, 300), (1e-8, 0)])
def test_coincident_points_are_found_wherever_they_lie(distance, found):
    rng = np.random.default_rng(0)
    points = rng.random((300, 2))
    angle = 2 * np.pi * rng.random(300)
    twins = points + distance * np.column_stack([np.cos(angle), np.sin(angle)])
    assert coincident(np.vstack([points, twins])).sum() == found


def test_groups_without_names_are_no_groups(tmp_path):
    path = tmp_path / "sheet.vtu"
    meshio.Mesh(np.array(POINTS, dtype=float), [("triangle", TRIANGLES)]).write(path)
    with pytest.raises(CaseError) as error:
        read_mesh(path)
    assert str(error.value) == (
        f'mesh file {path}: has no group "bottom"; its groups: none; the lines of the bottom grip '
        'must be in a group "bottom" (in gmsh: a physical curve)'
    )


@pytest.mark.parametrize("name", ["sheet.msh", "."])
def test_missing_file(tmp_path, name):
    path = tmp_path / name
    with pytest.raises(CaseError) as error:
        read_mesh(path)
    assert str(error.value) == f"mesh file {path}: there is no such file"


@pytest.mark.parametrize(
    ("name", "content", "cause"),
    [
        ("sheet.mesh3", "", "Could not deduce file format from path '{}'"),
        ("sheet.msh", "garbage\n", "not a file of the kind its name says)"),
        ("sheet.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", "$Element section not found"),
        ("sheet.msh", "$MeshFormat\n9.9 0 8\n$EndMeshFormat\n", "Need mesh format in"),
    ],
)
def test_unreadable_file(tmp_path, capsys, name, content, cause):
    path = tmp_path / name
    path.write_text(content)
    with pytest.raises(CaseError) as error:
        read_mesh(path)
    message = str(error.value)
    assert message.startswith(f"mesh file {path}: cannot be read (meshio: {cause.format(path)}")
    assert message.endswith(
        "; use a gmsh .msh file, version 2.2 or 4.1, with every saved cell in a physical group"
    )
    assert capsys.readouterr() == ("", "")
