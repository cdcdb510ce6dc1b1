"""What a study runs: schemes, degrees and meshes, values of single keys, and a reference."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

from ..case import Case, load_case
from ..errors import CaseError
from .knob import Knob, parse_knob
from .sizes import default_series, finer_than, parse_sizes, size_overrides, sizes_of
from .variant import Placed, Variant

#: Pictures and fields are no part of what a result costs.
_NO_OUTPUT = ("output.figures=false", "output.report=false", "output.fields=none")


@dataclass(frozen=True)
class Plan:
    """The runs of a study.

    Attributes
    ----------
    name
        Title of the case, or its name.
    matrix
        A variant per scheme, degree and mesh, each series coarsest first.
    default
        The case as it is; None when no key is varied.
    varied
        A variant per value of each key that is varied.
    reference
        The run for the reference; None when there is none, or it is a folder of results.
    reference_directory
        Folder of results that is the reference.
    directory
        Where the study goes.
    left_out
        A line per combination of scheme and degree that the case does not allow.
    """

    name: str
    matrix: tuple[Variant, ...]
    default: Variant | None
    varied: tuple[Variant, ...]
    reference: Variant | None
    reference_directory: Path | None
    directory: Path
    left_out: tuple[str, ...] = ()

    @property
    def runs(self) -> list[Variant]:
        """All variants to run, in order."""
        single = [v for v in (self.default, *self.varied, self.reference) if v is not None]
        return [*self.matrix, *single]


@dataclass(frozen=True)
class Wanted:
    """What is asked for on the command line; empty where the case decides.

    Attributes
    ----------
    schemes, degrees
        Values of ``discretisation.scheme`` and ``discretisation.degree``.
    meshes
        Sizes, each as SIZE/CORNER_SIZE or SIZE in m.
    knobs
        Keys to vary, each as ``key.path=v1,v2``.
    overrides
        Values in place of those of the case file, each as ``key.path=value``.
    reference
        Folder of results that is the reference, in place of a finer run.
    with_reference
        Whether there is a reference.
    """

    schemes: Sequence[str] = ()
    degrees: Sequence[int] = ()
    meshes: Sequence[str] = ()
    knobs: Sequence[str] = ()
    overrides: Sequence[str] = ()
    reference: Path | None = None
    with_reference: bool = True


def make_plan(case_file: Path, output: Path | None, wanted: Wanted) -> Plan:
    """Make the cases of a study, and check all of them.

    Raises
    ------
    CaseError
        If anything given is wrong.
    """
    base = (*wanted.overrides, *_NO_OUTPUT)
    case = load_case(case_file, base)
    if wanted.reference is not None and not wanted.with_reference:
        raise CaseError("--reference and --no-reference exclude each other; give one of them")
    directory = output or Path("results") / f"study_{case.name}"
    sizes_of(case)  # refuses a mesh that cannot be refined
    series = [parse_sizes(text, case) for text in wanted.meshes] or default_series(case)
    series.sort(key=lambda sizes: (-sizes.size, -(sizes.corner_size or 0)))
    for sizes, following in pairwise(series):
        if sizes == following:
            raise CaseError(f"--mesh: the mesh of {sizes.text} is given twice; give it once")
    combinations, left_out = _combinations(case_file, case, base, wanted)

    placed = Placed(directory / "runs")
    matrix = [
        placed.variant(load_case(case_file, (*base, *chosen, *size_overrides(case, sizes))))
        for chosen in combinations
        for sizes in series
    ]
    if len({variant.directory for variant in matrix}) < len(matrix):
        raise CaseError("--mesh: two spacings are the same once fitted to the case; give others")
    knobs = [parse_knob(text) for text in wanted.knobs]
    default = placed.variant(case, label="default") if knobs else None
    varied = [
        replace(
            placed.variant(load_case(case_file, (*base, f"{key}={value}")), f"{key}={value}"),
            key=key,
            value=value,
        )
        for key, value in _each(knobs)
    ]
    reference = None
    if wanted.with_reference and wanted.reference is None:
        # of the highest degree, and of the hinge scheme if that takes part: a third of the unknowns
        best = max(matrix, key=lambda v: (v.scheme == "hinge", v.degree or 0))
        chosen = combinations[matrix.index(best) // len(series)]
        finer = (*base, *chosen, *size_overrides(case, finer_than(series)))
        reference = placed.variant(load_case(case_file, finer), label="reference")
    return Plan(
        case.title or case.name,
        tuple(matrix),
        default,
        tuple(varied),
        reference,
        wanted.reference,
        directory,
        tuple(left_out),
    )


def _each(knobs: Iterable[Knob]) -> Iterable[tuple[str, str]]:
    return ((knob.key, value) for knob in knobs for value in knob.values)


def _combinations(
    case_file: Path, case: Case, base: Sequence[str], wanted: Wanted
) -> tuple[list[tuple[str, ...]], list[str]]:
    """Overrides for each scheme and degree that go together, and what does not."""
    if not hasattr(case, "discretisation"):
        if wanted.schemes or wanted.degrees:
            option = "--scheme" if wanted.schemes else "--degree"
            raise CaseError(
                f"{option}: a {case.kind} is a net of springs, without schemes and degrees; "
                "leave it out"
            )
        return [()], []
    schemes = dict.fromkeys(f"discretisation.scheme={scheme}" for scheme in wanted.schemes)
    degrees = dict.fromkeys(f"discretisation.degree={degree}" for degree in wanted.degrees)
    pairs = [(s, d) for s in schemes or [""] for d in degrees or [""]]
    found, refused = [], {}
    for pair in pairs:
        chosen = tuple(filter(None, pair))
        try:
            load_case(case_file, (*base, *chosen))
        except CaseError as error:
            refused[pair] = error
        else:
            found.append(chosen)
    # What goes with nothing else is wrong in itself.
    for asked in (*schemes, *degrees):
        if not any(asked in chosen for chosen in found):
            raise next(error for pair, error in refused.items() if asked in pair)
    names = (" ".join(pair).replace("discretisation.", "") for pair in refused)
    return found, [f"{name}: the case does not allow the two together" for name in names]
