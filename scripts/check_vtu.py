#!/usr/bin/env python3
"""Reads every frame of ParaView collections with VTK and prints arrays and ranges.

A check that what moldwarp writes is what VTK reads, and a quick look at results without a
screen. Ends with code 1 if a frame cannot be read, its arrays change from frame to frame, or a
value is no finite number.

    pip install pyvista
    python3 scripts/check_vtu.py out/CASE/particles.pvd out/CASE/mesh.pvd
"""

import sys

import numpy as np
import pyvista as pv
import vtk


def label(array):
    """The unit, with the sign convention where one is given."""
    text = array.GetInformation().Get(vtk.vtkDataArray.UNITS_LABEL())
    return f" [{text}]" if text else ""


def check(path):
    reader = pv.get_reader(path)
    problems = []
    ranges = {}
    counts = set()
    names = None
    for time in reader.time_values:
        reader.set_active_time_value(time)
        grid = reader.read()[0]
        counts.add((grid.n_points, grid.n_cells))
        if not np.isclose(grid.field_data["TimeValue"][0], time, rtol=1e-12, atol=0):
            problems.append(f"t = {time}: the frame itself says {grid.field_data['TimeValue'][0]}")
        if names is None:
            names = list(grid.point_data.keys())
        elif names != list(grid.point_data.keys()):
            problems.append(f"t = {time}: other arrays than at first")
        for name in grid.point_data.keys():
            values = grid.point_data[name]
            if not np.isfinite(values).all():
                problems.append(f"t = {time}: {name} is not finite everywhere")
            array = grid.GetPointData().GetAbstractArray(name)
            shape = (array.GetNumberOfComponents(), values.dtype, label(array))
            low, high, old = ranges.get(name, (np.inf, -np.inf, shape))
            if old != shape:
                problems.append(f"t = {time}: {name} changes its type")
            if values.size:
                low, high = min(low, values.min()), max(high, values.max())
            ranges[name] = (low, high, shape)
        cells = set(grid.celltypes.tolist())
        if not cells <= {pv.CellType.VERTEX, pv.CellType.TETRA}:
            problems.append(f"t = {time}: cells of types {cells}")

    times = reader.time_values
    print(f"{path}: {len(times)} frames", end="")
    print(f", t = {times[0]:g} … {times[-1]:g} s" if times else "")
    for points, cells in sorted(counts):
        print(f"  {points} points, {cells} cells")
    for name, (low, high, (components, dtype, unit)) in ranges.items():
        print(f"  {name:<20} {components} × {dtype}{unit}: {low:.6g} … {high:.6g}")
    for problem in problems:
        print(f"  WRONG: {problem}")
    return not problems and bool(times)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(0 if all([check(path) for path in sys.argv[1:]]) else 1)
