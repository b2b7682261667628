#!/usr/bin/env python3
"""The figures of this example from the results of its runs.

    pip install numpy matplotlib pyvista pillow
    python3 figures.py out/dynamic-probing-fine out/dynamic-probing --label "4.5 mm" "9 mm" --to .

Prints the blows of every run and draws their penetration; draws the ground after the blows and the
principal stresses at the cone of the first.
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
from matplotlib.collections import EllipseCollection, LineCollection

D, LONG, MODULUS = 0.0357, 1.0, 50e6
PERIOD = 0.1  # between blows, s
QUIVER = 0.025  # of the free rod's vibration, 2 L / c, s
SQUARE = 0.2 * D  # stresses are means over squares of this side, m
LAYER = D  # thickness of the layers that are drawn in two colours, m


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
    """Particles at the frame nearest to a time: radius and height, body, arrays."""
    reader = pv.get_reader(os.path.join(folder, "particles.pvd"))
    times = np.array(reader.time_values)
    reader.set_active_time_value(times[np.abs(times - min(time, times[-1])).argmin()])
    grid = reader.read()[0]
    return np.array(grid.points), np.array(grid["body"]), grid


def volumes(folder):
    """Volume of each particle at the end of the first stage, m3, by its number."""
    first = pv.read(os.path.join(folder, "stages", "00_standing.vtu"))
    volume = np.zeros(int(np.array(first["id"]).max()) + 1)
    volume[np.array(first["id"], int)] = np.array(first["volume"])
    return volume


def describe(folder, label):
    table = history(folder)
    start = np.flatnonzero(table["stage"] >= 1)[0]
    time = table["time"] - table["time"][start] + table["stage_time"][start]
    blows = int(time[-1] / PERIOD + 0.01)
    ends = [np.flatnonzero(time >= PERIOD * k - 1e-6)[0] for k in range(blows + 1)]
    ends[0] = start
    # Displacements count from the first blow on. The rod quivers: where it stands is a mean.
    depth = table["tip.penetration"]
    stands = [(time > PERIOD * k - QUIVER) & (time <= PERIOD * k) for k in range(1, blows + 1)]
    deep = np.array([0.0] + [depth[when].mean() for when in stands])
    given = table["energy.load"][ends]
    grid = table["energy.kinetic_grid"]
    print(label)
    print(f"  settlement under its own weight {1e3 * depth[start - 1]:.2f} mm")
    print("  blow  deepest (cm)  stands at (cm)  set (cm)  work (J)  "
          "grid energy before the next, % of the work, of its peak")
    for k in range(blows):
        during = slice(ends[k], ends[k + 1] + 1)
        rest, work = grid[ends[k + 1]], given[k + 1] - given[k]
        print(f"  {k + 1:4}  {100 * depth[during].max():12.2f}  {100 * deep[k + 1]:14.2f}  "
              f"{100 * (deep[k + 1] - deep[k]):8.2f}  {work:8.2f}  {100 * rest / work:8.2f}"
              f"  {100 * rest / grid[during].max():8.2f}")
    with open(os.path.join(folder, "summary.json")) as file:
        summary = json.load(file)
    kinds = ("transfer", "smoothing", "integration", "advection")
    total = summary["energy_turned_over"]
    lost = sum(abs(summary["energy"][kind]) for kind in kinds)
    print(f"  work of all pulses {given[-1] - given[0]:.1f} J, energy turned over {total:.1f} J, "
          f"plastic {summary['energy']['plastic']:.1f} J, absorbed {summary['energy']['absorbed']:.1f} J, "
          f"friction {summary['energy']['friction']:.1f} J")
    print(f"  numerical terms {100 * lost / total:.2f} %, residual {summary['energy']['residual'] / total:.1e}, "
          f"projections {summary['projections']['count']} (sum {summary['projections']['sum']:.1e} m, "
          f"greatest {summary['projections']['greatest']:.1e} m)")
    print(f"  {summary['particles']} particles, {summary['elements']} elements, {summary['steps']} steps, "
          f"{summary['wall_time']:.0f} s with {summary['threads']} threads")
    strain = 0.0
    reader = pv.get_reader(os.path.join(folder, "particles.pvd"))
    for value in reader.time_values:
        reader.set_active_time_value(value)
        grid = reader.read()[0]
        rod = np.array(grid["body"]) == 0
        strain = max(strain, np.abs(np.array(grid["stress"])[rod][:, :3]).max() / MODULUS)
    print(f"  greatest strain of a particle of the probe in any frame {100 * strain:.2f} %")
    return {"label": label, "time": time[start:], "depth": depth[start:], "ends": deep}


def draw_penetration(runs, path):
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.4), width_ratios=(1.4, 1))
    for run in runs:
        line = left.plot(run["time"] / PERIOD, 100 * run["depth"], lw=1, label=run["label"])[0]
        blows = np.arange(1, len(run["ends"]))
        left.plot(blows, 100 * run["ends"][1:], "o", ms=3.5, color=line.get_color())
        right.plot(blows, 100 * np.diff(run["ends"]), "o-", ms=4, lw=1, color=line.get_color(),
                   label=run["label"])
    left.set(xlabel="blows", ylabel="penetration (cm)", xlim=(0, None))
    left.invert_yaxis()
    right.set(xlabel="blow", ylabel="set (cm)", ylim=(0, None))
    for axes in (left, right):
        axes.grid(alpha=0.3)
        axes.legend()
    save(figure, path, 100)


def draw_ground(folder, start, path):
    """Meridian sections before the first, and after two, five and ten blows; layers in two colours."""
    figure, axes = plt.subplots(1, 4, figsize=(10, 4.8), sharey=True)
    for place, blows in zip(axes, (0, 2, 5, 10)):
        points, body, grid = particles(folder, start + PERIOD * blows)
        volume = volumes(folder)[np.array(grid["id"], int)]
        section(place, points, body, np.array(grid["displacement"]), volume)
        place.set_title(f"{blows} blows", fontsize=10)
        place.set(aspect="equal", xlim=(-0.11, 0.11), ylim=(-0.42, 0.1), xlabel="r (m)")
    axes[0].set_ylabel("z (m)")
    save(figure, path, 95)


def section(axes, points, body, displacement, volume):
    """Particles as discs of their area in the meridian plane, on both sides of the axis."""
    r, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    size = 1.6 * np.sqrt(volume / (np.radians(20) * r))
    first = z - displacement[:, 2]
    colour = np.where(body == 0, 1, np.floor(first / LAYER) % 2 / 2)
    colours = matplotlib.colors.ListedColormap(["#4a5a7c", "#d9c27a", "0.55"])
    for side in (-1, 1):
        discs = EllipseCollection(size, size, np.zeros(len(r)), units="xy", offsets=np.c_[side * r, z],
                                  offset_transform=axes.transData, linewidths=0, cmap=colours)
        discs.set_array(colour)
        discs.set_clim(0, 1)
        axes.add_collection(discs)


def crosses(axes, points, body, grid):
    """Principal stresses in the meridian plane, means over squares, as crosses."""
    r, angle, z = np.hypot(points[:, 0], points[:, 1]), np.arctan2(points[:, 1], points[:, 0]), points[:, 2]
    xx, yy, zz, xy, yz, xz = np.array(grid["stress"]).T
    c, s = np.cos(angle), np.sin(angle)
    rr, rz = xx * c * c + yy * s * s + 2 * xy * s * c, xz * c + yz * s
    tip = z[body == 0].min()
    near = (body == 1) & (r < 2.4 * D) & (z > tip - 2.5 * D) & (z < tip + 3.5 * D)
    cell = np.floor(np.c_[r, z - tip][near] / SQUARE).astype(int)
    _, owner, number = np.unique(cell, axis=0, return_inverse=True, return_counts=True)
    mean = lambda values: np.bincount(owner.ravel(), values[near]) / number
    tensors = np.array([[mean(rr), mean(rz)], [mean(rz), mean(zz)]])
    values, vectors = np.linalg.eigh(np.moveaxis(tensors, 2, 0))
    centre, pressure = np.c_[mean(r), mean(z)], -values[:, 0] / 1e3
    longest = np.percentile(np.abs(values).max(axis=1), 90)
    for side in (-1, 1):
        for k in range(2):
            half = vectors[:, :, k] * (0.5 * SQUARE * np.clip(values[:, k] / longest, -1.3, 1.3))[:, None]
            ends = np.stack([centre - half, centre + half], axis=1) * [side, 1] / D
            lines = LineCollection(ends, linewidths=1, cmap="viridis_r", array=pressure)
            lines.set_clim(0, np.percentile(pressure, 97))
            axes.add_collection(lines)
        rod = body == 0
        axes.plot(side * r[rod] / D, z[rod] / D, "s", ms=4, color="0.85", zorder=0)
    axes.set(aspect="equal", xlim=(-2.4, 2.4), ylim=(tip / D - 2.5, tip / D + 3.5), xlabel="r/D", ylabel="z/D")
    return lines


def draw_stresses(folder, start, path):
    """At the end of the last pulse, and before the next one would come."""
    figure, axes = plt.subplots(1, 2, figsize=(10, 5.6))
    for place, time, title in ((axes[0], start + 9 * PERIOD + 0.02, "at the end of the tenth pulse"),
                               (axes[1], start + 10 * PERIOD, "after the tenth blow")):
        lines = crosses(place, *particles(folder, time))
        figure.colorbar(lines, label="greatest compression in the plane (kPa)", shrink=0.7, extend="max")
        place.set_title(title, fontsize=10)
    save(figure, path, 90)


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
    draw_penetration(runs, os.path.join(args.to, "penetration.png"))
    draw_ground(args.runs[0], PERIOD, os.path.join(args.to, "ground.png"))
    draw_stresses(args.runs[0], PERIOD, os.path.join(args.to, "stresses.png"))


if __name__ == "__main__":
    main()
