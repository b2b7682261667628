#!/usr/bin/env python3
"""The figures of this example from the results of its runs.

    pip install numpy matplotlib pyvista
    python3 figures.py out/drop-anchor-fine-sweep --to .

The folder is that of a sweep over the coefficient of friction. Prints for each run the greatest depth
of the tip and when, the depth at the end, and how good the run is; draws depth over time of all runs,
resistance over depth of the roughest, and soil and mesh of the smoothest when its tip is 6.5 D deep.
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

D = 0.30  # diameter, m
YOUNG = 50e6  # of the anchor, Pa
DEEP = 6.5  # depth of the picture over D
LAYER = 0.25  # thickness of the layers that are told apart, m


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


def summary(folder):
    with open(os.path.join(folder, "summary.json")) as file:
        return json.load(file)


def runs(folder):
    """Coefficients of friction and folders, the smoothest first."""
    names = [n for n in os.listdir(folder) if n.startswith("friction-")]
    found = sorted((float(n.removeprefix("friction-")), os.path.join(folder, n)) for n in names)
    return [run for run in found if os.path.exists(os.path.join(run[1], "summary.json"))]


def frame(folder, kind, time):
    reader = pv.get_reader(os.path.join(folder, kind + ".pvd"))
    times = np.array(reader.time_values)
    at = times[np.abs(times - time).argmin()]
    reader.set_active_time_value(at)
    return reader.read()[0], at


def greatest_strain(folder):
    """Of all particles of the anchor in all frames (nu = 0)."""
    reader = pv.get_reader(os.path.join(folder, "particles.pvd"))
    greatest = 0.0
    for time in reader.time_values:
        reader.set_active_time_value(time)
        grid = reader.read()[0]
        own = np.array(grid["stress"])[np.array(grid["body"]) == 0]
        greatest = max(greatest, np.abs(own[:, :3]).max() / YOUNG)
    return greatest


def report(mu, folder):
    h, s = history(folder), summary(folder)
    depth = h["tip.penetration"] / D
    deepest = depth.argmax()
    energy, all_of_it = s["energy"], s["energy_turned_over"]
    kinds = ["transfer", "smoothing", "integration", "advection"]
    numerical = sum(abs(energy[k]) for k in kinds) / all_of_it
    put_back = s["projections"]
    print(
        f"mu = {mu}: greatest depth {depth[deepest]:.3f} D at {h['time'][deepest]:.4f} s, "
        f"{depth[-1]:.3f} D and {h['anchor.velocity.z'][-1]:.2f} m/s at {h['time'][-1]:.3f} s; "
        f"numerical {100 * numerical:.2f} %, residual {energy['residual'] / all_of_it:.1e}, "
        f"{put_back['count']} projections, the greatest {1e3 * put_back['greatest']:.2f} mm, their work "
        f"{100 * put_back['work'] / all_of_it:.1e} %, foreign {s['foreign_particles']}, "
        f"greatest strain of the anchor {100 * greatest_strain(folder):.1f} %"
    )


def depths(all_runs, to):
    figure, axes = plt.subplots(figsize=(6, 4))
    for mu, folder in all_runs:
        h = history(folder)
        axes.plot(h["time"], h["tip.penetration"] / D, label=f"μ = {mu:g}")
    axes.set(xlabel="time, s", ylabel="depth of the tip over D", ylim=(0, 10))
    axes.invert_yaxis()
    axes.grid(alpha=0.3)
    axes.legend()
    figure.tight_layout()
    stamp(figure)
    figure.savefig(os.path.join(to, "penetration.png"), dpi=110)


def resistance(all_runs, to):
    figure, axes = plt.subplots(figsize=(6, 4))
    for (mu, folder), style in zip([all_runs[-1], all_runs[0]], ["-", "--"]):
        h = history(folder)
        # Until it is deepest, without the ends, where there is no running mean.
        own = slice(6, h["tip.penetration"].argmax() - 6)
        for part, colour in [("tip", "tab:blue"), ("shaft", "tab:orange")]:
            force = h[f"resistance-{part}.contact.z"] / 1e3
            mean = np.convolve(force, np.ones(11) / 11, "same")
            axes.plot(mean[own], h["tip.penetration"][own] / D, style, color=colour,
                      label=f"{part}, μ = {mu:g}")
    axes.set(xlabel="resistance, kN", ylabel="depth of the tip over D")
    axes.invert_yaxis()
    axes.grid(alpha=0.3)
    axes.legend()
    figure.tight_layout()
    stamp(figure)
    figure.savefig(os.path.join(to, "resistance.png"), dpi=110)


def section(folder, to):
    """Particles in layers, and the mesh, where the tip is DEEP."""
    h = history(folder)
    time = np.interp(DEEP * D, h["tip.penetration"], h["time"])
    soil, at = frame(folder, "particles", time)
    mesh, _ = frame(folder, "mesh", at)
    depth = np.interp(at, h["time"], h["tip.penetration"]) / D
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 7.5), sharey=True)
    x = np.array(soil.points)
    r, start = np.hypot(x[:, 0], x[:, 1]), x[:, 2] - np.array(soil["displacement"])[:, 2]
    anchor = np.array(soil["body"]) == 0
    layer = np.floor(-start / LAYER).astype(int) % 2
    for own, colour in [(~anchor & (layer == 0), "#c8a165"), (~anchor & (layer == 1), "#8a6a3b"),
                        (anchor, "#44546a")]:
        right.scatter(r[own], x[own, 2], s=1.2, c=colour, linewidths=0)
    points = np.array(mesh.points)
    flat = np.abs(points[:, 1]) < 1e-9
    tets = mesh.cells.reshape(-1, 5)[:, 1:]
    triangles = [t[flat[t]] for t in tets if flat[t].sum() == 3]
    left.triplot(points[:, 0], points[:, 2], triangles, lw=0.3, color="k")
    for axes in (left, right):
        axes.set(xlim=(0, 1.5), ylim=(-3.2, 1.6), aspect="equal", xlabel="r, m")
    left.set(ylabel="z, m", title="mesh")
    right.set(title=f"particles at {depth:.2f} D, layers of {LAYER} m")
    figure.tight_layout()
    stamp(figure)
    figure.savefig(os.path.join(to, "section.png"), dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("sweep")
    parser.add_argument("--to", default=".")
    arguments = parser.parse_args()
    found = runs(arguments.sweep)
    SCENES.extend(scene(folder) for _, folder in found)
    for mu, folder in found:
        report(mu, folder)
    depths(found, arguments.to)
    resistance(found, arguments.to)
    section(found[0][1], arguments.to)


if __name__ == "__main__":
    main()
