"""Draw the pictures of docs/paraview.md: what ParaView shows of a sheet, a lattice and a beam.

By VTK's own reader of XDMF and its Warp By Vector, through pyvista, without a screen. The runs are
those of ``pantograph run cases/<name>.toml``.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

import pyvista

HERE = Path(__file__).parent
#: Part of the height of a picture that is the bar's.
BAR = 0.15


@dataclass(frozen=True)
class Picture:
    """A run and how it is shown: the field of the colours, their label, and the loads.

    The tubes that stand for lines have a radius in m; surfaces have none.
    """

    run: str
    name: str
    field: str
    label: str
    size: tuple[int, int]
    loads: tuple[float, ...] = (1.0,)
    tube_radius: float | None = None
    colours: str = "viridis"
    #: Ends of the colours; by default those of the field.
    limits: tuple[float, float] | None = None
    #: Numbers at the bar.
    labels: int = 4


PICTURES = (
    Picture(
        "a_bias_extension",
        "sheet",
        "shear_angle",
        "shear angle (rad)",
        (420, 900),
        limits=(0.0, 1.2),
    ),
    Picture(
        "lattice_bias_extension",
        "lattice",
        "stretch",
        "stretch",
        (420, 900),
        tube_radius=4e-4,
        colours="plasma",
    ),
    Picture(
        "beam_arc",
        "beam",
        "bending_moment",
        "bending moment (N m)",
        (900, 620),
        loads=(0.2, 0.4, 0.6, 0.8, 1.0),
        tube_radius=5e-3,
        colours="coolwarm",
        limits=(-5.5e6, 5.5e6),
        labels=5,
    ),
)


def main() -> None:
    """Draw all pictures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", type=Path, default=HERE.parent / "results")
    parser.add_argument("--figures", type=Path, default=HERE / "figures")
    arguments = parser.parse_args()
    for picture in PICTURES:
        path = arguments.results / picture.run / "fields.xdmf"
        if not path.is_file():
            parser.error(
                f"there is no {path}: `pantograph run cases/{picture.run}.toml` writes it; "
                "--results says where the folders of results are"
            )
        draw(picture, path, arguments.figures / f"paraview_{picture.name}.png")


def draw(picture: Picture, fields: Path, figure: Path) -> None:
    """Draw the deformed body in colours over the outline of the undeformed one."""
    reader = pyvista.get_reader(fields)
    plotter = pyvista.Plotter(off_screen=True, window_size=picture.size)
    plotter.set_background("white")
    for load in picture.loads:
        reader.set_active_time_value(load)
        mesh = reader.read()
        deformed = mesh.warp_by_vector("displacement", factor=1.0)
        coloured = plotter.add_mesh(
            tubes(deformed, picture.tube_radius) if picture.tube_radius else deformed,
            scalars=picture.field,
            cmap=picture.colours,
            clim=picture.limits,
            lighting=False,
            show_scalar_bar=False,
        )
    # Behind the deformed body, tubes included.
    behind = outline(mesh).translate((0.0, 0.0, -0.05 * mesh.length))
    plotter.add_mesh(behind, color="darkgrey", line_width=2, lighting=False)
    plotter.add_scalar_bar(
        title=picture.label + "\n",
        mapper=coloured.mapper,
        color="black",
        title_font_size=22,
        label_font_size=18,
        fmt="%.3g",
        n_labels=picture.labels,
        width=0.7,
        position_x=0.15,
        position_y=0.02,
    )
    look_at(plotter)
    plotter.screenshot(figure)
    plotter.close()


def tubes(lines: pyvista.DataSet, radius: float) -> pyvista.PolyData:
    """Show lines as ParaView's Tube filter does, each with the fields of its own."""
    return lines.extract_surface(algorithm=None).tube(radius=radius, n_sides=12)


def outline(mesh: pyvista.DataSet) -> pyvista.PolyData:
    """Find the boundary of a surface, or the lines themselves, without any fields."""
    surface = mesh.extract_surface(algorithm=None)
    if not surface.n_lines:
        surface = surface.extract_feature_edges(
            feature_edges=False, manifold_edges=False, non_manifold_edges=False
        )
    surface.clear_data()
    return surface


def look_at(plotter: pyvista.Plotter) -> None:
    """Look along z at all there is, above what is left for the bar."""
    left, right, bottom, top, _, _ = plotter.bounds
    width, height = plotter.window_size
    # m that the picture is high, with a margin of 3 % on each side
    shown = 1.06 * max((top - bottom) / (1.0 - BAR), (right - left) * height / width)
    plotter.view_xy()
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = 0.5 * shown
    middle = 0.5 * (left + right), 0.5 * (bottom + top) - 0.5 * BAR * shown
    plotter.camera.focal_point = (*middle, 0.0)
    plotter.camera.position = (*middle, 10.0 * shown)
    plotter.reset_camera_clipping_range()


if __name__ == "__main__":
    main()
