"""The index ``fields.xdmf``: which arrays of ``fields.h5`` make up the state at which load."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, parse

from .atomic import replace_xml
from .times import Times

Shape = tuple[int, ...]

#: What XDMF calls cells, by their number of nodes.
TOPOLOGY = {
    2: {"TopologyType": "Polyline", "NodesPerElement": "2"},
    3: {"TopologyType": "Triangle"},
}


@dataclass(frozen=True)
class Dataset:
    """An array in an HDF5 file beside the index: its file, its path in it and its shape."""

    file: str
    path: str
    shape: Shape


@dataclass(frozen=True)
class StateEntry:
    """A state in the index: its load factor, and the path of each field's array by name.

    Fields of nodes and of cells are apart: they may share a name, and their numbers may be equal.
    """

    load: float
    paths: dict[str, str]
    cell_paths: dict[str, str]


class XdmfIndex:
    """An XDMF 3 collection of states of one grid, in memory; `save` writes it.

    The grid's cells, of shape (m, 3) or (m, 2), are triangles or lines.
    """

    def __init__(self, points: Dataset, cells: Dataset) -> None:
        self._points = points
        self._cells = cells
        self._times = Times()
        self._root = Element("Xdmf", Version="3.0")
        self._states = SubElement(
            SubElement(self._root, "Domain"),
            "Grid",
            Name="states",
            GridType="Collection",
            CollectionType="Temporal",
        )

    def add(
        self, load: float, fields: Mapping[str, Dataset], cell_fields: Mapping[str, Dataset]
    ) -> None:
        """Add a state; a field of nodes or cells is a scalar or a vector, as its shape says."""
        # Every state names the points and cells again rather than by XInclude, which readers
        # support unevenly; the arrays themselves are stored once.
        state = SubElement(self._states, "Grid", Name="state", GridType="Uniform")
        SubElement(state, "Time", Value=repr(self._times.of(load)))
        number, nodes = self._cells.shape
        shape = {**TOPOLOGY[nodes], "NumberOfElements": str(number)}
        topology = SubElement(state, "Topology", shape)
        _add_item(topology, self._cells, "Int")
        geometry = SubElement(state, "Geometry", GeometryType="XYZ")
        _add_item(geometry, self._points, "Float")
        for centre, datasets in (("Node", fields), ("Cell", cell_fields)):
            for name, dataset in datasets.items():
                kind = "Scalar" if len(dataset.shape) == 1 else "Vector"
                attribute = SubElement(
                    state, "Attribute", Name=name, AttributeType=kind, Center=centre
                )
                _add_item(attribute, dataset, "Float")

    def save(self, path: Path) -> None:
        """Write the index, replacing an earlier one in one step."""
        replace_xml(path, self._root)


def read_index(path: Path) -> list[StateEntry]:
    """Read the states that an index written by `XdmfIndex` lists.

    Raises
    ------
    ValueError, LookupError, SyntaxError
        If it is none.
    """
    return [
        StateEntry(
            load=float(_child(state, "Time").attrib["Value"]),
            paths=_paths(state, "Node"),
            cell_paths=_paths(state, "Cell"),
        )
        for state in _child(parse(path).getroot(), "Domain/Grid").findall("Grid")
    ]


def _paths(state: Element, centre: str) -> dict[str, str]:
    return {
        attribute.attrib["Name"]: (attribute.findtext("DataItem") or "").split(":")[1]
        for attribute in state.findall("Attribute")
        if attribute.attrib["Center"] == centre
    }


def _child(element: Element, tag: str) -> Element:
    found = element.find(tag)
    if found is None:
        raise LookupError(f"<{element.tag}> has no <{tag}>")
    return found


def _add_item(parent: Element, dataset: Dataset, number: str) -> None:
    item = SubElement(
        parent,
        "DataItem",
        DataType=number,
        Precision="8",
        Dimensions=" ".join(map(str, dataset.shape)),
        Format="HDF",
    )
    item.text = f"{dataset.file}:{dataset.path}"
