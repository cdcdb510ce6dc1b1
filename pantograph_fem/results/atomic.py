"""Text files that are either the old or the new one, never half of one."""

import os
from pathlib import Path
from xml.etree.ElementTree import Element, indent, tostring


def replace_text(path: Path, text: str) -> None:
    """Replace the contents of a file in one step.

    The text is written to a file beside it, which then takes its name: a reader, or a run killed
    at any moment, never meets a partial file.
    """
    aside = path.with_name(path.name + ".part")
    with aside.open("w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(aside, path)


def replace_xml(path: Path, root: Element) -> None:
    """Replace the contents of a file in one step by a tree, a line for each of its elements."""
    indent(root)
    replace_text(path, f'<?xml version="1.0"?>\n{tostring(root, "unicode")}\n')
