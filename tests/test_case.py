"""What a case holds after it is read: defaults, sections that depend on each other, overrides."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pantograph_fem.case import SheetCase, case_from_dict, case_to_toml, load_case
from pantograph_fem.errors import CaseError


def tables(**sections: Any) -> dict[str, Any]:
    """A small case; keyword arguments replace or add keys."""
    return {
        "name": "small",
        "sheet": {"width": 0.068, "height": 0.204},
        "material": {"stretch": 1.34e5, "bending": 1.92e-2, "shear": 159.0},
    } | sections


def write(folder: Path, text: str) -> Path:
    path = folder / "case.toml"
    path.write_text(text)
    return path


def test_defaults() -> None:
    case = case_from_dict(tables())
    assert (case.kind, case.title, case.sheet.fibre_angle) == ("sheet", "", 45.0)
    assert case.material.shear_exponent == 2.0
    assert case.grips.top == case.grips.bottom
    assert case.grips.top.model_dump() == {
        "hold": "position",
        "translation": (0.0, 0.0),
        "rotation": 0.0,
        "pivot": "centre",
    }
    assert case.continuation.stops == (1.0,)
    assert case.continuation.initial_step == 0.02
    assert case.output.probes == ()


def test_a_case_cannot_be_changed() -> None:
    case = case_from_dict(tables())
    with pytest.raises(ValueError, match="frozen"):
        case.sheet.width = 1.0  # type: ignore[misc]


@pytest.mark.parametrize("absent", [{}, {"bending": 0}, {"bending": 0.0}, {"bending": [0, 0.0]}])
def test_an_absent_and_a_zero_effect_are_the_same(absent: dict[str, object]) -> None:
    case = case_from_dict(tables(material={"stretch": 1.0, **absent}))
    assert case.material.bending_pair is None
    assert not case.material.has_shear
    assert case == case_from_dict(tables(material={"stretch": 1.0}))
    assert set(tomllib.loads(case_to_toml(case))["material"]) == {"stretch", "shear_exponent"}


def test_stiffness_is_a_number_or_one_per_family() -> None:
    material = case_from_dict(tables(material={"stretch": 3, "bending": [2.0, 0]})).material
    assert material.stretch_pair == (3.0, 3.0)
    assert material.bending_pair == (2.0, 0.0)


def test_default_mesh_sizes_follow_the_paper_s_sheet() -> None:
    mesh = case_from_dict(tables()).mesh
    assert mesh.size == pytest.approx(0.068 / 11)
    assert mesh.corner_size == pytest.approx(0.068 / 440)
    assert mesh.grip_size is None


def test_default_corner_size_follows_the_size() -> None:
    mesh = case_from_dict(tables(mesh={"size": 0.008})).mesh
    assert mesh.corner_size == pytest.approx(0.0002)


def test_default_sizes_follow_the_shorter_side() -> None:
    mesh = case_from_dict(tables(sheet={"width": 1.7, "height": 1.1})).mesh
    assert mesh.size == pytest.approx(0.1)


@pytest.mark.parametrize("side", ["bottom", "top"])
def test_a_clamp_refines_the_mesh_along_the_grips(side: str) -> None:
    clamped = tables(grips={side: {"hold": "clamp"}})
    assert case_from_dict(clamped).mesh.grip_size == pytest.approx(0.001)
    fine = case_from_dict(clamped | {"mesh": {"size": 0.0001}}).mesh
    assert fine.grip_size == fine.size
    given_size = case_from_dict(clamped | {"mesh": {"grip_size": 0.002}}).mesh
    assert given_size.grip_size == 0.002


def test_degrees_follow_the_degree_of_the_displacement() -> None:
    cubic = case_from_dict(tables()).discretisation
    assert (cubic.degree, cubic.auxiliary_degree, cubic.quadrature_degree) == (3, 2, 5)
    quadratic = case_from_dict(tables(discretisation={"degree": 2})).discretisation
    assert (quadratic.auxiliary_degree, quadratic.quadrature_degree) == (1, 4)


def test_full_load_is_always_a_stop() -> None:
    def stops(value: list[float]) -> tuple[float, ...]:
        return case_from_dict(tables(continuation={"stops": value})).continuation.stops

    assert stops([]) == (1.0,)
    assert stops([0.25, 0.5]) == (0.25, 0.5, 1.0)
    assert stops([0.25, 1]) == (0.25, 1.0)


def test_max_step_alone_asks_for_smaller_steps() -> None:
    continuation = case_from_dict(tables(continuation={"max_step": 0.01})).continuation
    assert continuation.initial_step == 0.01


def test_probes_may_lie_on_the_edge() -> None:
    corners = [[0, 0], [0.068, 0.204]]
    probes = case_from_dict(tables(output={"probes": corners})).output.probes
    assert probes == ((0.0, 0.0), (0.068, 0.204))


def test_the_first_of_a_series_of_meshes_is_coarse() -> None:
    mesh = case_from_dict(tables()).mesh
    assert not mesh.adapt
    assert (mesh.accuracy, mesh.accuracy_of) == (1e-3, "force")
    first = case_from_dict(tables(mesh={"adapt": True}, grips={"top": {"hold": "clamp"}})).mesh
    assert first.size == pytest.approx(0.068 / 6)
    assert first.corner_size == pytest.approx(0.068 / 120)
    assert first.grip_size == pytest.approx(0.002)
    high = case_from_dict(tables(mesh={"adapt": True}, discretisation={"degree": 6})).mesh
    assert high.size == pytest.approx(0.068 / 3)
    assert (first.growth, high.growth) == (0.25, 0.5)
    given = case_from_dict(tables(mesh={"adapt": True, "size": 0.004, "corner_size": 0.001})).mesh
    assert (given.size, given.corner_size) == (0.004, 0.001)


def test_mesh_file_is_relative_to_the_case_file(tmp_path: Path) -> None:
    (tmp_path / "x.msh").touch()
    folder = tmp_path / "cases"
    folder.mkdir()
    path = write(folder, case_to_toml(case_from_dict(tables())).split("[mesh]")[0])
    case = load_case(path, ["mesh.file=../x.msh", "output.probes=[[-1.0, 0.0]]"])
    assert case.mesh.file == (tmp_path / "x.msh").resolve()
    assert case.mesh.size is None
    # the resolved text may be moved elsewhere
    assert case_from_dict(tomllib.loads(case_to_toml(case)), base=Path("/")) == case


def test_overrides_are_toml_values_or_plain_strings(tmp_path: Path) -> None:
    path = write(tmp_path, case_to_toml(case_from_dict(tables())))
    overrides = [
        "title=Extension = 2 mm",
        'name="quoted"',
        "grips.top.translation = [0.0, 0.002]",
        "grips.top.pivot=left",
        "material.bending=0",
        "output.figures=false",
    ]
    case = load_case(path, overrides)
    assert (case.title, case.name) == ("Extension = 2 mm", "quoted")
    assert case.grips.top.translation == (0.0, 0.002)
    assert case.grips.top.pivot == "left"
    assert case.material.bending is None
    assert not case.output.figures


def test_overrides_create_absent_sections(tmp_path: Path) -> None:
    path = write(
        tmp_path, 'name = "x"\nmaterial = {stretch = 1}\nsheet = {width = 1, height = 1}\n'
    )
    case = load_case(path, ["grips.top.rotation=5"])
    assert case.grips.top.rotation == 5.0


def test_the_last_override_wins(tmp_path: Path) -> None:
    path = write(tmp_path, case_to_toml(case_from_dict(tables())))
    assert load_case(path, ["title=a", "title=b"]).title == "b"


def test_an_override_cannot_smuggle_in_further_keys(tmp_path: Path) -> None:
    path = write(tmp_path, case_to_toml(case_from_dict(tables())))
    assert load_case(path, ["title=1\nshear = 2"]).title == "1\nshear = 2"


def test_checking_a_case_needs_neither_numpy_nor_dolfinx() -> None:
    script = (
        "import sys; from pantograph_fem.case import case_from_dict, case_to_toml\n"
        f"case_to_toml(case_from_dict({tables()!r}))\n"
        "heavy = {'numpy', 'dolfinx', 'ufl', 'mpi4py', 'matplotlib'} & set(sys.modules)\n"
        "sys.exit(', '.join(heavy) or None)"
    )
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr


positive = st.floats(1e-6, 1e6)
number = st.floats(-1e6, 1e6)
fraction = st.floats(0, 1, exclude_min=True)
pair = st.tuples(number, number)
stiffness = st.one_of(
    positive, st.integers(0, 9), st.tuples(st.floats(0, 1e6), st.floats(0, 1e6)).map(list)
)
grip = st.fixed_dictionaries(
    {},
    optional={
        "hold": st.sampled_from(["position", "clamp"]),
        "translation": pair,
        "rotation": number,
        "pivot": st.one_of(st.sampled_from(["centre", "left", "right"]), pair),
    },
)


@st.composite
def cases(draw: st.DrawFn) -> SheetCase:
    """Valid cases, with any of the optional keys."""
    width, height = draw(positive), draw(positive)
    degree = draw(st.sampled_from([2, 3]))
    size = draw(positive)
    smaller = st.floats(0.01, 1).map(lambda factor: factor * size)
    optional = {
        "title": st.text(),
        "kind": st.just("sheet"),
        "grips": st.fixed_dictionaries({}, optional={"bottom": grip, "top": grip}),
        "mesh": st.fixed_dictionaries(
            {"size": st.just(size)},
            optional={
                "corner_size": smaller,
                "grip_size": smaller,
                "adapt": st.booleans(),
                "accuracy": st.floats(1e-6, 0.1),
                "accuracy_of": st.sampled_from(["force", "energy"]),
            },
        ),
        "discretisation": st.fixed_dictionaries(
            {"degree": st.just(degree)},
            optional={
                "auxiliary_degree": st.integers(1, degree - 1),
                "quadrature_degree": st.integers(2, 20),
                "shear_regularisation": positive,
            },
        ),
        "continuation": st.fixed_dictionaries(
            {},
            optional={
                "stops": st.lists(st.integers(1, 1000), unique=True, max_size=5).map(
                    lambda thousandths: sorted(n / 1000 for n in thousandths)
                ),
                "max_step": st.floats(1e-4, 1),
                "predictor": st.sampled_from(["tangent", "secant", "none"]),
                "tolerance": st.floats(1e-13, 1e-3),
            },
        ),
        "output": st.fixed_dictionaries(
            {},
            optional={
                "probes": st.lists(
                    st.tuples(st.floats(0, width), st.floats(0, height)), max_size=3
                ),
                "fields": st.sampled_from(["all", "stops", "none"]),
                "figures": st.booleans(),
            },
        ),
    }
    required = {
        "name": st.from_regex(r"[A-Za-z0-9_][A-Za-z0-9_.-]*", fullmatch=True),
        "sheet": st.fixed_dictionaries(
            {"width": st.just(width), "height": st.just(height)}, optional={"fibre_angle": number}
        ),
        "material": st.fixed_dictionaries(
            {"bending": positive},
            optional={
                "stretch": stiffness,
                "shear": st.floats(0, 1e6),
                "shear_exponent": st.floats(1, 5, exclude_min=True),
            },
        ),
    }
    return case_from_dict(draw(st.fixed_dictionaries(required, optional=optional)))


@settings(deadline=None)  # the machine may be busy
@given(cases())
def test_the_resolved_text_gives_an_equal_case(case: SheetCase) -> None:
    assert case_from_dict(tomllib.loads(case_to_toml(case))) == case


@settings(deadline=None)  # the machine may be busy
@given(cases())
def test_the_resolved_text_holds_every_value(case: SheetCase) -> None:
    resolved = tomllib.loads(case_to_toml(case))
    assert set(resolved) == set(SheetCase.model_fields)
    for section in ("sheet", "discretisation", "continuation", "output"):
        assert set(resolved[section]) == set(type(getattr(case, section)).model_fields)
    for side in ("bottom", "top"):
        assert set(resolved["grips"][side]) == {"hold", "translation", "rotation", "pivot"}


KEYS = [("name",), ("title",), ("kind",), ("grips", "top"), ("grips", "top", "pivot")] + [
    path
    for section, field in SheetCase.model_fields.items()
    if hasattr(field.annotation, "model_fields")
    for path in [(section,), *((section, key) for key in field.annotation.model_fields)]
]
junk = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text() | st.dates(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=2),
    max_leaves=4,
)


@settings(deadline=None)  # the machine may be busy
@given(st.sampled_from(KEYS), junk)
def test_any_value_anywhere_is_accepted_or_named_in_the_error(
    path: tuple[str, ...], value: object
) -> None:
    data = tables()
    table = data
    for key in path[:-1]:
        table[key] = dict(table.get(key, {}))
        table = table[key]
    table[path[-1]] = value
    try:
        case_from_dict(data)
    except CaseError as error:
        lines = str(error).splitlines()[1:]
        assert lines
        assert all(line.startswith("  " + path[0]) for line in lines)
