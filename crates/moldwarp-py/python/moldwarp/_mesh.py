"""Meshes of tetrahedra that come from Python."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["Mesh"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


class Mesh:
    """A mesh of four-node tetrahedra with named volumes and surfaces.

    Parameters
    ----------
    points : array of shape (n, 3)
        Coordinates in m.
    tets : array of shape (m, 4)
        Numbers of points, from 0. Elements that are turned inside out are turned round.
    volumes : dict of str to array
        Names of volumes and the numbers of their elements, from 0. Without any, all elements are
        the volume ``"all"``.
    surfaces : dict of str to array of shape (k, 3)
        Names of surfaces and their triangles, as numbers of points; each must be a face of an element.
    """

    points: Floats
    tets: Ints
    volumes: dict[str, Ints]
    surfaces: dict[str, Ints]

    def __init__(
        self,
        points: npt.ArrayLike,
        tets: npt.ArrayLike,
        volumes: Mapping[str, npt.ArrayLike] | None = None,
        surfaces: Mapping[str, npt.ArrayLike] | None = None,
    ) -> None:
        self.points = _array(points, np.float64, (-1, 3), "points")
        self.tets = _array(tets, np.int64, (-1, 4), "tets").copy()
        if volumes is None:
            volumes = {"all": np.arange(len(self.tets))}
        self.volumes = {name: _array(v, np.int64, (-1,), f"volume `{name}`") for name, v in volumes.items()}
        surfaces = surfaces or {}
        self.surfaces = {name: _array(s, np.int64, (-1, 3), f"surface `{name}`") for name, s in surfaces.items()}
        if self.tets.size and self.tets.min() >= 0 and self.tets.max() < len(self.points):
            corners = self.points[self.tets]
            edges = corners[:, 1:] - corners[:, :1]
            inside_out = np.einsum("ni,ni->n", np.cross(edges[:, 0], edges[:, 1]), edges[:, 2]) < 0.0
            self.tets[np.ix_(inside_out, [2, 3])] = self.tets[np.ix_(inside_out, [3, 2])]

    @classmethod
    def from_meshio(cls, mesh: Any) -> Mesh:
        """Of a ``meshio.Mesh``.

        Volumes and surfaces are its Gmsh physical groups, else its cell sets; elements in none are the
        volume ``"all"`` if there are no groups at all. Cells that are neither tetrahedra nor triangles are
        left out, unless they are of volume: those are refused.
        """
        names = {(int(v[1]), int(v[0])): name for name, v in mesh.field_data.items()}
        physical = mesh.cell_data.get("gmsh:physical")
        blocks = list(mesh.cells)
        wrong = sorted({b.type for b in blocks} & _SOLID)
        if wrong:
            raise ValueError(
                f"the mesh has cells of type {', '.join(wrong)}; moldwarp computes four-node tetrahedra"
            )
        tets: list[npt.NDArray[Any]] = []
        volumes: dict[str, list[npt.NDArray[Any]]] = {}
        surfaces: dict[str, list[npt.NDArray[Any]]] = {}
        count = 0
        for number, block in enumerate(blocks):
            if block.type not in ("tetra", "triangle"):
                continue
            data = np.asarray(block.data)
            dimension = 3 if block.type == "tetra" else 2
            groups: dict[str, npt.NDArray[Any]] = {}
            if physical is not None:
                tags = np.asarray(physical[number])
                for tag in np.unique(tags):
                    groups[names.get((dimension, int(tag)), str(int(tag)))] = np.flatnonzero(tags == tag)
            else:
                for name, sets in (mesh.cell_sets or {}).items():
                    members = sets[number] if number < len(sets) else None
                    if members is not None and len(members):
                        groups[name] = np.asarray(members)
            for name, members in groups.items():
                if dimension == 3:
                    volumes.setdefault(name, []).append(members + count)
                else:
                    surfaces.setdefault(name, []).append(data[members])
            if dimension == 3:
                tets.append(data)
                count += len(data)
        if not tets:
            raise ValueError("the mesh has no tetrahedra")
        points = np.asarray(mesh.points, dtype=np.float64)
        all_tets = np.concatenate(tets)
        used, renumbered = np.unique(all_tets, return_inverse=True)
        numbers = np.full(len(points), -1, dtype=np.int64)
        numbers[used] = np.arange(len(used))
        return cls(
            points[used],
            renumbered.reshape(all_tets.shape),
            {name: np.concatenate(parts) for name, parts in volumes.items()} or None,
            {name: numbers[np.concatenate(parts)] for name, parts in surfaces.items()},
        )

    @classmethod
    def from_gmsh(cls, gmsh: Any = None) -> Mesh:
        """Of the current model of the module ``gmsh``, as it is meshed now.

        Volumes and surfaces are its physical groups, by name, or by tag if they have none.
        ``gmsh.initialize(interruptible=False)`` leaves Ctrl-C to Python, and so to moldwarp.
        """
        if gmsh is None:
            import gmsh  # type: ignore[no-redef]
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        tags = np.asarray(tags, dtype=np.int64)
        points = np.asarray(coordinates, dtype=np.float64).reshape(-1, 3)
        numbers = np.full(int(tags.max(initial=-1)) + 1, -1, dtype=np.int64)
        numbers[tags] = np.arange(len(tags))
        elements: list[Ints] = []
        place: dict[int, int] = {}
        for _, volume in gmsh.model.getEntities(3):
            types, found, nodes = gmsh.model.mesh.getElements(3, volume)
            for kind, own, ends in zip(types, found, nodes):
                if kind != 4:
                    name = gmsh.model.mesh.getElementProperties(kind)[0]
                    raise ValueError(
                        f"the mesh has elements of type {name}; moldwarp computes four-node tetrahedra"
                    )
                first = len(place)
                place.update(zip(map(int, own), range(first, first + len(own))))
                elements.append(numbers[np.asarray(ends, dtype=np.int64)].reshape(-1, 4))
        if not elements:
            raise ValueError("the model has no tetrahedra: gmsh.model.mesh.generate(3) makes them")
        volumes: dict[str, Ints] = {}
        surfaces: dict[str, Ints] = {}
        for dimension, tag in gmsh.model.getPhysicalGroups():
            name = gmsh.model.getPhysicalName(dimension, tag) or str(tag)
            for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag):
                types, found, nodes = gmsh.model.mesh.getElements(dimension, entity)
                for kind, own, ends in zip(types, found, nodes):
                    if dimension == 3:
                        members = np.array([place[int(e)] for e in own], dtype=np.int64)
                        volumes[name] = np.concatenate([volumes.get(name, members[:0]), members])
                    elif dimension == 2 and kind == 2:
                        faces = numbers[np.asarray(ends, dtype=np.int64)].reshape(-1, 3)
                        surfaces[name] = np.concatenate([surfaces.get(name, faces[:0]), faces])
        tets = np.concatenate(elements)
        used, renumbered = np.unique(tets, return_inverse=True)
        new = np.full(len(points), -1, dtype=np.int64)
        new[used] = np.arange(len(used))
        return cls(
            points[used],
            renumbered.reshape(tets.shape),
            volumes or None,
            {name: new[faces] for name, faces in surfaces.items()},
        )

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the mesh as a Gmsh file (MSH 2.2), with all digits of the coordinates."""
        names = [(3, name) for name in self.volumes] + [(2, name) for name in self.surfaces]
        tags = {key: tag for tag, key in enumerate(names, start=1)}
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
        lines += [f'{dimension} {tags[dimension, name]} "{name}"' for dimension, name in names]
        lines += ["$EndPhysicalNames", "$Nodes", str(len(self.points))]
        lines += [f"{i} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(self.points.tolist(), start=1)]
        group = np.zeros(len(self.tets), dtype=np.int64)
        for name, members in self.volumes.items():
            group[members] = tags[3, name]
        cells = [f"{2} {tags[2, name]} {tags[2, name]} {a + 1} {b + 1} {c + 1}"
                 for name, faces in self.surfaces.items() for a, b, c in faces.tolist()]
        solid = [f"{2} {g} {g} {a + 1} {b + 1} {c + 1} {d + 1}"
                 for g, (a, b, c, d) in zip(group.tolist(), self.tets.tolist())]
        lines += ["$EndNodes", "$Elements", str(len(cells) + len(solid))]
        lines += [f"{i} 2 {cell}" for i, cell in enumerate(cells, start=1)]
        lines += [f"{i} 4 {cell}" for i, cell in enumerate(solid, start=len(cells) + 1)]
        Path(path).write_text("\n".join([*lines, "$EndElements", ""]), encoding="utf-8")

    def _arrays(self) -> tuple[Floats, Ints, list[tuple[str, Ints]], list[tuple[str, Ints]]]:
        return self.points, self.tets, list(self.volumes.items()), list(self.surfaces.items())

    def __repr__(self) -> str:
        return (
            f"<Mesh of {len(self.tets)} elements and {len(self.points)} nodes, volumes {list(self.volumes)}, "
            f"surfaces {list(self.surfaces)}>"
        )


_SOLID = {"hexahedron", "wedge", "pyramid", "tetra10", "hexahedron20", "hexahedron27", "wedge15"}


def _array(values: npt.ArrayLike, dtype: Any, shape: tuple[int, ...], what: str) -> npt.NDArray[Any]:
    given = np.asarray(values)
    if dtype is np.int64 and given.size and given.dtype.kind not in "iu":
        raise TypeError(f"{what}: numbers of points and elements are integers, not {given.dtype}")
    array = np.ascontiguousarray(given, dtype=dtype)
    if array.ndim != len(shape) or (len(shape) == 2 and array.shape[1] != shape[1]):
        wanted = "(n,)" if len(shape) == 1 else f"(n, {shape[1]})"
        if array.size == 0:
            return np.zeros([0, *shape[1:]], dtype=dtype)
        raise ValueError(f"{what}: an array of shape {wanted}, not {array.shape}")
    return array
