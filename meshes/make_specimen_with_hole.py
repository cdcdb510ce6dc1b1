"""Make specimen_with_hole.msh: a rectangle with a round hole at its centre, grips labelled.

Usage: python meshes/make_specimen_with_hole.py
"""

from pathlib import Path

import gmsh

WIDTH, HEIGHT, RADIUS = 0.068, 0.204, 0.012  # m
INSIDE, CORNER, HOLE = 0.006, 0.001, 0.002  # element sizes, m
GROWTH = 0.25  # of the element size, per distance


def main() -> None:
    """Build the geometry, name its parts, mesh it and write the file."""
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    model = gmsh.model
    model.add("specimen_with_hole")

    rectangle = model.occ.addRectangle(0, 0, 0, WIDTH, HEIGHT)
    disk = model.occ.addDisk(WIDTH / 2, HEIGHT / 2, 0, RADIUS, RADIUS)
    ((_, sheet),), _ = model.occ.cut([(2, rectangle)], [(2, disk)])
    model.occ.synchronize()

    # The names that the package looks for; the sheet needs a name as well, or it is not saved.
    for name, y in (("bottom", 0.0), ("top", HEIGHT)):
        (curve,) = model.getEntitiesInBoundingBox(-1e-6, y - 1e-6, -1, 1, y + 1e-6, 1, dim=1)
        model.setPhysicalName(1, model.addPhysicalGroup(1, [curve[1]]), name)
    model.setPhysicalName(2, model.addPhysicalGroup(2, [sheet]), "sheet")

    # Distances to the nearest corner and to the hole, x and y folded into one quarter.
    x, y = f"({WIDTH / 2}-Fabs(x-{WIDTH / 2}))", f"({HEIGHT / 2}-Fabs(y-{HEIGHT / 2}))"
    to_corner = f"Sqrt({x}^2+{y}^2)"
    to_hole = f"(Sqrt((x-{WIDTH / 2})^2+(y-{HEIGHT / 2})^2)-{RADIUS})"
    size = f"Min({CORNER}+{GROWTH}*{to_corner},{HOLE}+{GROWTH}*{to_hole})"
    field = model.mesh.field.add("MathEval")
    model.mesh.field.setString(field, "F", f"Min({INSIDE},{size})")
    model.mesh.field.setAsBackgroundMesh(field)
    for other in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
        gmsh.option.setNumber(f"Mesh.MeshSize{other}", 0)
    gmsh.option.setNumber("Mesh.Algorithm", 6)  # frontal-Delaunay
    model.mesh.generate(2)

    gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
    gmsh.write(str(Path(__file__).with_name("specimen_with_hole.msh")))
    gmsh.finalize()


if __name__ == "__main__":
    main()
