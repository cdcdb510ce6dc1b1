"""The case files shipped with the package against the text of the paper (Sect. 3.2)."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from pantograph_fem.case import SheetCase, load_case

FOLDER = Path(__file__).parents[1] / "cases"
W, H = 0.068, 0.204


def case(name: str) -> SheetCase:
    return load_case(FOLDER / f"{name}.toml")


@pytest.mark.parametrize("path", sorted(FOLDER.glob("[abcd]_*.toml")), ids=lambda path: path.stem)
def test_the_sheet_is_that_of_the_paper(path: Path) -> None:
    case = load_case(path)
    assert case.name == path.stem
    assert "Fig. " in case.title
    assert (case.sheet.width, case.sheet.height, case.sheet.fibre_angle) == (W, H, 45.0)
    assert case.material.stretch_pair == (1.34e5, 1.34e5)
    assert case.material.bending_pair == (1.92e-2, 1.92e-2)
    assert (case.material.shear, case.material.shear_exponent) == (1.59e2, 1.36)
    assert {case.grips.bottom.hold, case.grips.top.hold} == {"position"}
    assert case.grips.bottom.translation == (0.0, 0.0)


def test_case_a_stops_at_the_measured_displacements() -> None:
    a = case("a_bias_extension")
    x, y = a.grips.top.translation
    assert (x, y, a.grips.top.rotation, a.grips.bottom.rotation) == (0.0, 0.0567, 0.0, 0.0)
    measured = [0.0143, 0.0232, 0.0321, 0.0411, 0.0500, 0.0567]
    assert [stop * y for stop in a.continuation.stops] == pytest.approx(measured, rel=0, abs=1e-15)


def test_case_b_shears_towards_minus_x() -> None:
    b = case("b_shear")
    x, y = b.grips.top.translation
    assert (y, b.grips.top.rotation, b.grips.bottom.rotation) == (0.0, 0.0, 0.0)
    assert [stop * x for stop in b.continuation.stops] == pytest.approx([-W, -1.5 * W, -2 * W])


@pytest.mark.parametrize("degrees", [20, 30, 45])
def test_case_c_turns_the_top_about_its_centre(degrees: int) -> None:
    c = case(f"c_rotation_{degrees}")
    assert c.grips.top.translation == pytest.approx((0.0, W / 2))
    assert (c.grips.top.rotation, c.grips.top.pivot) == (degrees, "centre")
    assert c.grips.bottom.rotation == 0.0


@pytest.mark.parametrize(
    ("picture", "shortening", "angle"),
    [(1, 0.0, math.pi / 9), (2, W, math.pi / 9), (3, 1.5 * W, math.pi / 3)],
)
def test_case_d_compresses(picture: int, shortening: float, angle: float) -> None:
    grips = case(f"d_compression_{picture}").grips
    assert math.radians(grips.top.rotation) == pytest.approx(angle)
    assert math.radians(grips.bottom.rotation) == pytest.approx(-angle)
    assert (grips.bottom.pivot, grips.top.pivot) == ("left", "left")
    assert grips.top.translation == pytest.approx((0.0, -shortening))
