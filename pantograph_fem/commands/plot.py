"""``pantograph plot``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def plot(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Results of a run.")],
) -> None:
    """Redraw the figures of a finished run."""
    from ..plot import plot as plot_results

    for path in plot_results(directory):
        typer.echo(path)
