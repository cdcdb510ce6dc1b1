"""Meshes of a rectangle: sizes, symmetry, and what gmsh leaves behind."""

import signal

import gmsh
import numpy as np
import pytest

from pantograph_fem.errors import CaseError
from pantograph_fem.mesh import rectangle
from pantograph_fem.mesh.checks import anticlockwise

W, H = 0.068, 0.204
GRIP_SIZES = [(None, None), (0.002, 0.002), (0.002, None), (None, 0.002), (0.002, 0.004)]


def sorted_points(points):
    # Rounded, so that round-off does not decide the order.
    return points[np.lexsort(np.round(points, 9).T)]


def edges_of(mesh):
    """Middle and length of each edge."""
    ends = np.unique(np.sort(mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)), axis=0)
    a, b = mesh.points[ends[:, 0]], mesh.points[ends[:, 1]]
    return (a + b) / 2, np.linalg.norm(b - a, axis=1)


@pytest.mark.parametrize("grip_size", GRIP_SIZES)
def test_mirror_images_coincide_to_round_off(grip_size):
    mesh = rectangle(W, H, 0.008, 0.001, grip_size)
    axes = (0, 1) if grip_size[0] == grip_size[1] else (0,)
    for axis in axes:
        image = mesh.points.copy()
        image[:, axis] = (W, H)[axis] - image[:, axis]
        np.testing.assert_allclose(
            sorted_points(image), sorted_points(mesh.points), rtol=0, atol=2e-16
        )
        centres, mirrored = (p[mesh.triangles].mean(axis=1) for p in (mesh.points, image))
        np.testing.assert_allclose(
            sorted_points(mirrored), sorted_points(centres), rtol=0, atol=2e-16
        )


@pytest.mark.parametrize("grip_size", GRIP_SIZES)
def test_rectangle_is_a_sheet_of_well_shaped_triangles(grip_size):
    mesh = rectangle(W, H, 0.008, 0.001, grip_size)
    assert anticlockwise(mesh.points, mesh.triangles) is mesh.triangles
    assert mesh.area == pytest.approx(W * H, rel=1e-13)
    assert (mesh.areas > 0).all()
    assert mesh.quality.min() > 0.6
    assert mesh.quality.mean() > 0.95
    assert mesh.quality.max() <= 1 + 1e-12


@pytest.mark.parametrize("grip_size", GRIP_SIZES)
def test_edges_of_grips_cover_them_exactly(grip_size):
    mesh = rectangle(W, H, 0.008, 0.001, grip_size)
    for grip, y, left_to_right in (("bottom", 0.0, True), ("top", H, False)):
        ends = mesh.points[mesh.edges[grip]]
        assert (ends[:, :, 1] == y).all()
        assert ends[:, :, 0].min() == 0.0
        assert ends[:, :, 0].max() == W
        step = ends[:, 1, 0] - ends[:, 0, 0]
        assert np.abs(step).sum() == pytest.approx(W, rel=1e-13)
        # The sheet is on the left.
        assert ((step > 0) == left_to_right).all()


@pytest.mark.parametrize("grip_size", GRIP_SIZES)
def test_elements_have_the_size_asked_for(grip_size):
    size, corner_size = 0.006, 0.0005
    mesh = rectangle(W, H, size, corner_size, grip_size)
    middle, length = edges_of(mesh)
    x, y = middle.T
    r = np.hypot(np.minimum(x, W - x), np.minimum(y, H - y))
    asked = np.minimum(size, corner_size + 0.25 * r)
    for grip, distance in zip(grip_size, (y, H - y), strict=True):
        if grip is not None:
            asked = np.minimum(asked, grip + 0.25 * distance)
            near = (distance < grip / 2) & (r > W / 3)
            assert 1 / 1.2 < length[near].mean() / grip < 1.2
    for corner in ((0, 0), (W, 0), (W, H), (0, H)):
        near = np.linalg.norm(middle - corner, axis=1) < 2 * corner_size
        assert near.sum() >= 5
        assert 1 / 1.5 < length[near].mean() / corner_size < 1.5
    inside = asked == size
    assert 1 / 1.2 < length[inside].mean() / size < 1.2
    graded = (asked < 0.9 * size) & (r > 4 * corner_size)
    # Gmsh makes edges a little shorter than asked where the size grows.
    assert 0.85 < (length / asked)[graded].mean() < 0.97


def test_equal_arguments_give_equal_meshes():
    first, second = (rectangle(W, H, 0.008, 0.001) for _ in range(2))
    assert np.array_equal(first.points, second.points)
    assert np.array_equal(first.triangles, second.triangles)


@pytest.mark.parametrize("factor", [1e3, 1e-3, 1 / 0.0254])
def test_mesh_does_not_depend_on_the_unit_of_length(factor):
    lengths = np.array([W, H, 0.008, 0.001, 0.002])
    mesh, scaled = (rectangle(*v[:4], (v[4], None)) for v in (lengths, factor * lengths))
    assert np.array_equal(scaled.triangles, mesh.triangles)
    np.testing.assert_allclose(scaled.points, factor * mesh.points, rtol=1e-12)


def test_elements_grow_as_asked_away_from_the_corners():
    size, corner_size = 0.02, 0.0005
    for growth in (0.15, 0.3, 0.5):
        mesh = rectangle(W, H, size, corner_size, growth=growth)
        corners = mesh.points[mesh.triangles]
        longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
        middle = corners.mean(axis=1)
        r = np.hypot(
            np.minimum(middle[:, 0], W - middle[:, 0]), np.minimum(middle[:, 1], H - middle[:, 1])
        )
        asked = np.minimum(size, corner_size + growth * r)
        assert 0.8 < np.median(longest / asked) < 1.4


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((0.0, H, 0.008, 0.001), "mesh: width = 0.0: must be a positive length"),
        ((W, H, 0.008, np.nan), "mesh: corner_size = nan: must be a positive length"),
        (
            (W, H, 0.008, 0.001, (None, -1.0)),
            "mesh: grip_size of the top = -1.0: must be a positive length",
        ),
        (
            (W, H, 0.008, 0.001, (None, None), 0.0),
            "mesh: growth = 0.0: must be a positive number",
        ),
    ],
)
def test_lengths_must_be_positive(arguments, message):
    with pytest.raises(CaseError) as error:
        rectangle(*arguments)
    assert str(error.value) == message


@pytest.fixture
def users_gmsh():
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    yield
    gmsh.finalize()


def test_gmsh_of_the_user_is_left_alone(users_gmsh):
    expected = rectangle(W, H, 0.008, 0.001)
    gmsh.option.setNumber("Mesh.MeshSizeFactor", 3.0)
    gmsh.option.setNumber("Mesh.Algorithm", 8)
    gmsh.option.setNumber("Mesh.ElementOrder", 2)
    gmsh.model.add("users")
    mesh = rectangle(W, H, 0.008, 0.001)
    assert np.array_equal(mesh.points, expected.points)
    assert gmsh.model.list() == ["", "users"]
    assert gmsh.model.getCurrent() == "users"
    assert gmsh.option.getNumber("Mesh.MeshSizeFactor") == 3.0
    assert gmsh.option.getNumber("Mesh.Algorithm") == 8
    assert gmsh.option.getNumber("Mesh.ElementOrder") == 2


def test_nothing_is_asked_of_a_gmsh_that_is_not_initialised(monkeypatch):
    """It may end the process, by chance and without a word."""

    class Recorded:
        def __init__(self, library):
            self._library, self.called = library, []

        def __getattr__(self, name):
            self.called.append(name)
            return getattr(self._library, name)

    library = Recorded(gmsh.lib)
    monkeypatch.setattr(gmsh, "lib", library)
    rectangle(W, H, 0.008, 0.001)
    asked = [name for name in library.called if name != "gmshIsInitialized"]
    assert asked[0] == "gmshInitialize"
    assert asked[-1] == "gmshFinalize"


def test_meshing_is_silent_and_keeps_the_handler_of_interrupts(capfd):
    def handler(signum, frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, handler)
    try:
        rectangle(W, H, 0.008, 0.001)
        assert signal.getsignal(signal.SIGINT) is handler
    finally:
        signal.signal(signal.SIGINT, before)
    assert capfd.readouterr() == ("", "")
