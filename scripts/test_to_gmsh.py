#!/usr/bin/env python3
"""That meshes made by to_gmsh.py are what moldwarp takes: python3 scripts/test_to_gmsh.py MOLDWARP

MOLDWARP is the program, target/debug/moldwarp by default. Needs `pip install meshio`.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
MOLDWARP = sys.argv[1] if len(sys.argv) > 1 else HERE.parent / "target/debug/moldwarp"


def convert(source, target):
    command = [sys.executable, HERE / "to_gmsh.py", source, target]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def ground_is_at_rest(source, folder, soil):
    """Converts, checks and runs: a column of 2 t under its K₀ stress, held at all named surfaces."""
    done = convert(HERE / "meshes" / source, folder / "column.msh")
    assert done.returncode == 0, done.stderr
    scene = (HERE / "meshes/scene.toml").read_text().replace('volume = "soil"', f'volume = "{soil}"')
    (folder / "scene.toml").write_text(scene)
    check = subprocess.run([MOLDWARP, "check", folder], capture_output=True, text=True, check=False)
    assert check.returncode == 0, check.stderr
    assert "24 particles, 1 m3, 2000 kg" in check.stdout, check.stdout
    out = folder / "out"
    run = subprocess.run([MOLDWARP, "run", folder, "--out", out], capture_output=True, check=False)
    assert run.returncode == 0, run.stderr
    energy = json.loads((out / "summary.json").read_text())["energy"]
    assert energy["kinetic"] < 1e-12, energy
    print(f"{source}: 20 steps at rest")


def refused(text, name, words, folder):
    (folder / name).write_text(text)
    done = convert(folder / name, folder / "none.msh")
    assert done.returncode == 1 and words in done.stderr, (done.returncode, done.stderr)
    assert not (folder / "none.msh").exists()
    print(f"{name}: refused, {words}")


def main():
    for source, soil in [("column.inp", "soil"), ("column.gid.msh", "material-1")]:
        with tempfile.TemporaryDirectory() as folder:
            ground_is_at_rest(source, Path(folder), soil)
    with tempfile.TemporaryDirectory() as folder:
        hexahedron = 'MESH "a" dimension 3 ElemType Hexahedra Nnode 8\nCoordinates\n'
        hexahedron += "\n".join(f"{i} {i % 2} {i // 2 % 2} {i // 4}" for i in range(1, 9))
        hexahedron += "\nEnd Coordinates\nElements\n1 1 2 3 4 5 6 7 8\nEnd Elements\n"
        refused(hexahedron, "cube.msh", "moldwarp needs tetrahedra of 4", Path(folder))
        plane = "*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n3,0.,1.,0.\n*ELEMENT,TYPE=S3,ELSET=a\n1,1,2,3\n"
        refused(plane, "plane.inp", "has no tetrahedra of 4 nodes", Path(folder))


if __name__ == "__main__":
    main()
