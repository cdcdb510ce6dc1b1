"""The exact sentences with which a wrong case is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from pantograph_fem.case import case_from_dict, load_case
from pantograph_fem.errors import CaseError

SHEET = {"width": 0.068, "height": 0.204}
MATERIAL = {"stretch": 1.34e5, "bending": 1.92e-2, "shear": 159.0}


def problems(**sections: Any) -> list[str]:
    """Lines of the error for a small case with some keys replaced or added."""
    with pytest.raises(CaseError) as caught:
        case_from_dict({"name": "small", "sheet": SHEET, "material": MATERIAL} | sections)
    first, *lines = str(caught.value).splitlines()
    assert first == "The case is wrong:"
    return [line.removeprefix("  ") for line in lines]


def file_error(path: Path, *overrides: str) -> list[str]:
    with pytest.raises(CaseError) as caught:
        load_case(path, overrides)
    assert caught.value.exit_code == 2
    return str(caught.value).splitlines()


@pytest.fixture
def case_file(tmp_path: Path) -> Path:
    path = tmp_path / "small.toml"
    path.write_text(
        'name = "small"\n[sheet]\nwidth = 0.068\nheight = 0.204\n[material]\nshear = 159.0\n'
    )
    return path


@pytest.mark.parametrize(
    ("section", "key", "value", "sentence"),
    [
        ("material", "shear", -1.0, "-1.0 is not allowed; it must be 0 or greater"),
        (
            "material",
            "stretch",
            -1.0,
            "-1.0 is not allowed; it must be a finite number, 0 or greater, or a pair [K1, K2] of "
            "such, one per family",
        ),
        (
            "material",
            "bending",
            [1.0, 2.0, 3.0],
            "[1.0, 2.0, 3.0] is not allowed; it must be a finite number, 0 or greater, or a pair "
            "[K1, K2] of such, one per family",
        ),
        ("material", "shear", float("nan"), "nan is not allowed; it must be a finite number, "
         "0 or greater"),
        ("sheet", "fibre_angle", float("inf"), "inf is not allowed; it must be a finite number"),
        ("sheet", "width", "wide", '"wide" is not allowed; it must be a number greater than 0'),
        ("sheet", "width", True, "true is not allowed; it must be a number greater than 0"),
        ("sheet", "width", 0, "0 is not allowed; it must be greater than 0"),
        (
            "material",
            "shear_exponent",
            1.0,
            "1.0 is not allowed; it must be greater than 1 (at 1 or less the shear stress does "
            "not vanish with the shear angle, and the undeformed sheet is not in equilibrium)",
        ),
        ("mesh", "corner_size", 0.02,
         "0.02 is not allowed; it must be at most mesh.size (0.00618182)"),
        ("mesh", "adapt", 1, "1 is not allowed; it must be true or false"),
        ("mesh", "accuracy", 1e-9, "1e-09 is not allowed; it must be from 1e-06 to 0.1"),
        ("mesh", "accuracy_of", "moment",
         '"moment" is not allowed; it must be "force" or "energy"'),
        ("mesh", "grip_size", 0.02,
         "0.02 is not allowed; it must be at most mesh.size (0.00618182)"),
        ("discretisation", "scheme", "argyris",
         '"argyris" is not allowed; it must be "micromorphic" or "hinge"'),
        ("discretisation", "degree", 7, "7 is not allowed; it must be 2, 3, 4, 5 or 6"),
        ("discretisation", "auxiliary_degree", 0, "0 is not allowed; it must be from 1 to 5"),
        ("discretisation", "quadrature_degree", 21,
         "21 is not allowed; it must be from 2 to 20"),
        ("discretisation", "quadrature_degree", 4.0,
         "4.0 is not allowed; it must be a whole number from 2 to 20"),
        (
            "continuation",
            "stops",
            [0.5, 0.25],
            "[0.5, 0.25] is not allowed; it must be a list of increasing load fractions, each "
            "greater than 0 and at most 1, at least 1e-09 apart",
        ),
        (
            "continuation",
            "stops",
            [0.0, 1.0],
            "[0.0, 1.0] is not allowed; it must be a list of increasing load fractions, each "
            "greater than 0 and at most 1, at least 1e-09 apart",
        ),
        (
            "continuation",
            "initial_step",
            0.5,
            "0.5 is not allowed; it must be at least continuation.min_step (1e-05) and at most "
            "continuation.max_step (0.25)",
        ),
        ("continuation", "cutback", 1.0,
         "1.0 is not allowed; it must be greater than 0 and less than 1"),
        ("output", "probes", 0.034,
         "0.034 is not allowed; it must be a list of points [[x, y], ...]"),
        ("output", "figures", "no", '"no" is not allowed; it must be true or false'),
    ],
)  # fmt: skip
def test_a_value_that_is_not_allowed(section: str, key: str, value: Any, sentence: str) -> None:
    valid = {"sheet": SHEET, "material": MATERIAL}.get(section, {})
    assert problems(**{section: valid | {key: value}}) == [f"{section}.{key}: {sentence}"]


def test_the_hinge_scheme_has_no_auxiliary_degree() -> None:
    assert problems(discretisation={"scheme": "hinge", "auxiliary_degree": 2}) == [
        "discretisation.auxiliary_degree: not allowed in the hinge scheme, which has no auxiliary "
        "gradient"
    ]


def test_auxiliary_degree_is_below_the_degree() -> None:
    assert problems(discretisation={"degree": 2, "auxiliary_degree": 2}) == [
        "discretisation.auxiliary_degree: 2 is not allowed; it must be less than "
        "discretisation.degree (2)"
    ]


def test_unknown_keys_say_what_is_allowed() -> None:
    assert problems(material=MATERIAL | {"strech": 1.0}, loads=3) == [
        'material.strech: unknown key; did you mean "stretch"? Allowed here: bending, shear, '
        "shear_exponent, stretch",
        "loads: unknown key; allowed here: continuation, discretisation, grips, kind, material, "
        "measurements, mesh, name, output, sheet, title",
    ]


def test_missing_sections_and_keys() -> None:
    with pytest.raises(CaseError) as caught:
        case_from_dict({"sheet": {"width": 1.0}})
    assert str(caught.value) == (
        "The case is wrong:\n"
        "  name: missing; it is required and must be a string\n"
        "  sheet.height: missing; it is required and must be a number greater than 0\n"
        "  material: missing; the section [material] is required"
    )


def test_a_value_in_place_of_a_section() -> None:
    assert problems(mesh="fine") == [
        'mesh: "fine" is not allowed; it must be a section with the keys accuracy, accuracy_of, '
        "adapt, corner_size, file, grip_size, growth, size"
    ]


@pytest.mark.parametrize("name", ["", "..", "a/b", "-x", "über", "a\n"])
def test_a_name_is_a_plain_file_name(name: str) -> None:
    (line,) = problems(name=name)
    assert line.startswith("name: ")
    assert line.endswith(
        "is not allowed; it must be a plain file name: letters, digits, _ . - "
        "and neither . nor - in front"
    )


def test_an_unknown_kind_hides_other_problems_as_they_depend_on_it() -> None:
    assert problems(kind="plate", beam={}) == [
        'kind: "plate" is not allowed; it must be "sheet", "lattice", "beam" or "chain"'
    ]


@pytest.mark.parametrize("material", [{}, {"shear": 0.0}, {"stretch": [0, 0], "bending": 0}])
def test_a_material_has_an_effect(material: dict[str, Any]) -> None:
    assert problems(material=material) == [
        "material: no effect is given; at least one of stretch, bending, shear must be above 0"
    ]


@pytest.mark.parametrize("pivot", ["middle", [0.1], [0.1, "0.2"], [0.0, float("nan")], 3])
def test_a_pivot_is_a_place_or_a_point(pivot: Any) -> None:
    (line,) = problems(grips={"top": {"pivot": pivot}})
    assert line.startswith("grips.top.pivot: ")
    assert line.endswith(
        'is not allowed; it must be "centre", "left", "right" or a pair [x, y] of finite numbers'
    )


def test_a_clamp_without_bending() -> None:
    clamp = {"hold": "clamp"}
    reason = (
        '"clamp" is not allowed without material.bending; it must be "position" (a clamp '
        "prescribes the placement gradient, which only the bending effect sees)"
    )
    assert problems(material={"stretch": 1.0}, grips={"bottom": clamp, "top": clamp}) == [
        f"grips.bottom.hold: {reason}",
        f"grips.top.hold: {reason}",
    ]


def test_probes_lie_in_the_sheet() -> None:
    rule = "it must lie in the sheet, 0 <= x <= 0.068 and 0 <= y <= 0.204"
    assert problems(output={"probes": [[0.0, -0.1], [0.0, 0.0], [0.07, 0.0]]}) == [
        f"output.probes[0]: [0.0, -0.1] is not allowed; {rule}",
        f"output.probes[2]: [0.07, 0.0] is not allowed; {rule}",
    ]


def test_a_probe_is_a_point() -> None:
    assert problems(output={"probes": [[0.0, 0.0, 0.0]]}) == [
        "output.probes[0]: [0.0, 0.0, 0.0] is not allowed; it must be a pair [x, y] of finite "
        "numbers"
    ]


def test_a_missing_mesh_file(case_file: Path) -> None:
    assert file_error(case_file, "mesh.file=none.msh")[1:] == [
        f'  mesh.file: "none.msh" is not found; there is no file {case_file.parent / "none.msh"}'
    ]


def test_sizes_beside_a_mesh_file(tmp_path: Path) -> None:
    mesh = tmp_path / "x.msh"
    mesh.touch()
    assert problems(mesh={"file": str(mesh), "size": 0.1, "grip_size": 0.1, "adapt": True}) == [
        f"mesh.{key}: not allowed beside mesh.file, whose elements are used as they are"
        for key in ("size", "grip_size", "adapt")
    ]


def test_all_problems_are_listed_under_the_file(case_file: Path) -> None:
    text = case_file.read_text().replace("0.068", "-1").replace("159.0", "true")
    case_file.write_text(text)
    assert file_error(case_file) == [
        f"{case_file} is wrong:",
        "  sheet.width: -1 is not allowed; it must be greater than 0",
        "  material.shear: true is not allowed; it must be a number, 0 or greater",
    ]


def test_bad_overrides(case_file: Path) -> None:
    form = "not of the form key.path=value, such as material.shear=159.0"
    assert file_error(case_file, "material.shear", "sheet.width.x=1", "mesh.sise=1", "a..b=1") == [
        f"{case_file} --set material.shear --set sheet.width.x=1 --set mesh.sise=1 --set a..b=1 "
        "is wrong:",
        f"  --set material.shear: {form}",
        "  --set sheet.width.x=1: sheet.width is not a section but 0.068; nothing can be set in it",
        f"  --set a..b=1: {form}",
        '  mesh.sise: unknown key; did you mean "size"? Allowed here: accuracy, accuracy_of, '
        "adapt, corner_size, file, grip_size, growth, size",
    ]


def test_bad_overrides_of_a_good_case(case_file: Path) -> None:
    assert len(file_error(case_file, "title")) == 2


def test_a_syntax_error_names_the_line(case_file: Path) -> None:
    case_file.write_text('name = "x"\n[sheet\n')
    first, second = file_error(case_file)
    assert first == f"{case_file} is wrong:"
    assert second.startswith("  not TOML: ")
    assert "line 2" in second


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    missing = tmp_path / "none.toml"
    assert file_error(missing) == [f"{missing} is not found; give the path of a case file"]
    assert file_error(tmp_path) == [f"{tmp_path} cannot be read: Is a directory"]
    binary = tmp_path / "binary.toml"
    binary.write_bytes(b"a\xff")
    assert file_error(binary)[1:] == ["  not UTF-8 text, at byte 1"]
