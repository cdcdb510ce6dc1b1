"""Case files of beams, chains and lattices: defaults, rules and messages."""

import math
from pathlib import Path

import pytest

from pantograph_fem.case import case_from_dict, case_to_toml, load_case
from pantograph_fem.errors import CaseError

from .conftest import merged

CASES = Path(__file__).parents[1] / "cases"
KINDS = ("beam", "chain", "lattice")

BEAM = {
    "name": "beam",
    "kind": "beam",
    "beam": {"length": 2.0},
    "material": {"stretch": 1e6, "bending": 1e3},
}
CHAIN = merged(BEAM, {"kind": "chain", "chain": {"spacing": 0.3}})
LATTICE = {
    "name": "lattice",
    "kind": "lattice",
    "sheet": {"width": 0.068, "height": 0.204},
    "material": {"stretch": 1.34e5, "bending": 1.92e-2, "shear": 159.0},
    "lattice": {"spacing": 0.0048},
}


def problems(base=BEAM, **changes):
    with pytest.raises(CaseError) as error:
        case_from_dict(merged(base, changes))
    return [line.strip() for line in str(error.value).splitlines()[1:]]


@pytest.mark.parametrize("base", [BEAM, CHAIN, LATTICE], ids=lambda base: base["kind"])
def test_the_resolved_text_gives_an_equal_case(tmp_path, base):
    case = case_from_dict(base)
    path = tmp_path / "case.toml"
    path.write_text(case_to_toml(case))
    assert load_case(path) == case


@pytest.mark.parametrize(
    "path",
    [path for kind in KINDS for path in sorted(CASES.glob(f"{kind}_*.toml"))],
    ids=lambda path: path.stem,
)
def test_shipped_cases_are_named_as_their_files(path):
    case = load_case(path)
    assert case.name == path.stem
    assert path.stem.startswith(case.kind)


def test_a_beam_is_a_cantilever_by_default():
    case = case_from_dict(BEAM)
    assert (case.ends.left.support, case.ends.right.support) == ("clamped", "free")
    assert case.mesh.size == 2.0 / 64
    assert (case.discretisation.degree, case.discretisation.auxiliary_degree) == (4, 3)
    assert case.material.foundation is None


def test_links_are_a_whole_number():
    assert case_from_dict(CHAIN).chain.spacing == pytest.approx(2.0 / 7)


@pytest.mark.parametrize(("asked", "periods"), [(0.0048, 10), (0.0024, 20), (0.0096, 5)])
def test_the_spacing_of_a_lattice_fits_the_sheet(asked, periods):
    case = case_from_dict(merged(LATTICE, {"lattice": {"spacing": asked}}))
    assert case.lattice.spacing == pytest.approx(0.068 / periods / math.sqrt(2), rel=1e-12)


def test_a_spacing_that_cannot_fit_stays_as_it_is():
    case = case_from_dict(merged(LATTICE, {"sheet": {"fibre_angle": 30.0}}))
    assert case.lattice.spacing == 0.0048


def test_a_foundation_is_a_number_or_pieces():
    uniform = case_from_dict(merged(BEAM, {"material": {"foundation": 5}})).material
    assert uniform.pieces(2.0) == ((2.0, 5.0),)
    pieces = [{"to": 0.5, "stiffness": 1e6}, {"to": 2.0, "stiffness": 0.0}]
    two = case_from_dict(merged(BEAM, {"material": {"foundation": pieces}})).material
    assert two.pieces(2.0) == ((0.5, 1e6), (2.0, 0.0))
    none = case_from_dict(merged(BEAM, {"material": {"foundation": 0.0}})).material
    assert none.foundation is None


@pytest.mark.parametrize("foundation", [[], "soft", -1.0, True, float("nan")])
def test_what_a_foundation_is_not(foundation):
    (line,) = problems(material={"foundation": foundation})
    assert line.startswith("material.foundation: ")
    assert "it must be a finite number, 0 or greater, or a list of pieces" in line


def test_the_pieces_of_a_foundation_cover_the_beam():
    pieces = [{"to": 1.5, "stiffness": 1e6}, {"to": 1.0, "stiffness": 1e6}]
    (line,) = problems(material={"foundation": pieces})
    assert line == (
        "material.foundation: [1.5, 1.0] is not allowed; it must have increasing ends, "
        "the last of them beam.length (2.0)"
    )


def test_a_beam_needs_its_stretch_stiffness():
    (line,) = problems(material={"stretch": 0.0})
    assert line.startswith("material.stretch: missing; it is required and must be greater than 0")


def test_unknown_keys_name_the_nearest():
    missing, unknown = problems(ends={"right": {"suport": "pinned"}})
    assert missing.startswith("ends.right.support: missing; it is required and must be ")
    assert unknown.startswith('ends.right.suport: unknown key; did you mean "support"?')


@pytest.mark.parametrize(
    ("end", "key", "rule"),
    [
        ({"support": "free", "translation": [0.1, 0.0]}, "translation", "absent at a free end"),
        ({"support": "roller", "rotation": 10.0}, "rotation", "absent at a roller end"),
        ({"support": "pinned", "force": [1.0, 0.0]}, "force", "absent at a pinned end"),
        ({"support": "roller", "force": [1.0, 1.0]}, "force", "be [N, 0] at a roller"),
        ({"support": "clamped", "moment": 1.0}, "moment", "absent at a clamped end"),
    ],
)
def test_an_end_gets_only_what_its_support_allows(end, key, rule):
    (line,) = problems(ends={"right": end})
    assert line.startswith(f"ends.right.{key}: ")
    assert rule in line


@pytest.mark.parametrize(
    ("left", "right"), [("free", "free"), ("pinned", "free"), ("roller", "roller")]
)
def test_a_beam_that_could_move_as_a_whole_is_refused(left, right):
    ends = {"left": {"support": left}, "right": {"support": right}}
    (line,) = problems(ends=ends)
    assert line.startswith(f'ends: supports "{left}" and "{right}" are not allowed: the beam could')
    # A foundation holds it, too.
    case_from_dict(merged(BEAM, {"ends": ends, "material": {"foundation": 1.0}}))


def test_a_string_has_no_direction_to_hold():
    lines = problems(material={"bending": None}, ends={"right": {"support": "free", "moment": 1.0}})
    assert [line.split(": ")[0] for line in lines] == ["ends.left.support", "ends.right.moment"]


def test_sizes_are_within_the_body():
    (line,) = problems(mesh={"size": 3.0})
    assert line == "mesh.size: 3.0 is not allowed; it must be at most beam.length (2.0)"
    (line,) = problems(CHAIN, chain={"spacing": 1.5})
    assert line.startswith("chain.spacing: 1.5 is not allowed; it must be at most half of")
    (line,) = problems(LATTICE, lattice={"spacing": 0.05})
    assert line.startswith("lattice.spacing: 0.05 is not allowed; it must be at most 0.034 m")


def test_probes_lie_on_the_axis():
    (line,) = problems(output={"probes": [[1.0, 0.0], [1.0, 0.1]]})
    assert line.startswith("output.probes[1]: [1.0, 0.1] is not allowed; it must lie on the beam's")


def test_a_lattice_clamp_needs_bending():
    (line,) = problems(LATTICE, material={"bending": None}, grips={"top": {"hold": "clamp"}})
    assert line.startswith("grips.top.hold: ")


def test_sections_of_another_kind_are_unknown():
    (line,) = problems(sheet={"width": 1.0, "height": 1.0})
    assert line.startswith("sheet: unknown key")
    (line,) = problems(LATTICE, mesh={"size": 0.01})
    assert line.startswith("mesh: unknown key")
