"""JSON that every reader takes: a number that is none is null."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from ..errors import CaseError


def to_json(value: object) -> str:
    """Text of nested mappings, sequences, texts and numbers, with a newline at its end."""
    return json.dumps(_finite(value), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def read_json(path: Path) -> dict[str, Any] | None:
    """Read the mapping in a file; None where there is no file.

    Raises
    ------
    CaseError
        If the file holds something else.
    """
    try:
        return dict(json.loads(path.read_text(encoding="utf-8")))
    except FileNotFoundError:
        return None
    except (ValueError, TypeError) as error:
        raise CaseError(f"{path} is damaged: {error}; run the case again") from error


def _finite(value: object) -> object:
    if isinstance(value, dict):
        return {key: _finite(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(inner) for inner in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
