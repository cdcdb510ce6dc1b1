"""The command ``pantograph``."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from . import __version__
from .errors import CaseError, PantographError

if TYPE_CHECKING:
    from collections.abc import Callable

    from .case import Case
    from .run import RunResult

app = typer.Typer(
    name="pantograph",
    help="Simulate pantographic sheets and the nonlinear beams they are made of.",
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)

CaseFile = Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case file.")]
Overrides = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY.PATH=VALUE", help="Replace a value of the case; may be repeated."
    ),
]


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"pantograph_fem {__version__}")
        raise typer.Exit


@app.callback()
def _main(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_version, is_eager=True, help="Show the version."),
    ] = False,
) -> None:
    """Simulate pantographic sheets and the nonlinear beams they are made of."""


@app.command()
def run(
    case_file: CaseFile,
    output: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Where results go.", show_default="results/<name>"),
    ] = None,
    overrides: Overrides = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on from the last state of an interrupted run.")
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Show no progress.")] = False,
) -> None:
    """Simulate a case; also under mpirun."""
    from .case import load_case

    case = load_case(case_file, overrides or ())
    result = _solver()(case, output, resume=resume, quiet=quiet)
    if result.rows and not quiet:
        typer.echo(f"Done: {result.rows[-1].step} steps; results are in {result.directory}")


@app.command()
def check(case_file: CaseFile, overrides: Overrides = None) -> None:
    """Validate a case without simulating it."""
    from .case import load_case

    case = load_case(case_file, overrides or ())
    typer.echo(f"{case_file} is valid: {case.name} ({case.kind})")


@app.command()
def plot(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Results of a run.")],
) -> None:
    """Redraw the figures of a finished run."""
    from .plot import plot as plot_results

    for path in plot_results(directory):
        typer.echo(path)


@app.command()
def compare(
    what: Annotated[
        list[Path],
        typer.Argument(
            metavar="WHAT", help="Folders of results, case files, and at most one study file."
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Where runs and comparison go.",
            show_default="results/<name of the study>, or results/compare",
        ),
    ] = None,
    overrides: Overrides = None,
    rerun: Annotated[
        bool, typer.Option("--rerun", help="Run cases again whose results are there.")
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Show no progress.")] = False,
) -> None:
    """Put results side by side, with differences and orders of convergence.

    Cases are run first, unless their results are there. Without a study file differences are taken
    against the first of the results.
    """
    from .compare import compare as compare_results
    from .compare import write
    from .compare.table import print_table

    def runner() -> Callable[[Case, Path], RunResult]:
        solve = _solver()
        return lambda case, directory: solve(case, directory, quiet=quiet)

    show = _rank() == 0
    result = compare_results(
        what,
        output,
        overrides=overrides or (),
        rerun=rerun,
        runner=runner,
        tell=typer.echo if show and not quiet else lambda text: None,
    )
    if show:
        write(result.comparison, result.directory)
        print_table(result.comparison)
        for run in result.comparison.outcomes:
            if not run.done and run.entry.label not in result.stopped:
                typer.echo(f"{run.entry.label}: {run.status}")
        if not quiet:
            typer.echo(f"Tables and figures are in {result.directory}")
    if result.stopped:
        raise result.stopped_error()


@app.command()
def study(
    case_file: CaseFile,
    schemes: Annotated[
        list[str] | None,
        typer.Option("--scheme", metavar="SCHEME", help="A scheme; may be repeated."),
    ] = None,
    degrees: Annotated[
        list[int] | None,
        typer.Option("--degree", metavar="DEGREE", help="A degree; may be repeated."),
    ] = None,
    meshes: Annotated[
        list[str] | None,
        typer.Option(
            "--mesh",
            metavar="SIZE/CORNER",
            help="Element sizes inside and at the corners, m; may be repeated.",
            show_default="multiples of those of the case",
        ),
    ] = None,
    knobs: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            metavar="KEY.PATH=V1,V2,...",
            help="Values that a key takes, alone, in the case as it is; may be repeated.",
        ),
    ] = None,
    repeat: Annotated[
        int, typer.Option(metavar="N", help="Times each run is measured; the median counts.")
    ] = 1,
    reference: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR", help="Results to take errors against.", show_default="a finer run"
        ),
    ] = None,
    no_reference: Annotated[
        bool,
        typer.Option("--no-reference", help="Take errors against the limit of each series alone."),
    ] = False,
    output: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Where the study and its runs go.",
            show_default="results/study_<name>",
        ),
    ] = None,
    overrides: Overrides = None,
    rerun: Annotated[
        bool, typer.Option("--rerun", help="Measure runs again whose results are there.")
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Show no progress.")] = False,
) -> None:
    """Show what accuracy costs: one case with several schemes, degrees and meshes.

    Every combination is run in a process of its own, one at a time. A run that stops on its way is
    kept, without an error.
    """
    from .study import study as run_study
    from .study import write
    from .study.advice import advice
    from .study.plan import Wanted
    from .study.table import print_study

    if _processes() > 1:
        raise CaseError("`pantograph study` starts processes of its own; leave mpirun out")
    wanted = Wanted(
        schemes=schemes or (),
        degrees=degrees or (),
        meshes=meshes or (),
        knobs=knobs or (),
        overrides=overrides or (),
        reference=reference,
        with_reference=not no_reference,
    )
    result = run_study(
        case_file,
        output,
        wanted,
        repeat=repeat,
        rerun=rerun,
        tell=(lambda text: None) if quiet else typer.echo,
    )
    write(result)
    print_study(result)
    typer.echo("\n".join(advice(result)))
    if not quiet:
        typer.echo(f"Table and figures are in {result.plan.directory}")
    if failure := result.failure():
        raise failure


def _solver() -> Callable[..., RunResult]:
    """Import what simulates a case; only for a case that is right, as it takes seconds."""
    # The fronts of the factorisation are small: threads cost more than they bring.
    for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(threads, "1")
    import petsc4py

    # A closed pipe or an interrupt is no crash: no PETSc report of a segmentation fault.
    petsc4py.init(["pantograph", "-no_signal_handler"])
    from .run import run

    return run


def main() -> None:
    """Run the command and turn errors into messages and exit codes."""
    try:
        code = app(standalone_mode=False)
    except PantographError as error:
        _fail(str(error), error.exit_code)
    except (typer.Abort, KeyboardInterrupt):
        _fail("Interrupted. `pantograph run --resume` goes on from the last state.", 1)
    except Exception as error:
        # click's usage errors know how to show themselves
        show = getattr(error, "show", None)
        if show is None:
            raise
        show()
        raise SystemExit(2) from None
    raise SystemExit(code or 0)


def _fail(message: str, code: int) -> None:
    # Under mpirun every rank comes here with the same error; one message is enough.
    if _rank() == 0:
        print(message, file=sys.stderr, flush=True)
    raise SystemExit(code)


def _rank() -> int:
    # Known from the environment before MPI is imported; by Open MPI and by MPICH's kin.
    return int(os.environ.get("OMPI_COMM_WORLD_RANK") or os.environ.get("PMI_RANK") or 0)


def _processes() -> int:
    return int(os.environ.get("OMPI_COMM_WORLD_SIZE") or os.environ.get("PMI_SIZE") or 1)
