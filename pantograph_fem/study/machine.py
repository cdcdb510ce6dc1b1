"""What a run was timed on."""

from __future__ import annotations

import os
import platform
import re
from pathlib import Path


def machine() -> str:
    """Model and number of processor cores, and the system."""
    try:
        found = re.search(r"^model name\s*:\s*(.+)$", Path("/proc/cpuinfo").read_text(), re.M)
    except OSError:
        found = None
    model = found[1].strip() if found else platform.processor() or platform.machine()
    count = os.cpu_count() or 1
    cores = "1 core" if count == 1 else f"{count} cores"
    return f"{model}, {cores}, {platform.system()} {platform.machine()}"
