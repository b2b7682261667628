#!/usr/bin/env python3
"""Renders a picture of a run without a screen: particles coloured by a field, the mesh faint.

    pip install pyvista
    python3 scripts/render.py out/absorbing-column --field displacement --component z \\
        --frame -1 --output column.png
    python3 scripts/render.py out/absorbing-column --field stress --component zz --time 0.07

--frame counts from 0, or from the end if negative; --time takes the frame nearest to it.
Components are x y z or `norm` of vectors, xx yy zz xy yz zx of stresses. --range fixes the colours'
ends, for pictures that are to be compared. --flat --size 1400 560 is for sections in plane strain.
"""

import argparse
import json
import os
import sys

# VTK chooses how to draw when it is loaded; EGL needs no screen.
os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")

import numpy as np
import pyvista as pv
import vtk

VECTOR = ["x", "y", "z"]
TENSOR = ["xx", "yy", "zz", "xy", "yz", "zx"]
# Prefixes that keep the figures on the bar short: (least magnitude, factor, prefix).
PREFIXES = {
    "m": [(1.0, 1.0, "m"), (0.0, 1e3, "mm")],
    "m/s": [(1.0, 1.0, "m/s"), (0.0, 1e3, "mm/s")],
    "Pa": [(1e6, 1e-6, "MPa"), (1e3, 1e-3, "kPa"), (0.0, 1.0, "Pa")],
}


def frame(folder, kind, args):
    """The wanted frame of a collection, with its time."""
    path = os.path.join(folder, f"{kind}.pvd")
    if not os.path.exists(path):
        sys.exit(f"{path} does not exist: give the folder of a run that wrote frames")
    reader = pv.get_reader(path)
    times = np.array(reader.time_values)
    if args.time is not None:
        number = int(np.abs(times - args.time).argmin())
    elif -len(times) <= args.frame < len(times):
        number = args.frame % len(times)
    else:
        sys.exit(f"{path} has {len(times)} frames, so there is no frame {args.frame}")
    reader.set_active_time_value(times[number])
    return reader.read()[0], times[number]


def unit(grid, field):
    """The unit as the file gives it, without the sign convention that may follow."""
    text = grid.GetPointData().GetAbstractArray(field).GetInformation().Get(
        vtk.vtkDataArray.UNITS_LABEL()
    )
    return (text or "").split(",")[0].split(" ")[0]


def values_of(grid, field, component):
    """The field's values, one a point, and what to call them."""
    if field not in grid.point_data:
        fields = ", ".join(grid.point_data.keys())
        sys.exit(f"there is no field `{field}`; fields: {fields}")
    values = np.asarray(grid.point_data[field], dtype=float)
    name = field.replace("_", " ")
    if values.ndim == 1:
        if component:
            sys.exit(f"`{field}` has no components")
        return values, name
    names = VECTOR if values.shape[1] == 3 else TENSOR
    if component == "norm" and names is VECTOR:
        return np.linalg.norm(values, axis=1), f"norm of {name}"
    if component not in names:
        sys.exit(f"`{field}` needs --component, one of {', '.join(names)}")
    return values[:, names.index(component)], f"{name} {component}"


def scaled(values, unit):
    """The values in a unit that suits their size."""
    greatest = np.abs(values).max(initial=0.0)
    for least, factor, name in PREFIXES.get(unit, []):
        if greatest >= least:
            return values * factor, factor, name
    return values, 1.0, unit


def even_ends(low, high):
    """Round ends about a range, with the number of even steps between them."""
    wide = max(high - low, 1e-9 * max(abs(low), abs(high)), 1e-30)
    power = 10.0 ** np.floor(np.log10(wide / 4))
    step = next(m * power for m in (1, 2, 2.5, 5, 10) if wide / (m * power) <= 6)
    # A speck of noise beyond a round figure is no reason to go on to the next.
    first, last = np.floor(low / step + 0.05), np.ceil(high / step - 0.05)
    last = max(last, first + 1)
    return [step * first, step * last], int(round(last - first))


def outer_edges(mesh):
    """Edges of the mesh's surface, for orientation."""
    surface = mesh.extract_surface(algorithm="dataset_surface")
    return surface.extract_all_edges()


def look_from_the_side(plotter, bounds, width, height):
    """Puts everything in view from the side, slightly above, with room for the bar."""
    low, high = np.array(bounds[0::2]), np.array(bounds[1::2])
    centre, size = 0.5 * (low + high), high - low
    azimuth, elevation = np.radians(-60.0), np.radians(14.0)
    towards = np.array([
        np.cos(elevation) * np.cos(azimuth),
        np.cos(elevation) * np.sin(azimuth),
        np.sin(elevation),
    ])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    up = np.cross(towards, right)
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) - 0.5
    half = [np.abs((corners * size) @ axis).max() for axis in (right, up)]
    # The bar takes the right third.
    scale = max(half[1], half[0] * height / (0.6 * width)) * 1.12
    camera = plotter.camera
    camera.parallel_projection = True
    camera.parallel_scale = scale
    camera.focal_point = centre + right * scale * 0.17 * width / height
    camera.position = camera.focal_point + towards * 10 * np.linalg.norm(size)
    camera.up = (0.0, 0.0, 1.0)
    camera.clipping_range = (0.01 * np.linalg.norm(size), 100 * np.linalg.norm(size))
    return height / (2 * scale)


def spacing(points):
    """Typical distance between particles."""
    volume = np.prod(np.maximum(np.ptp(points, axis=0), 1e-12))
    return (volume / len(points)) ** (1 / 3)


def render(args):
    particles, time = frame(args.folder, "particles", args)
    mesh, _ = frame(args.folder, "mesh", args)
    raw, name = values_of(particles, args.field, args.component)
    shown, factor, unit_name = scaled(raw, unit(particles, args.field))
    title = f"{name}\n[{unit_name}]" if unit_name else name
    particles.point_data["shown"] = shown
    ends, steps = even_ends(shown.min(), shown.max())
    if args.range:
        ends, steps = [factor * r for r in args.range], 5

    width, height = args.size
    plotter = pv.Plotter(off_screen=True, window_size=(width, height))
    plotter.set_background("white")
    plotter.enable_anti_aliasing("ssaa")
    plotter.add_mesh(outer_edges(mesh), color="#5a6472", line_width=1.5, opacity=0.5)
    bounds = mesh.bounds
    ball = pv.Sphere(radius=args.diameter * 0.5 * spacing(particles.points),
                     theta_resolution=24, phi_resolution=24)
    cloud = pv.PolyData(particles.points)
    cloud.point_data["shown"] = shown
    balls = cloud.glyph(geom=ball, scale=False, orient=False)
    plotter.add_mesh(
        balls,
        scalars="shown",
        cmap=args.map,
        clim=ends,
        smooth_shading=True,
        ambient=0.35,
        diffuse=0.7,
        specular=0.1,
        show_scalar_bar=False,
    )
    if args.flat:
        plotter.add_scalar_bar(
            title=f"{name} ({unit_name}), t = {time:.3g} s\n ", position_x=0.25, position_y=0.04,
            width=0.5, height=0.12, title_font_size=24, label_font_size=20, n_labels=steps + 1,
            fmt="%.4g", color="#20242b",
        )
        look_along_y(plotter, bounds, width, height)
    else:
        bar_beside(plotter, title, steps, f"t = {time:.3g} s", width, height)
        look_from_the_side(plotter, bounds, width, height)
    scene = scene_hash(args.folder)
    if scene:
        plotter.add_text(f"scene {scene[:12]}", position=(8, 6), font_size=6, color="#80868f")
    plotter.screenshot(args.output)
    print(f"{args.output}: {name} at t = {time:g} s, "
          f"{shown.min():.4g} to {shown.max():.4g} {unit_name}")


def scene_hash(folder):
    """The scene's fingerprint, so that the picture says what it is of; none before the run's end."""
    path = os.path.join(folder, "summary.json")
    if not os.path.exists(path):
        return None
    with open(path) as file:
        return json.load(file)["scene_hash"]


def look_along_y(plotter, bounds, width, height):
    """Puts a section in plane strain in view, with room for the bar below."""
    low, high = np.array(bounds[0::2]), np.array(bounds[1::2])
    centre, size = 0.5 * (low + high), high - low
    scale = max(0.5 * size[0] * height / width, 0.5 * size[2] / 0.75) * 1.05
    camera = plotter.camera
    camera.parallel_projection = True
    camera.parallel_scale = scale
    camera.focal_point = centre - np.array([0.0, 0.0, 0.2 * scale])
    camera.position = camera.focal_point - np.array([0.0, 10 * np.linalg.norm(size), 0.0])
    camera.up = (0.0, 0.0, 1.0)
    camera.clipping_range = (0.01 * np.linalg.norm(size), 100 * np.linalg.norm(size))


def bar_beside(plotter, title, steps, time, width, height):
    """The colours' bar and the time in the right third."""
    bar = plotter.add_scalar_bar(
        title=title + "\n ",
        vertical=True,
        position_x=0.66,
        position_y=0.25,
        width=0.11,
        height=0.5,
        title_font_size=30,
        label_font_size=26,
        n_labels=steps + 1,
        fmt="%.4g",
        color="#20242b",
    )
    bar.GetTitleTextProperty().SetJustificationToLeft()
    plotter.add_text(
        time, position=(int(0.655 * width), int(0.19 * height)), font_size=15, color="#20242b",
    )


def arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", help="a run's folder of results")
    parser.add_argument("--field", default="displacement")
    parser.add_argument("--component", help="x y z, xx yy zz xy yz zx, or norm")
    when = parser.add_mutually_exclusive_group()
    when.add_argument("--frame", type=int, default=-1)
    when.add_argument("--time", type=float, help="s")
    parser.add_argument("--range", type=float, nargs=2, metavar=("LOW", "HIGH"), help="SI units")
    parser.add_argument("--map", default="viridis", help="a matplotlib colour map")
    parser.add_argument("--diameter", type=float, default=0.9, help="of particles, in spacings")
    parser.add_argument("--size", type=int, nargs=2, default=(900, 1200), metavar=("W", "H"))
    parser.add_argument("--flat", action="store_true",
                        help="look along y, for plane strain; a wide --size suits it")
    parser.add_argument("--output", default="picture.png")
    return parser.parse_args()


if __name__ == "__main__":
    render(arguments())
