#!/usr/bin/env python3
"""The figures of this example from the results of its runs.

    pip install numpy matplotlib pyvista
    python3 figures.py out/tunnel-face-fine out/tunnel-face --label "0.6 m" "1.2 m" --to .

Prints collapse times, craters and the volume of soil in the bore of every run; draws kinetic
energy and craters of all runs, and the section at the end and a film strip of the first.
"""

import argparse
import csv
import json
import os

os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import pyvista as pv
from matplotlib.collections import EllipseCollection

AXIS, RADIUS, WALL = -15.0, 5.0, -30.0
PLACE = 3.5  # y of the strip that is told for every run, m
STRIP = 1.0  # width of the strips whose soil is followed, m
SQUARE = 0.5  # side of the squares in which the surface is sought, m
GREATEST = 10.0  # displacement at the end of the colours, m


SCENES = []  # fingerprints of the runs' scenes, which stand small in every picture


def stamp(figure):
    figure.text(0.004, 0.004, "scene " + ", ".join(SCENES), fontsize=4, color="0.5")


def scene(folder):
    with open(os.path.join(folder, "summary.json")) as file:
        return json.load(file)["scene_hash"][:12]


def history(folder):
    with open(os.path.join(folder, "history.csv")) as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def particles(folder, time):
    """Positions, displacements and sizes at the frame nearest to a time, and that time."""
    reader = pv.get_reader(os.path.join(folder, "particles.pvd"))
    times = np.array(reader.time_values)
    nearest = times[np.abs(times - min(time, times[-1])).argmin()]
    reader.set_active_time_value(nearest)
    grid = reader.read()[0]
    # The end of the first stage has the particles' volumes, which frames have not.
    first = pv.read(os.path.join(folder, "stages", "00_supported.vtu"))
    size = np.empty(len(grid.points))
    size[np.array(first["id"], int)] = np.cbrt(np.array(first["volume"]))
    size = size[np.array(grid["id"], int)]
    return np.array(grid.points), np.array(grid["displacement"]), size, nearest


def since_release(table):
    """Time since the support was taken away; the first stage is numbered 0."""
    first = np.flatnonzero(table["stage"] >= 1)[0]
    return table["time"] - table["time"][first] + table["stage_time"][first]


def collapse_time(time, energy, share):
    """First instant after the peak from which the energy is below a share of it for a second."""
    peak = energy.argmax()
    below = energy < share * energy[peak]
    for k in range(peak, len(time)):
        window = (time >= time[k]) & (time <= time[k] + 1.0)
        if below[window].all():
            return time[k] if time[-1] >= time[k] + 1.0 else None
    return None


def tops(x, size, y, across):
    """Height of the surface in squares at (y, across), m: the top of the highest particle."""
    reach = 0.5 * np.maximum(SQUARE, 2 * size)
    near = np.abs(x[:, 0] - across) < reach
    x, size, reach = x[near], size[near], reach[near]
    heights = np.full(len(y), np.nan)
    for k, place in enumerate(y):
        column = np.abs(x[:, 1] - place) < reach
        if column.any():
            heights[k] = (x[column, 2] + 0.5 * size[column]).max()
    return heights


def sunk(run):
    """How far the surface has gone down in squares, over across and along."""
    across = np.arange(0.5 * SQUARE, 20, SQUARE)
    along = np.arange(-30 + 0.5 * SQUARE, 25, SQUARE)
    x0, x, size = run["x0"], run["x0"] + run["u"], run["size"]
    depth = [tops(x0, size, along, at) - tops(x, size, along, at) for at in across]
    return across, along, np.array(depth)


def gone_down(run):
    """Mean settlement of the soil that lay at the surface beside the axis, in strips along it."""
    x0, settled, size = run["x0"], -run["u"][:, 2], run["size"]
    strip = (x0[:, 2] > -1.2 * size) & (x0[:, 0] < STRIP)
    cells = np.floor(x0[strip, 1] / STRIP)
    places = np.unique(cells)
    means = [settled[strip][cells == cell].mean() for cell in places]
    return (places + 0.5) * STRIP, np.array(means)


def describe(folder, label):
    table = history(folder)
    time, energy = since_release(table), table["energy.kinetic_grid"]
    x, u, size, _ = particles(folder, np.inf)
    run = {"label": label, "time": time, "energy": energy, "x0": x - u, "u": u, "size": size}
    run["across"], run["along"], run["depth"] = sunk(run)
    middle = run["depth"][0]
    run["deepest"] = np.nanargmax(middle)
    crater = 2 * np.nansum(run["depth"]) * SQUARE**2
    y, soil = gone_down(run)
    times = [collapse_time(time, energy, share) for share in (0.01, 0.001)]
    shown = ["not within the run" if t is None else f"{t:.2f} s" for t in times]
    late = energy[time > time[-1] - 2.0] / energy.max()
    flowed = (run["x0"][:, 1] > 0) & (x[:, 1] < 0) & (np.hypot(x[:, 0], x[:, 2] - AXIS) < RADIUS)
    front = np.sort(x[flowed, 1])
    print(f"{label}: {len(x)} particles")
    print(f"  grid energy      peak {energy.max() / 1e6:.2f} MJ at {time[energy.argmax()]:.2f} s, "
          f"in the last 2 s {100 * late.min():.2f} to {100 * late.max():.2f} % of it")
    print(f"  collapse time    {shown[0]} (1 %), {shown[1]} (0.1 %)")
    print(f"  crater           {middle[run['deepest']]:.2f} m deep at "
          f"y = {run['along'][run['deepest']]:.2f} m; {crater:.0f} m3 of the whole ground")
    print(f"  settlement       {soil.max():.2f} m at y = {y[soil.argmax()]:.1f} m, "
          f"{soil[y == PLACE][0]:.2f} m at y = {PLACE} m: of the soil that lay at the surface")
    print(f"  soil in the bore {table['bore.volume'][-1]:.0f} m3 of the whole tunnel")
    print(f"  furthest soil    y = {front[0]:.1f} m, all but 1 % of what flowed in behind "
          f"{front[len(front) // 100]:.1f} m; the wall is at {WALL:.0f} m")
    return run


def draw_energy(runs, path):
    figure, axes = plt.subplots(figsize=(7, 3.2))
    for run in runs:
        axes.semilogy(run["time"], np.maximum(run["energy"], 1.0) / 1e6, label=run["label"])
    axes.set(xlabel="time since the support was taken away (s)",
             ylabel="grid kinetic energy (MJ)", ylim=(1e-4, None))
    axes.grid(alpha=0.3)
    axes.legend()
    save(figure, path, 110)


def draw_troughs(runs, path):
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.2), sharey=True)
    for run in runs:
        left.plot(run["along"], -run["depth"][0], label=run["label"])
        label = f"{run['label']}, at y = {run['along'][run['deepest']]:.2f} m"
        right.plot(run["across"], -run["depth"][:, run["deepest"]], label=label)
    left.set(xlabel="along the axis, y (m); the face is at 0", ylabel="surface at the end, z (m)")
    right.set(xlabel="across, x (m), where it is deepest", xlim=(0, 20))
    for axes in (left, right):
        axes.grid(alpha=0.3)
    right.legend()
    save(figure, path, 110)


def section(axes, x, u, size):
    """Particles at the plane of symmetry as discs of their size, coloured by displacement."""
    near = x[:, 0] < 1.7 * size
    order = np.argsort(-x[near, 0])
    x, u, size = x[near][order], u[near][order], size[near][order]
    discs = EllipseCollection(size, size, np.zeros(len(size)), units="xy", offsets=x[:, 1:],
                              offset_transform=axes.transData, linewidths=0,
                              cmap=plt.get_cmap("viridis", 10))
    discs.set_array(np.linalg.norm(u, axis=1))
    discs.set_clim(0, GREATEST)
    axes.add_collection(discs)
    crown, invert = AXIS + RADIUS, AXIS - RADIUS
    axes.plot([0, WALL, WALL, 0], [crown, crown, invert, invert], color="black", lw=1.2)
    axes.set(aspect="equal", xlim=(-30.5, 25.5), ylim=(-26.5, 1))
    return discs


def draw_section(folder, path):
    figure, axes = plt.subplots(figsize=(9, 4.2))
    discs = section(axes, *particles(folder, np.inf)[:3])
    axes.set(xlabel="y (m)", ylabel="z (m)")
    figure.colorbar(discs, label="displacement (m)", shrink=0.85, extend="max")
    save(figure, path, 100)


def draw_film(folder, path):
    """Times are those of the frames: the support goes within 0.1 s of the start."""
    figure, axes = plt.subplots(3, 2, figsize=(9, 7.2))
    for place, time in zip(axes.flat, (0.5, 1.0, 2.0, 3.0, 5.0, 8.0)):
        *state, shown = particles(folder, time)
        section(place, *state)
        place.set_title(f"{shown:.1f} s", fontsize=10)
        place.axis("off")
    save(figure, path, 75)


def save(figure, path, dpi):
    """With 128 colours, which keeps the files small."""
    from PIL import Image

    figure.tight_layout()
    stamp(figure)
    figure.savefig(path, dpi=dpi)
    Image.open(path).convert("RGB").quantize(128).save(path, optimize=True)


def main():
    form = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=form)
    parser.add_argument("runs", nargs="+", help="folders of results")
    parser.add_argument("--label", nargs="+", help="a name for each; the folder's if not given")
    parser.add_argument("--to", default=".", help="folder of the pictures")
    args = parser.parse_args()
    labels = args.label or [os.path.basename(os.path.normpath(run)) for run in args.runs]
    if len(labels) != len(args.runs):
        parser.error(f"{len(args.runs)} runs, but {len(labels)} labels")
    SCENES.extend(scene(run) for run in args.runs)
    runs = [describe(*named) for named in zip(args.runs, labels)]
    draw_energy(runs, os.path.join(args.to, "energy.png"))
    draw_troughs(runs, os.path.join(args.to, "trough.png"))
    draw_section(args.runs[0], os.path.join(args.to, "displacement.png"))
    draw_film(args.runs[0], os.path.join(args.to, "film.png"))


if __name__ == "__main__":
    main()
