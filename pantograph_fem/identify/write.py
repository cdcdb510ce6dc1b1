"""All files and figures of an identification."""

from __future__ import annotations

from pathlib import Path

from .files import write_files
from .fit_figure import draw_fit
from .identify import Identification
from .profile_figure import draw_profiles
from .residual_figure import draw_residuals
from .states_figure import draw_states


def write(found: Identification) -> list[Path]:
    """Write everything to the directory of the identification and return the paths."""
    written = write_files(found)
    for name, draw, wanted in (
        ("fit.png", draw_fit, True),
        ("residuals.png", draw_residuals, True),
        ("states.png", draw_states, bool(found.experiment.case.measurements)),
        ("profile.png", draw_profiles, bool(found.profiles)),
    ):
        path = found.directory / name
        if wanted:
            draw(found, path)
            written.append(path)
        else:
            path.unlink(missing_ok=True)
    return written
