#!/usr/bin/env python3
"""Makes a Gmsh mesh (MSH 2.2) with named groups from a mesh of another program.

    pip install meshio
    python3 scripts/to_gmsh.py model.inp model.msh      Abaqus
    python3 scripts/to_gmsh.py model.bdf model.msh      Nastran; and whatever else meshio reads
    python3 scripts/to_gmsh.py model.gid.msh model.msh  GiD's own mesh (ASCII); needs no meshio

Sets of tetrahedra become volumes, sets of triangles surfaces. A set of nodes becomes the surface of all
triangles of which it has all three nodes, as far as they are on the outside of the mesh or between two
volumes. Only four-node tetrahedra are taken: other volume elements are an error.

In a GiD mesh the number after an element's nodes is its material: the volume `material-N`. Its meshes of
triangles are surfaces by their names.
"""

import argparse
import re
import sys
from collections import defaultdict
from pathlib import Path

FACES = [(1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2)]


class Mesh:
    def __init__(self):
        self.points = []
        self.tets = []
        self.volumes = defaultdict(set)  # name: places in `tets`
        self.surfaces = defaultdict(set)  # name: triangles, each a sorted tuple of nodes


def read_gid(text):
    mesh, numbers = Mesh(), {}
    pattern = r"^\s*MESH\b(.*?)$(.*?)^\s*end elements"
    for head, body in re.findall(pattern, text, re.M | re.S | re.I):
        kind = re.search(r"elemtype\s+(\w+)", head, re.I)[1].lower()
        nodes = int(re.search(r"nnode\s+(\d+)", head, re.I)[1])
        name = re.search(r'"([^"]*)"', head)
        name = name[1].strip().replace(" ", "-") if name else ""
        parts = re.split(r"^\s*(?:end )?coordinates\s*$|^\s*elements\s*$", body, flags=re.M | re.I)
        rows = [[line.split() for line in part.splitlines() if line.split()] for part in parts]
        for number, *x in rows[1]:
            numbers[int(number)] = len(mesh.points)
            mesh.points.append([float(c) for c in x[:3]])
        for _, *row in rows[-1]:
            corners = tuple(numbers[int(n)] for n in row[:nodes])
            material = row[nodes] if len(row) > nodes else "0"
            if (kind, nodes) == ("tetrahedra", 4):
                mesh.volumes[f"material-{material}"].add(len(mesh.tets))
                mesh.tets.append(corners)
            elif (kind, nodes) == ("triangle", 3):
                mesh.surfaces[name or f"surface-{material}"].add(tuple(sorted(corners)))
            elif kind not in ["linear", "point", "triangle"]:
                sys.exit(f"elements of type {kind} with {nodes} nodes: moldwarp needs tetrahedra of 4")
    return mesh


def read_meshio(path):
    try:
        import meshio
    except ImportError:
        sys.exit("meshio is needed for this format: pip install meshio")
    try:
        source, mesh = meshio.read(path), Mesh()
    except meshio.ReadError as error:
        sys.exit(f"{path} cannot be read: {error}")
    mesh.points = [[*map(float, x), 0.0][:3] for x in source.points]
    first = {}  # of each block of tetrahedra, the place of its first one
    for number, block in enumerate(source.cells):
        if block.type == "tetra":
            first[number] = len(mesh.tets)
            mesh.tets += [tuple(map(int, t)) for t in block.data]
        elif block.dim == 3:
            sys.exit(f"elements of type {block.type}: moldwarp needs tetrahedra of 4 nodes")
    for name, blocks in source.cell_sets.items():
        for number, (block, places) in enumerate(zip(source.cells, blocks)):
            if places is None or not len(places):
                continue
            if number in first:
                mesh.volumes[name] |= {first[number] + int(p) for p in places}
            elif block.type == "triangle":
                triangles = (tuple(sorted(map(int, block.data[int(p)]))) for p in places)
                mesh.surfaces[name] |= set(triangles)
    owner = {t: n for n, tets in mesh.volumes.items() for t in tets}
    borders = border(mesh, owner)
    for name, places in source.point_sets.items():
        chosen = {int(p) for p in places}
        mesh.surfaces[name] |= {f for f in borders if chosen.issuperset(f)}
    return mesh


def border(mesh, owner):
    """Faces on the outside or between two volumes."""
    sides = defaultdict(list)
    for number, tet in enumerate(mesh.tets):
        for face in FACES:
            sides[tuple(sorted(tet[i] for i in face))].append(owner.get(number))
    return {f for f, owners in sides.items() if len(owners) == 1 or owners[0] != owners[1]}


def write(mesh, path):
    rest = set(range(len(mesh.tets))).difference(*mesh.volumes.values())
    if rest:
        mesh.volumes["rest" if mesh.volumes else "all"] = rest
    of = defaultdict(list)
    for name, tets in mesh.volumes.items():
        for tet in tets:
            of[tet].append(name)
    twice = next((names for names in of.values() if len(names) > 1), None)
    if twice:
        sys.exit(f"the volumes {' and '.join(twice)} overlap: leave one of them out with --skip")
    groups = [(3, name) for name in mesh.volumes] + [(2, n) for n, f in mesh.surfaces.items() if f]
    tag = {group: number for number, group in enumerate(groups, 1)}
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    lines += [f'{dimension} {tag[dimension, name]} "{name}"' for dimension, name in groups]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(mesh.points))]
    lines += [f"{i} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(mesh.points, 1)]
    elements = [(4, tag[3, of[i][0]], tet) for i, tet in enumerate(mesh.tets)]
    for (dimension, name), number in tag.items():
        if dimension == 2:
            elements += [(2, number, face) for face in sorted(mesh.surfaces[name])]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    for i, (kind, number, corners) in enumerate(elements, 1):
        lines.append(f"{i} {kind} 2 {number} {number} " + " ".join(str(c + 1) for c in corners))
    Path(path).write_text("\n".join([*lines, "$EndElements", ""]), encoding="utf-8")
    for dimension, name in groups:
        count = len(mesh.volumes[name] if dimension == 3 else mesh.surfaces[name])
        print(f"{'surface' if dimension == 2 else 'volume '} {name}: {count} elements")
    for name, faces in mesh.surfaces.items():
        if not faces:
            print(f"set {name}: no triangle has all its nodes; left out", file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("source")
    parser.add_argument("target")
    parser.add_argument("--skip", nargs="*", default=[], help="sets to leave out")
    arguments = parser.parse_args()
    if not Path(arguments.source).is_file():
        sys.exit(f"{arguments.source} does not exist")
    with open(arguments.source, encoding="utf-8", errors="replace") as file:
        text = file.read()
    # Comments and empty lines may come before the first mesh; Gmsh's files begin with a dollar.
    is_gid = re.match(r"(?:\s*#[^\n]*\n|\s*\n)*\s*MESH\b", text, re.I)
    mesh = read_gid(text) if is_gid else read_meshio(arguments.source)
    if not mesh.tets:
        sys.exit(f"{arguments.source} has no tetrahedra of 4 nodes")
    for name in arguments.skip:
        mesh.volumes.pop(name, None)
        mesh.surfaces.pop(name, None)
    write(mesh, arguments.target)


if __name__ == "__main__":
    main()
