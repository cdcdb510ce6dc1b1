"""Room on the disk, looked at before it is needed."""

from __future__ import annotations

import errno
import os
import shutil
from pathlib import Path

#: Bytes beyond the data: indices, and the small files of the same state.
_MARGIN = 2**16


def require_space(directory: Path, size: int) -> None:
    """Raise if the disk of a folder has no room for so many bytes.

    HDF5, unlike other writers, does not survive a full disk: it brings the process down.

    Raises
    ------
    OSError
        As a writer would, without having written anything.
    """
    if shutil.disk_usage(directory).free < size + _MARGIN:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
