"""Triangular meshes of a sheet: made here for rectangles, or read from a file."""

from pantograph_fem.mesh.imported import read_mesh
from pantograph_fem.mesh.rectangle import rectangle, rectangle_by_sizes
from pantograph_fem.mesh.size_field import SizeField
from pantograph_fem.mesh.triangulation import Triangulation

__all__ = ["SizeField", "Triangulation", "read_mesh", "rectangle", "rectangle_by_sizes"]
