"""Sphinx's settings for the reference of the Python interface: ``make docs``."""

from __future__ import annotations

import re
from itertools import takewhile
from typing import TYPE_CHECKING

from pantograph_fem import __version__

if TYPE_CHECKING:
    from sphinx.application import Sphinx

project = "pantograph_fem"
version = release = __version__
copyright = "the authors of pantograph_fem"

extensions = ["sphinx.ext.autodoc", "sphinx.ext.mathjax", "sphinx.ext.napoleon"]
# `name` in a docstring is code, as elsewhere in Python.
default_role = "code"
napoleon_google_docstring = False
napoleon_use_ivar = True
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
python_maximum_signature_line_length = 80
toc_object_entries = False

html_theme = "alabaster"
html_theme_options = {
    "description": "Finite elements for pantographic sheets",
    "fixed_sidebar": True,
    "page_width": "1100px",
    "sidebar_width": "230px",
}
html_sidebars = {"**": ["about.html", "navigation.html", "searchbox.html"]}
html_show_sourcelink = False


def split_names(
    app: Sphinx, what: str, name: str, thing: object, options: object, lines: list[str]
) -> None:
    """Give each of several attributes that share a description one of its own."""
    for i in reversed(range(len(lines))):
        body = list(takewhile(lambda line: line.startswith("    "), lines[i + 1 :]))
        if body and re.fullmatch(r"\w+(, \w+)+", lines[i]):
            names = lines[i].split(", ")
            lines[i : i + 1 + len(body)] = [text for name in names for text in (name, *body)]


def setup(app: Sphinx) -> None:
    """Change docstrings before Napoleon reads them."""
    app.connect("autodoc-process-docstring", split_names, priority=400)
