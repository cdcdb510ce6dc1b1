"""Keys of a case that a study varies one at a time."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import CaseError


@dataclass(frozen=True)
class Knob:
    """A key of the case, and the values that it takes one after the other, as texts in TOML."""

    key: str
    values: tuple[str, ...]


def parse_knob(text: str) -> Knob:
    """Read ``key.path=v1,v2,...``; a comma within brackets or quotes belongs to the value.

    Raises
    ------
    CaseError
        If the text is not of this form, or gives a value twice.
    """
    key, equals, right = text.partition("=")
    values = tuple(value.strip() for value in _split(right))
    if not equals or not key.strip() or not all(values):
        raise CaseError(
            f"--vary {text} is not allowed; it must be of the form key.path=value,value,..., such "
            "as continuation.tolerance=1e-6,1e-8"
        )
    if len(set(values)) < len(values):
        raise CaseError(f"--vary {text} gives a value twice; each must differ from the others")
    return Knob(key.strip(), values)


def _split(text: str) -> list[str]:
    parts, depth, quote = [""], 0, ""
    for character in text:
        if quote:
            quote = "" if character == quote else quote
        elif character in "\"'":
            quote = character
        else:
            depth += (character in "[{") - (character in "]}")
        if character == "," and depth == 0 and not quote:
            parts.append("")
        else:
            parts[-1] += character
    return parts
