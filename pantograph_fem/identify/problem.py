"""What is identified: the experiment, its constants and the data, ready to be fitted."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from ..case import SheetCase, load_case
from ..errors import CaseError
from .data import Datum, read_data
from .parameters import Parameter
from .responses import response_columns
from .study import IdentifyStudy

#: Newton's tolerance, in typical sizes: derivatives need states that are exact.
_TOLERANCE = 1e-11
#: γ of a model that is built to have another; 2 would have no use for an exponent.
_SOME_EXPONENT = 1.5


@dataclass(frozen=True, eq=False)
class Experiment:
    """A case whose constants are looked for.

    Attributes
    ----------
    case
        The experiment as it is in the case file.
    parameters
        Constants that are looked for.
    columns
        What can be measured.
    distance
        Displacement of the top grip from the bottom one at full load, m.
    """

    case: SheetCase
    parameters: tuple[Parameter, ...]
    columns: tuple[str, ...]
    distance: float

    @property
    def model_case(self) -> SheetCase:
        """The case to compute, with all effects whose constants are looked for."""
        starts = {p.name: p.start for p in self.parameters}
        if "shear_exponent" in starts:
            starts["shear_exponent"] = _SOME_EXPONENT
        options = self.case.continuation
        tolerance = min(_TOLERANCE, options.tolerance)
        return self.case.model_copy(
            update={
                "material": self.case.material.model_copy(update=starts),
                "continuation": options.model_copy(update={"tolerance": tolerance}),
                "output": self.case.output.model_copy(update={"eigenvalues": False}),
            }
        )


def experiment_of(study: IdentifyStudy, folder: Path) -> Experiment:
    """Read the case of a study in a folder.

    Raises
    ------
    CaseError
        If the case is wrong, or none whose constants can be identified.
    """
    path = folder / study.case
    case = load_case(path, study.set)
    if not isinstance(case, SheetCase):
        raise CaseError(f"{path} is a {case.kind}; constants are identified of a sheet")
    if case.mesh.adapt:
        raise CaseError(f"{path}: constants are identified on one mesh; set mesh.adapt = false")
    parameters = study.constants.parameters()
    names = {p.name for p in parameters}
    if "shear_exponent" in names and case.material.shear is None and "shear" not in names:
        raise CaseError("constants.shear_exponent: the case has no shear, whose exponent it is")
    top, bottom = case.grips.top.translation, case.grips.bottom.translation
    distance = math.hypot(top[0] - bottom[0], top[1] - bottom[1])
    return Experiment(case, parameters, response_columns(case), distance)


def measured(study: IdentifyStudy, folder: Path, experiment: Experiment) -> list[Datum]:
    """All data of a study.

    Raises
    ------
    CaseError
        If a file is wrong, or there are fewer data than constants.
    """
    data: list[Datum] = []
    for file in study.data:
        path = folder / file.file
        data += read_data(file, path, experiment.columns, experiment.distance)
    useful = sum(datum.load > 0 for datum in data)
    if useful < len(experiment.parameters):
        raise CaseError(
            f"{useful} measured values cannot tell {len(experiment.parameters)} constants; "
            "give more data, or look for fewer constants"
        )
    return data
