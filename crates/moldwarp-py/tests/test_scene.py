"""Scenes: three ways to say the same, and what is said of wrong ones."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import moldwarp
import numpy as np
import pytest
from moldwarp import _toml

E = "examples/absorbing-column"


def test_dict_keywords_and_file_are_the_same(root: Path) -> None:
    path = root / E / "scene.toml"
    content = tomllib.loads(path.read_text(encoding="utf-8"))
    scenes = [
        moldwarp.Scene(path),
        moldwarp.Scene(str(root / E)),
        moldwarp.Scene(content, folder=root / E),
        moldwarp.Scene(**content, folder=root / E),
    ]
    assert {moldwarp.Simulation(scene).scene_hash for scene in scenes} == {moldwarp.Simulation(path).scene_hash}
    assert scenes[0].title == "Suddenly loaded layer on an absorbing bottom"
    assert scenes[2].case == "absorbing-column"


@pytest.mark.parametrize("example", ["slope", "tunnel-face", "drop-anchor", "dynamic-probing"])
def test_the_text_of_a_dict_says_what_the_dict_does(root: Path, example: str) -> None:
    content = tomllib.loads((root / "examples" / example / "scene.toml").read_text(encoding="utf-8"))
    assert tomllib.loads(_toml.dumps(content)) == content


def test_values_of_python_and_numpy(column: dict[str, Any]) -> None:
    column["gravity"] = np.array([0.0, 0.0, -10.0])
    column["materials"]["soil"]["poisson_ratio"] = np.float32(0.25)
    column["stages"] = ({"name": 'with "quotes"\n', "steps": np.int64(3), "damping": None},)
    text = moldwarp.Scene(column).text
    read = tomllib.loads(text)
    assert read["gravity"] == [0.0, 0.0, -10.0]
    assert read["stages"] == [{"name": 'with "quotes"\n', "steps": 3}]
    column["title"] = object()
    with pytest.raises(TypeError, match="title is of type object, which a scene cannot hold"):
        moldwarp.Scene(column)


def test_changes_as_of_the_command(column: dict[str, Any]) -> None:
    scene = moldwarp.Scene(column, set={"numerics.courant": 0.25, "materials.soil.young_modulus": "50 kPa"})
    assert tomllib.loads(scene.text)["numerics"] == {"courant": 0.25}
    with pytest.raises(moldwarp.SceneError, match="courrant"):
        moldwarp.Scene(column, set={"numerics.courrant": 0.25})


def _said(error: moldwarp.SceneError) -> str:
    """Decimals behind the fourth may differ between processors."""
    return re.sub(r"(\.\d{4})\d+", r"\1", str(error))


BAD = Path(__file__).resolve().parents[3] / "tests/bad/scenes"


@pytest.mark.parametrize(
    "name",
    ["unknown-key", "unknown-material", "wrong-dimension", "no-stages", "time-step-above-stable", "mesh-missing",
     "bodies-overlap", "decimal-comma", "probe-outside", "k0-beyond-strength", "there-is-no-such"],
)
def test_errors_have_the_text_of_the_command(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The texts are the snapshots of the corpus of wrong input."""
    monkeypatch.chdir(BAD.parent)
    snapshot = (BAD / "snapshots" / f"{name}-toml.snap").read_text(encoding="utf-8")
    expected = snapshot.split("---\n", 2)[2].rstrip("\n")
    with pytest.raises(moldwarp.SceneError) as caught:
        moldwarp.Simulation(f"scenes/{name}.toml")
    assert _said(caught.value).strip() == expected.strip()
    assert caught.value.message.split()[0] in str(caught.value)
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        ("materials.soil.young_modulus", "100 kg", "a stress"),
        ("materials.soil.modell", "elastic", "model"),
        ("bodies.layer.material", "sioil", "soil"),
        ("boundaries", [{"surface": "bottom", "kind": "fixed"}], "z-min"),
        ("stages", [], "stage"),
        ("mesh", {"file": "nowhere.msh"}, "there is no mesh file"),
        ("gravity", None, "gravity"),
        ("bodies.layer.volume", 3, "volume"),
    ],
)
def test_wrong_dicts_are_told_where_and_why(column: dict[str, Any], path: str, value: Any, said: str) -> None:
    *parents, last = path.split(".")
    at: dict[str, Any] = column
    for parent in parents:
        at = at[parent]
    at[last] = value
    with pytest.raises(moldwarp.SceneError, match=said) as caught:
        moldwarp.Scene(column)
    assert "scene.toml" in str(caught.value) or caught.value.help


def test_what_is_no_scene() -> None:
    with pytest.raises(TypeError, match="a file or keywords"):
        moldwarp.Scene("x.toml", gravity=[0, 0, 0])
    with pytest.raises(TypeError, match="a path, a dict or keywords, not 3"):
        moldwarp.Simulation(3)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="needs a scene"):
        moldwarp.Simulation(None)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="a dict or keywords"):
        moldwarp.Scene({}, gravity=[0, 0, 0])
    with pytest.raises(TypeError, match="keys of a scene are texts"):
        moldwarp.Scene({"gravity": [0, 0, 0], 3: 4})  # type: ignore[dict-item]
    with pytest.raises(moldwarp.SceneError, match="there is no scene"):
        moldwarp.Scene("no-such-folder")


def cube() -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Two tetrahedra over a triangle."""
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, -1.0]])
    return points, np.array([[0, 1, 2, 3], [0, 1, 2, 4]])


def on_mesh(mesh: Any) -> dict[str, Any]:
    return {
        "gravity": [0, 0, 0],
        "mesh": mesh,
        "materials": {
            "m": {"model": "linear-elastic", "young_modulus": 1e5, "poisson_ratio": 0.0, "density": 1000.0}
        },
        "bodies": {"b": {"volume": "upper", "material": "m"}},
        "boundaries": [{"surface": "middle", "kind": "fixed"}],
        "stages": [{"name": "s", "steps": 2}],
    }


def test_a_mesh_of_arrays(tmp_path: Path) -> None:
    points, tets = cube()
    mesh = moldwarp.Mesh(points, tets, {"upper": [0], "lower": [1]}, {"middle": [[2, 1, 0]]})
    # The second one is inside out, and is turned round.
    assert sorted(mesh.tets[1]) == [0, 1, 2, 4]
    scene = moldwarp.Scene(on_mesh(mesh))
    sim = moldwarp.Simulation(scene).run()
    assert len(sim.particles) == 4
    assert np.array_equal(sim.mesh.points, points)
    assert list(sim.mesh.surfaces) == ["middle"]
    written = moldwarp.Simulation(scene.write(tmp_path)).run()
    assert written.state_hash == sim.state_hash
    with pytest.raises(moldwarp.FileError, match="already"):
        scene.write(tmp_path)
    scaled = moldwarp.Scene(on_mesh({"file": mesh, "unit": "cm"}))
    assert np.allclose(scaled.mesh.points, 0.01 * points)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"tets": [[0, 1, 2, 9]]}, "number 9; they are counted from 0, and there are 5"),
        ({"tets": [[0, 1, 2, -1]]}, "number -1"),
        ({"tets": [[0, 1, 2]]}, r"tets: an array of shape \(n, 4\)"),
        ({"tets": [[0.0, 1, 2, 3]]}, "integers, not float64"),
        ({"points": [[0, 0]]}, r"points: an array of shape \(n, 3\)"),
        ({"volumes": {"upper": [2]}}, "element of volume `upper` is number 2"),
        ({"surfaces": {"middle": [[0, 1, 3], [1, 2, 7]]}}, "node of surface `middle` is number 7"),
        ({"surfaces": {"middle": [[1, 3, 4]]}}, "no face"),
        ({"points": np.zeros((5, 3))}, "flat"),
        ({"points": np.full((5, 3), np.nan)}, "finite"),
        ({"volumes": {"upper": [0], "lower": [0, 1]}}, "two"),
    ],
)
def test_wrong_meshes(change: dict[str, Any], said: str) -> None:
    points, tets = cube()
    right: dict[str, Any] = {
        "points": points,
        "tets": tets,
        "volumes": {"upper": [0]},
        "surfaces": {"middle": [[0, 1, 2]]},
    }
    with pytest.raises((ValueError, TypeError), match=said):
        moldwarp.Scene(on_mesh(moldwarp.Mesh(**{**right, **change})))


def test_a_mesh_of_meshio(root: Path) -> None:
    meshio = pytest.importorskip("meshio")
    read = meshio.read(root / E / "column.msh")
    mesh = moldwarp.Mesh.from_meshio(read)
    assert list(mesh.volumes) == ["soil"]
    assert {"top", "bottom", "x-min"} <= set(mesh.surfaces)
    content = tomllib.loads((root / E / "scene.toml").read_text(encoding="utf-8"))
    by_meshio = moldwarp.Simulation({**content, "mesh": mesh, "compare": None})
    by_file = moldwarp.Simulation(root / E)
    assert len(by_meshio.particles) == len(by_file.particles)
    assert np.isclose(by_meshio.particles.volume.sum(), by_file.particles.volume.sum(), rtol=1e-12)
    hexahedra = meshio.Mesh(np.zeros((8, 3)), [("hexahedron", [list(range(8))])])
    with pytest.raises(ValueError, match="cells of type hexahedron"):
        moldwarp.Mesh.from_meshio(hexahedra)


def test_a_mesh_of_gmsh() -> None:
    try:
        import gmsh
    except (ImportError, OSError):
        pytest.skip("gmsh is not there")
    # Else it would take Ctrl-C for itself.
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        box = gmsh.model.occ.addBox(0, 0, 0, 0.2, 0.2, 0.4)
        gmsh.model.occ.synchronize()
        with pytest.raises(ValueError, match="generate"):
            moldwarp.Mesh.from_gmsh(gmsh)
        gmsh.model.addPhysicalGroup(3, [box], name="upper")
        low = [s for _, s in gmsh.model.getEntities(2) if abs(gmsh.model.occ.getCenterOfMass(2, s)[2]) < 1e-9]
        gmsh.model.addPhysicalGroup(2, low, name="middle")
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.1)
        gmsh.model.mesh.generate(3)
        mesh = moldwarp.Mesh.from_gmsh(gmsh)
    finally:
        gmsh.finalize()
    sim = moldwarp.Simulation(on_mesh(mesh))
    assert np.isclose(sim.particles.volume.sum(), 0.016, rtol=1e-12)
    assert mesh.points[mesh.surfaces["middle"]][..., 2].max() < 1e-12
