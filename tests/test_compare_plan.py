"""What may be compared, and the sentences with which anything else is refused."""

from pathlib import Path

import pytest
import tomli_w

from pantograph_fem.compare.plan import make_plan
from pantograph_fem.errors import CaseError

from .conftest import COARSE, merged

STUDIES = Path(__file__).parents[1] / "studies"
RUN = {"case": "case.toml", "label": "first"}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "case.toml").write_text(tomli_w.dumps(COARSE))
    return tmp_path


def study_file(folder, *runs, file="study.toml", **keys):
    path = folder / file
    path.write_text(tomli_w.dumps({**keys, "runs": list(runs)}))
    return path


def refused(*what, **keys):
    keys = {"output": None, "overrides": ()} | keys
    with pytest.raises(CaseError) as caught:
        make_plan(what, keys["output"], keys["overrides"])
    return str(caught.value)


def test_a_study_sets_values_in_turn_and_places_its_runs(folder):
    path = study_file(
        folder,
        RUN | {"set": ["material.stretch=3.0", "material.shear=4.0"], "reference": True},
        RUN | {"label": "lattice, 4.8 mm", "parameter": 4.8},
        set=["material.stretch=2.0", "mesh.size=0.03"],
    )
    plan = make_plan([path], folder / "out", ["material.shear=5.0"])
    first, second = plan.entries
    # those of a run go over those of the study, and the command's over both
    assert (first.case.material.stretch, first.case.material.shear) == (3.0, 5.0)
    assert (second.case.material.stretch, second.case.material.shear) == (2.0, 5.0)
    assert first.case.mesh.size == second.case.mesh.size == 0.03
    assert (first.reference, second.reference) == (True, False)
    assert second.parameter == 4.8
    assert first.directory == folder / "out" / "first"
    assert second.directory == folder / "out" / "lattice_4.8_mm"


def test_names_and_folders_have_defaults(folder, monkeypatch):
    path = study_file(folder, RUN, file="stiff.toml")
    assert make_plan([path], None, ()).directory.as_posix() == "results/stiff"
    plan = make_plan([folder / "case.toml"], None, ())
    assert plan.directory.as_posix() == "results/compare"
    assert plan.entries[0].label == "coarse"


def test_without_a_study_the_first_is_the_reference(folder):
    (folder / "old").mkdir()
    plan = make_plan([folder / "old", folder / "case.toml"], None, ())
    assert [entry.label for entry in plan.entries] == ["old", "coarse"]
    assert [entry.reference for entry in plan.entries] == [True, False]
    assert plan.entries[0].directory == folder / "old"
    assert plan.entries[0].case is None


def test_runs_of_the_same_name_are_called_by_their_path(folder):
    (folder / "other.toml").write_text(tomli_w.dumps(merged(COARSE, {"title": "other"})))
    paths = [folder / "case.toml", folder / "other.toml"]
    entries = make_plan(paths, None, ()).entries
    assert [entry.label for entry in entries] == [f"coarse ({path})" for path in paths]
    assert entries[0].directory != entries[1].directory


@pytest.mark.parametrize(
    ("runs", "keys", "sentence"),
    [
        ([], {}, "runs: [] is not allowed; it must be at least one table [[runs]]"),
        ([RUN], {"titel": "x"}, 'titel: unknown key; did you mean "title"? Allowed here: expected'),
        (
            [RUN | {"labl": "x"}],
            {},
            'runs[0].labl: unknown key; did you mean "label"? Allowed here: case, label, '
            "parameter, reference, set",
        ),
        (
            [{"case": "case.toml"}],
            {},
            "runs[0].label: missing; it is required and must be a string",
        ),
        ([RUN | {"label": " "}], {}, 'runs[0].label: " " is not allowed; it must be one line'),
        ([RUN | {"set": "a=1"}], {}, 'runs[0].set: "a=1" is not allowed; it must be a list of'),
        ([RUN | {"parameter": "4"}], {}, 'runs[0].parameter: "4" is not allowed; it must be a num'),
        (
            [RUN | {"reference": True}, RUN | {"label": "b", "reference": True}],
            {},
            "runs[1].reference: true is not allowed; it must be false, as runs[0] is the reference",
        ),
        (
            [RUN | {"parameter": 2.0}, RUN | {"label": "b", "parameter": 2.0}],
            {},
            "runs[1].parameter: 2.0 is not allowed; it must differ from the parameters of the runs",
        ),
        ([RUN], {"quantities": ["energy", "energy"]}, "it must be a list of different strings"),
        ([RUN], {"load": 1.5}, "load: 1.5 is not allowed; it must be greater than 0 and at most 1"),
        ([RUN], {"name": "../x"}, 'name: "../x" is not allowed; it must be a plain file name'),
        ([RUN], {"expected_order": 0.0}, "expected_order: 0.0 is not allowed; it must be greater"),
        ([RUN], {"marks": [{"x": "1", "label": "m"}]}, 'marks[0].x: "1" is not allowed; it must'),
        ([RUN], {"marks": 3}, "marks: 3 is not allowed; it must be tables [[marks]]"),
        (["x"], {}, 'runs[0]: "x" is not allowed; it must be a table with the keys case, label'),
        (
            [RUN | {"set": ["material.shear=-1"]}],
            {},
            "material.shear: -1 is not allowed; it must be 0 or greater",
        ),
        ([RUN | {"case": "no.toml"}], {}, "no.toml is not found; give the path of a case file"),
    ],
)
def test_a_wrong_study_is_refused(folder, runs, keys, sentence):
    path = study_file(folder, *runs, **keys)
    message = refused(path)
    assert message.startswith(f"{path} is wrong:\n")
    assert sentence in message


def test_all_problems_of_a_study_are_told_at_once(folder):
    path = study_file(folder, RUN | {"lable": "x"}, {"label": "b"}, load=2.0)
    lines = refused(path).splitlines()
    assert [line.split(":")[0].strip() for line in lines[1:]] == [
        "runs[0].lable",
        "runs[1].case",
        "load",
    ]


def test_labels_must_be_different_also_as_folders(folder):
    path = study_file(folder, RUN | {"label": "4.8 mm"}, RUN | {"label": "4.8_mm"})
    assert 'the runs "4.8 mm" and "4.8_mm" would share the folder' in refused(path)
    case = folder / "case.toml"
    assert "two runs are called" in refused(case, case)


def test_what_is_not_there_or_no_toml_is_refused(folder):
    assert refused(folder / "no") == (
        f"{folder / 'no'} is not found; give a folder of results, a case file or a study file"
    )
    (folder / "bad.toml").write_text("name = [")
    assert "not TOML" in refused(folder / "bad.toml")
    (folder / "bad.toml").write_bytes(b"\xff")
    assert "not UTF-8 text, at byte 0" in refused(folder / "bad.toml")


def test_two_studies_are_refused(folder):
    paths = [study_file(folder, RUN, file=file) for file in ("a.toml", "b.toml")]
    assert "are both study files" in refused(*paths)


def test_set_without_anything_to_run_is_refused(folder):
    message = refused(folder, overrides=["mesh.size=0.01"])
    assert message.startswith("--set mesh.size=0.01: nothing is run here")


#: Studies of `compare`; those of `identify` and `sweep` are named after their commands.
SHIPPED = [
    path
    for path in sorted(STUDIES.glob("*.toml"))
    if not path.stem.startswith(("identify_", "sweep_"))
]


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_every_shipped_study_is_valid(path):
    plan = make_plan([path], None, ())
    assert plan.directory == Path("results", path.stem)
    assert sum(entry.reference for entry in plan.entries) == 1
    assert len({entry.case.model_dump_json() for entry in plan.entries}) == len(plan.entries)
