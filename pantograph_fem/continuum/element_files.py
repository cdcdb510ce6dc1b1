"""The displacement on the elements themselves, with their degree, for ParaView.

Each state has files of its own in ``elements/``, which dolfinx writes, and ``elements.pvd`` lists
which of them is at which load. It lists what is complete, also while the run goes on.
"""

from __future__ import annotations

from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, parse

from dolfinx import fem, mesh

from .. import dolfinx_api as api
from ..parallel import at_root
from ..results.atomic import replace_xml
from ..results.elements import FOLDER, LIST
from ..results.space import require_space
from ..results.times import Times
from ..schemes import Discretisation

#: Of a node in the files, at most: its place, its displacement and its part in the cells.
_BYTES = 250


class ElementFiles:
    """Writes a discretisation's displacement, state by state; every method is collective.

    Parameters
    ----------
    discretisation
        Whose displacement it is.
    domain
        Its mesh.
    directory
        Where the list goes, and the folder of the states.
    kept
        Number of states already there to go on from; later ones are dropped.
    """

    def __init__(
        self, discretisation: Discretisation, domain: mesh.Mesh, directory: Path, kept: int = 0
    ) -> None:
        element = api.equispaced_lagrange(discretisation.degree, 2, domain)
        space = api.functionspace(domain, element)
        self._nodes = space.dofmap.index_map.size_global
        self._function = fem.Function(space, name="displacement")
        points = api.interpolation_points(space)
        self._displacement = api.expression(discretisation.displacement, points)
        self._comm = domain.comm
        self._directory = directory
        self._count = kept
        self._times = Times()
        self._root = Element("VTKFile", type="Collection", version="1.0")
        self._states = SubElement(self._root, "Collection")
        at_root(self._comm, lambda: self._keep(kept))

    def _keep(self, kept: int) -> None:
        path, folder = self._directory / LIST, self._directory / FOLDER
        if kept and path.is_file():
            for entry in parse(path).getroot().iter("DataSet"):
                if int(entry.attrib["number"]) < kept:
                    self._states.append(entry)
                    self._times.of(float(entry.attrib["timestep"]))
        else:
            path.unlink(missing_ok=True)
        folder.mkdir(parents=True, exist_ok=True)

    def write(self, load: float) -> None:
        """Add the discretisation's present state.

        Raises
        ------
        OSError
            If the disk is full; the list is unchanged then.
        """
        at_root(self._comm, lambda: require_space(self._directory, _BYTES * self._nodes))
        self._function.interpolate(self._displacement)
        alone = self._directory / FOLDER / f"state_{self._count:05d}.pvd"
        api.write_vtk(alone, self._function)
        at_root(self._comm, lambda: self._list(alone, load))
        self._count += 1

    def _list(self, alone: Path, load: float) -> None:
        """Take the state from a list of its own into that of all."""
        entry = next(parse(alone).getroot().iter("DataSet"))
        SubElement(
            self._states,
            "DataSet",
            timestep=repr(self._times.of(float(load))),
            number=str(self._count),
            file=f"{FOLDER}/{entry.attrib['file']}",
        )
        replace_xml(self._directory / LIST, self._root)
        alone.unlink()
