"""The figures of the book's chapter on Python: what copies, views and materials written in Python cost.

    python measure.py [copies] [material]
"""

from __future__ import annotations

import gc
import sys
import time
from statistics import median
from typing import Any

import moldwarp
import numpy as np
import numpy.typing as npt


class Elastic(moldwarp.Material):
    """Hooke's law."""

    def update(self, step: moldwarp.Increment) -> npt.ArrayLike:
        return step.stress + self.elastic(step.strain)


def block(cells: list[int], soil: Any) -> dict[str, Any]:
    """A cube of soil that falls on its floor, with four particles an element."""
    return {
        "title": "block",
        "gravity": [0, 0, "-9.81 m/s2"],
        "mesh": {"box": {"size": ["1 m", "1 m", "1 m"], "cells": cells}},
        "materials": {"soil": soil},
        "bodies": {"block": {"volume": "box", "material": "soil"}},
        "boundaries": [{"surface": ["x-min", "x-max", "y-min", "y-max", "z-min"], "kind": "roller"}],
        "stages": [{"name": "fall", "duration": "10 s"}],
    }


def memory() -> float:
    """Resident memory of this process, MB."""
    with open("/proc/self/status", encoding="ascii") as file:
        kilobytes = next(line.split()[1] for line in file if line.startswith("VmRSS:"))
    return int(kilobytes) / 1e3


def copies() -> None:
    soil = {"model": "linear-elastic", "young_modulus": "1 MPa", "poisson_ratio": 0.3, "density": "2 t/m3"}
    sim = moldwarp.Simulation(block([60, 60, 58], soil))
    sim.step(2)
    print(f"{len(sim.particles):,} particles, {memory():,.0f} MB")
    names = ["position", "velocity", "stress"]
    seconds: dict[str, list[float]] = {name: [] for name in names}
    processor: dict[str, list[float]] = {name: [] for name in names}
    sizes = {}
    for _ in range(11):
        # As a program does that looks at it every few steps: the order of particles has to be found anew.
        sim.step(1)
        for name in names:
            begun, used = time.perf_counter(), time.process_time()
            values = getattr(sim.particles, name)
            seconds[name].append(time.perf_counter() - begun)
            processor[name].append(time.process_time() - used)
            sizes[name] = values.shape
            del values
    for name in names:
        first, *later = seconds[name]
        shown = ", ".join(f"{1e3 * s:.0f}" for s in later)
        print(
            f"copy of {name}, {sizes[name]}: the first {1e3 * first:.0f} ms, then {shown} ms; median "
            f"{1e3 * median(later):.0f} ms, of processor time {1e3 * median(processor[name][1:]):.0f} ms"
        )
    gc.collect()
    before = memory()
    with sim.frozen() as particles:
        begun = time.perf_counter()
        views = [*particles.position, *particles.velocity, *particles.stress]
        seconds_viewed = time.perf_counter() - begun
        highest = particles.position.z.max()
        size = sum(np.asarray(view).nbytes for view in views)
        print(
            f"views of {size / 1e6:.0f} MB: {1e6 * seconds_viewed:.0f} µs, "
            f"{memory() - before:.1f} MB more in use (highest particle at {highest:.4f} m)"
        )


def material() -> None:
    constants: dict[str, Any] = {"young_modulus": "1 MPa", "poisson_ratio": 0.3, "density": "2 t/m3"}
    rates: dict[str, list[float]] = {"moldwarp": [], "Python": []}
    processor: dict[str, list[float]] = {"moldwarp": [], "Python": []}
    stresses = {}
    for _ in range(3):
        for name in rates:
            soil = Elastic(**constants) if name == "Python" else {"model": "linear-elastic", **constants}
            sim = moldwarp.Simulation(block([16, 16, 16], soil))
            sim.step(5)
            begun, used = time.perf_counter(), time.process_time()
            sim.step(100)
            rates[name].append((time.perf_counter() - begun) / 100)
            processor[name].append((time.process_time() - used) / 100)
            stresses[name] = sim.particles.stress
    count = len(sim.particles)
    for name, seconds in rates.items():
        shown = ", ".join(f"{1e3 * s:.1f}" for s in seconds)
        print(f"{count:,} particles, law of {name}: {shown} ms a step")
    for what, values in [("wall time", rates), ("processor time", processor)]:
        print(f"ratio of the least {what}: {min(values['Python']) / min(values['moldwarp']):.2f}")
    apart = np.abs(stresses["Python"] - stresses["moldwarp"]).max() / np.abs(stresses["moldwarp"]).max()
    print(f"stresses differ by {apart:.1e} of the greatest")


if __name__ == "__main__":
    for part in sys.argv[1:] or ["copies", "material"]:
        {"copies": copies, "material": material}[part]()
