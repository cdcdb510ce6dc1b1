"""``pantograph plot``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def plot(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Results of a run.")],
) -> None:
    """Redraw the figures of a run, and write its report anew."""
    from ..plot import plot as plot_results
    from ..results.report import write_report

    for path in plot_results(directory):
        typer.echo(path)
    typer.echo(write_report(directory))
