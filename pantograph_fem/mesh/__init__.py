"""Triangular meshes of a sheet: made here for rectangles, or read from a file."""

from pantograph_fem.mesh.imported import read_mesh
from pantograph_fem.mesh.rectangle import rectangle
from pantograph_fem.mesh.triangulation import Triangulation

__all__ = ["Triangulation", "read_mesh", "rectangle"]
