"""The command ``pantograph``."""

from __future__ import annotations

import select
import sys
import time
import traceback
from typing import Annotated

import typer

from . import __version__
from .commands.check import check
from .commands.compare import compare
from .commands.ending import abort, alone, guarded
from .commands.identify import identify
from .commands.plot import plot
from .commands.processes import rank
from .commands.run import run
from .commands.stress import stress
from .commands.study import study
from .commands.sweep import sweep
from .errors import PantographError

#: Seconds that the first process has to say what is wrong before MPI has started.
_HEAD_START = 5.0

#: What Typer returns after Ctrl-C.
_BY_INTERRUPT = 130
_INTERRUPTED = "Interrupted. `pantograph run --resume` goes on from the last state."

app = typer.Typer(
    name="pantograph",
    help="Simulate pantographic sheets and the nonlinear beams they are made of.",
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)
for command in (run, check, plot, compare, study, sweep, stress, identify):
    app.command()(command)


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


def main() -> None:
    """Run the command and turn errors into messages and exit codes."""
    try:
        code = app(standalone_mode=False)
    except PantographError as error:
        _fail(str(error), error.exit_code)
    except SystemExit as ended:
        # Typer ends without a word where a pipe is broken. Who reads our output may go away; any
        # other pipe is an error like others.
        if isinstance(ended.__context__, BrokenPipeError) and not _reader_is_gone():
            traceback.print_exception(ended.__context__)
        raise
    except (typer.Abort, KeyboardInterrupt):
        _fail(_INTERRUPTED, 1)
    except Exception as error:
        # click's usage errors know how to show themselves
        show = getattr(error, "show", None)
        if show is None:
            if alone():
                traceback.print_exc()
                abort(1)
            raise
        show()
        raise SystemExit(2) from None
    if code == _BY_INTERRUPT:
        _fail(_INTERRUPTED, 1)
    raise SystemExit(code or 0)


def _reader_is_gone() -> bool:
    """Whether what we print to is a pipe that nobody reads from any more."""
    outputs = select.poll()
    for descriptor in (1, 2):
        outputs.register(descriptor, 0)
    return any(events & select.POLLERR for _, events in outputs.poll(0))


def _fail(message: str, code: int) -> None:
    # Under mpirun every rank comes here with the same error; one message is enough.
    lone = alone()
    if lone:
        message = f"Process {rank()} alone: {message}"
    if rank() == 0 or lone:
        print(message, file=sys.stderr, flush=True)
    if lone:
        abort(code)
    if rank() > 0 and not guarded():
        time.sleep(_HEAD_START)  # mpirun ends the others, unheard, when one process has failed
    raise SystemExit(code)
