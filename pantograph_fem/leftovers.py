"""What an earlier run has left in a directory of results."""

from __future__ import annotations

from pathlib import Path

from . import checkpoint
from .adapt import MESH_FILE
from .results.elements import FOLDER, LIST
from .results.failure import FAILURE_FILE
from .results.fields import H5_NAME, XDMF_NAME
from .results.report import REPORT_FILE


def remove_leftovers(
    directory: Path, *, kept_rows: int, kept_states: int, elements: bool, adapted: bool
) -> None:
    """Remove what a new run does not go on from.

    Parameters
    ----------
    directory
        Of results.
    kept_rows, kept_states
        Number of rows and states that the run goes on from.
    elements
        Whether it writes states on the elements.
    adapted
        Whether its mesh is adapted.
    """
    stale = [directory / name for name in ("summary.json", FAILURE_FILE, REPORT_FILE)]
    stale += directory.glob("figures/*.png")
    if not kept_rows:
        stale += [directory / checkpoint.NAME]
    if not kept_states:
        stale += [directory / XDMF_NAME, directory / H5_NAME]
    if not (kept_states and elements):
        stale += [directory / LIST, *directory.glob(f"{FOLDER}/*")]
    if not adapted:
        stale += [directory / MESH_FILE]
    for path in stale:
        path.unlink(missing_ok=True)
    for folder in (directory / "figures", directory / FOLDER):
        if folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()
