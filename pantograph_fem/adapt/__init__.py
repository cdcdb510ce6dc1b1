"""Meshes that are refined where the solution needs it, until force or energy is accurate."""

#: Where a folder of results keeps the mesh of its path, to resume it.
MESH_FILE = "adapted_mesh.npz"
