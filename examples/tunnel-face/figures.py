#!/usr/bin/env python3
"""The figures of this example from the results of its runs.

    pip install numpy matplotlib pyvista
    python3 figures.py out/tunnel-face [out/tunnel-face-fine …] --to .

Prints collapse times, settlements and the volume of soil in the bore of every run; draws kinetic
energy and settlement troughs of all runs, and the section at rest and a film strip of the last one.
"""

import argparse
import csv
import os

os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import pyvista as pv

AXIS, RADIUS, WALL = -15.0, 5.0, -30.0


def history(folder):
    with open(os.path.join(folder, "history.csv")) as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def particles(folder, time):
    """Positions, displacements at the frame nearest to a time, and that time."""
    reader = pv.get_reader(os.path.join(folder, "particles.pvd"))
    times = np.array(reader.time_values)
    nearest = times[np.abs(times - min(time, times[-1])).argmin()]
    reader.set_active_time_value(nearest)
    grid = reader.read()[0]
    return np.array(grid.points), np.array(grid["displacement"]), nearest


def since_release(table):
    """Time since the support was taken away; the first stage is numbered 0."""
    first = np.flatnonzero(table["stage"] >= 1)[0]
    return table["time"] - table["time"][first] + table["stage_time"][first]


def collapse_time(time, energy, share):
    """First instant after the peak from which the energy stays below a share of it for a second."""
    peak = energy.argmax()
    below = energy < share * energy[peak]
    for k in range(peak, len(time)):
        window = (time >= time[k]) & (time <= time[k] + 1.0)
        if below[window].all():
            return time[k] if time[-1] >= time[k] + 1.0 else None
    return None


def trough(x0, u, along, across, width, at):
    """Mean settlement of the particles next to the surface in a strip, over the coordinate `along`."""
    strip = (x0[:, 2] > -0.8) & (np.abs(x0[:, across] - at) < width)
    order = np.argsort(x0[strip, along])
    place, settled = x0[strip, along][order], -u[strip, 2][order]
    edges = np.arange(place.min(), place.max() + width, width)
    cells = np.digitize(place, edges)
    mean = [(place[cells == c].mean(), settled[cells == c].mean()) for c in np.unique(cells)]
    return np.array(mean).T


def describe(folder):
    table = history(folder)
    time, energy = since_release(table), table["energy.kinetic_grid"]
    x, u, _ = particles(folder, np.inf)
    x0 = x - u
    surface = x0[:, 2] > -0.8
    deepest = surface & (-u[:, 2] == (-u[surface, 2]).max())
    name = os.path.basename(os.path.normpath(folder))
    times = [collapse_time(time, energy, share) for share in (0.01, 0.001)]
    shown = ["not within the run" if t is None else f"{t:.2f} s" for t in times]
    print(f"{name}: {len(x)} particles")
    print(f"  grid energy      peak {energy.max() / 1e6:.2f} MJ at {time[energy.argmax()]:.2f} s, "
          f"last {energy[-1] / energy.max():.1e} of it")
    print(f"  collapse time    {shown[0]} (1 %), {shown[1]} (0.1 %)")
    print(f"  settlement       {(-u[surface, 2]).max():.2f} m at y = {x0[deepest, 1][0]:.1f} m")
    print(f"  soil in the bore {table['bore.volume'][-1]:.0f} m3 of the whole tunnel")
    flowed = (x0[:, 1] > 0) & (x[:, 1] < 0) & (np.hypot(x[:, 0], x[:, 2] - AXIS) < RADIUS)
    print(f"  furthest soil    y = {x[flowed, 1].min():.1f} m; the wall is at {WALL:.0f} m")
    return {"name": name, "time": time, "energy": energy, "x0": x0, "u": u, "y": x0[deepest, 1][0]}


def draw_energy(runs, path):
    figure, axes = plt.subplots(figsize=(7, 3.2))
    for run in runs:
        axes.semilogy(run["time"], np.maximum(run["energy"], 1.0) / 1e6, label=run["name"])
    axes.set(xlabel="time since the support was taken away (s)", ylabel="grid kinetic energy (MJ)", ylim=(1e-3, None))
    axes.grid(alpha=0.3)
    axes.legend()
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def draw_troughs(runs, path):
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.2), sharey=True)
    for run in runs:
        left.plot(*trough(run["x0"], run["u"], 1, 0, 1.0, 0.5), label=run["name"])
        right.plot(*trough(run["x0"], run["u"], 0, 1, 1.0, run["y"]), label=run["name"])
    left.invert_yaxis()
    left.set(xlabel="along the axis, y (m); the face is at 0", ylabel="settlement (m)")
    right.set(xlabel="across, x (m), through the deepest point", xlim=(0, 20))
    for axes in (left, right):
        axes.grid(alpha=0.3)
    right.legend()
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def section(axes, x, u, greatest):
    """Particles near the plane of symmetry, coloured by displacement."""
    near = x[:, 0] < 0.8
    size = 40.0 * np.sqrt(1500.0 / max(near.sum(), 1))
    size = np.full(near.sum(), 0.25 * size)
    drawn = axes.scatter(x[near, 1], x[near, 2], c=np.linalg.norm(u[near], axis=1), s=size, vmin=0,
                         vmax=greatest, cmap="viridis", linewidths=0)
    crown, invert = AXIS + RADIUS, AXIS - RADIUS
    axes.plot([0, WALL, WALL, 0], [crown, crown, invert, invert], color="black", lw=1.2)
    axes.set(aspect="equal", xlim=(-31, 26), ylim=(-27, 1))
    return drawn


def draw_section(folder, path):
    x, u, time = particles(folder, np.inf)
    figure, axes = plt.subplots(figsize=(9, 4.6))
    drawn = section(axes, x, u, 10.0)
    axes.set(xlabel="y (m)", ylabel="z (m)")
    figure.colorbar(drawn, label="displacement (m), 10 and more in yellow", shrink=0.8)
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def draw_film(folder, path):
    figure, axes = plt.subplots(3, 2, figsize=(10, 8))
    for place, time in zip(axes.flat, (0.5, 1.0, 2.0, 3.0, 5.0, 8.0)):
        x, u, shown = particles(folder, time)
        section(place, x, u, 10.0)
        place.set_title(f"{shown:.1f} s", fontsize=10)
        place.axis("off")
    figure.tight_layout()
    figure.savefig(path, dpi=90)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+")
    parser.add_argument("--to", default=".", help="folder of the pictures")
    args = parser.parse_args()
    runs = [describe(folder) for folder in args.runs]
    draw_energy(runs, os.path.join(args.to, "energy.png"))
    draw_troughs(runs, os.path.join(args.to, "trough.png"))
    draw_section(args.runs[-1], os.path.join(args.to, "displacement.png"))
    draw_film(args.runs[-1], os.path.join(args.to, "film.png"))


if __name__ == "__main__":
    main()
