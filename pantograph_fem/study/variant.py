"""A case in one discretisation, and the folder that is its own."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ..case import Case, case_to_toml
from .sizes import Sizes, sizes_of


@dataclass(frozen=True)
class Variant:
    """A case in one discretisation.

    Attributes
    ----------
    label
        Name of its folder.
    directory
        Where its results are, or will be; variants with the same case share it.
    case
        What to simulate.
    key, value
        Key of the case that is varied, and its value in TOML; empty in the matrix of schemes,
        degrees and meshes.
    """

    label: str
    directory: Path
    case: Any
    key: str = ""
    value: str = ""

    @property
    def scheme(self) -> str:
        """Scheme of the discretisation; the kind of what has none."""
        return _discretisation(self.case, "scheme") or self.case.kind

    @property
    def degree(self) -> int | None:
        """Degree of the displacement; None of what has none."""
        return _discretisation(self.case, "degree")

    @property
    def sizes(self) -> Sizes:
        """Sizes of the mesh, or the spacing."""
        return sizes_of(self.case)

    @property
    def series(self) -> str:
        """Scheme and degree in words."""
        return self.scheme if self.degree is None else f"{self.scheme}, degree {self.degree}"


@dataclass
class Placed:
    """Folders of the variants: one for each case, however often it takes part.

    Attributes
    ----------
    directory
        Folder of the folders.
    labels
        Labels given so far, by case.
    """

    directory: Path
    labels: dict[str, str] = field(default_factory=dict)

    def variant(self, case: Case, label: str = "") -> Variant:
        """The variant of a case; by default it is called by scheme, degree and sizes."""
        variant = Variant(label, self.directory, case)
        if not label:
            sizes, degree = variant.sizes, variant.degree
            parts = [variant.scheme, f"p{degree}" if degree is not None else ""]
            parts += [f"{size:.6g}" for size in (sizes.size, sizes.corner_size) if size is not None]
            label = "_".join(filter(None, parts))
        label = re.sub(r"[^\w.+=-]+", "_", label, flags=re.ASCII).strip("_.-")
        content, taken, number = case_to_toml(case), set(self.labels.values()), 2
        if content not in self.labels:
            unique = label
            while unique in taken:
                unique, number = f"{label}_{number}", number + 1
            self.labels[content] = unique
        label = self.labels[content]
        return replace(variant, label=label, directory=self.directory / label)


def _discretisation(case: Any, key: str) -> Any:
    return getattr(getattr(case, "discretisation", None), key, None)
