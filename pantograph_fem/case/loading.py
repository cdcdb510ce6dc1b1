"""Cases from TOML files and tables, and back."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from copy import deepcopy
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ..errors import CaseError
from .kinds import KINDS
from .messages import case_error, explain
from .model import Case
from .overrides import apply_overrides
from .problem import not_allowed, one_of


def load_case(path: Path, overrides: Sequence[str] = ()) -> Case:
    """Read a case file.

    Parameters
    ----------
    path
        TOML file.
    overrides
        Values in place of those of the file, each as ``key.path=value``.

    Raises
    ------
    CaseError
        When the file cannot be read, is not TOML or does not describe a case. The message names
        the file and then lists every problem: its key, its value and what is allowed.
    """
    path = Path(path)
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise CaseError(f"{path} is not found; give the path of a case file") from None
    except OSError as error:
        raise CaseError(f"{path} cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise case_error(str(path), [f"not UTF-8 text, at byte {error.start}"]) from None
    except tomllib.TOMLDecodeError as error:
        raise case_error(str(path), [f"not TOML: {error}"]) from None
    problems = apply_overrides(data, overrides)
    source = " ".join([str(path), *(f"--set {override}" for override in overrides)])
    return _validated(data, path.resolve().parent, source, problems)


def case_from_dict(
    data: Mapping[str, Any], base: Path | None = None, overrides: Sequence[str] = ()
) -> Case:
    """Build a case from the tables of a case file.

    Parameters
    ----------
    data
        The file's keys and sections, nested.
    base
        Folder from which a relative ``mesh.file`` starts; the current folder by default.
    overrides
        Values in place of those of the tables, each as ``key.path=value``.

    Raises
    ------
    CaseError
        When it does not describe a case; the message lists every problem.
    """
    tables = deepcopy(dict(data))  # the caller's tables stay as they are
    problems = apply_overrides(tables, overrides)
    source = " ".join(["The case", *(f"--set {override}" for override in overrides)])
    return _validated(tables, base, source, problems)


def case_to_toml(case: Case) -> str:
    """Every value of a case, defaults included; loading the text gives an equal case."""
    import tomli_w

    return tomli_w.dumps(case.model_dump(mode="json", exclude_none=True))


def _validated(
    data: Mapping[str, Any], base: Path | None, source: str, problems: list[str]
) -> Case:
    kind = data.get("kind", "sheet")
    # alone, as which keys are allowed depends on it
    if not isinstance(kind, str) or kind not in KINDS:
        text = not_allowed(kind, f"be {one_of(KINDS)}")
        raise case_error(source, [*problems, f"kind: {text}"])
    model = KINDS[kind]
    try:
        case = model.model_validate(dict(data), context={"base": base})
    except ValidationError as error:
        raise case_error(source, problems + explain(error, model)) from None
    if problems:
        raise case_error(source, problems)
    return case
