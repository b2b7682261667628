"""Scenes from files, texts, dicts or keywords."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from . import _moldwarp, _toml
from ._errors import FileError
from ._material import Material
from ._mesh import Mesh

__all__ = ["Scene"]

Laws = list[tuple[str, object, list[tuple[str, str]]]]


class Scene:
    """What is to be computed: read, checked, every name resolved.

    ``Scene("examples/slope")`` or ``Scene(path)``
        of a file, or of scene.toml in a folder;
    ``Scene({"version": 1, "gravity": ["0", …], …})``
        of a dict with the keys of scene.toml;
    ``Scene(gravity=[…], mesh=Mesh(…), materials={…}, …)``
        of keywords with these keys. ``version = 1`` need not be said.

    The keys, their units and defaults are those of the book's reference of the scene. A mesh may be a
    :class:`Mesh`, and a material an object of :class:`Material`.

    Parameters
    ----------
    source
        A path or a dict.
    folder
        What paths in a dict or in keywords are relative to; the current folder.
    set
        Changes as of the command's ``--set``: ``{"numerics.courant": 0.4}``.
    start
        ``"OUT@STAGE"``: bodies are as an earlier run left them at the end of a stage.

    Raises
    ------
    SceneError
        If it cannot be computed. The text is what the command shows.
    """

    def __init__(
        self,
        source: str | os.PathLike[str] | Mapping[str, Any] | None = None,
        /,
        *,
        folder: str | os.PathLike[str] = ".",
        set: Mapping[str, Any] | None = None,
        start: str | None = None,
        **keys: Any,
    ) -> None:
        self._meshes: dict[str, Mesh] = {}
        self._materials: dict[str, Material] = {}
        sets = [f"{path}={_set_value(value)}" for path, value in (set or {}).items()]
        if isinstance(source, str | os.PathLike):
            if keys:
                raise TypeError(
                    f"a scene is a file or keywords, not both: `{next(iter(keys))}` can be changed with set={{…}}"
                )
            self._scene = _moldwarp.Scene.load(source, sets)
        else:
            if source is not None and not isinstance(source, Mapping):
                raise TypeError(f"a scene is a path, a dict or keywords, not {source!r}")
            if source is not None and keys:
                raise TypeError("a scene is a dict or keywords, not both")
            content = dict(keys if source is None else source)
            self._scene = self._parse(content, Path(folder), sets)
        if start is not None:
            self._scene = self._scene.inherit(start)

    def _parse(self, content: dict[str, Any], folder: Path, sets: list[str]) -> _moldwarp.Scene:
        content = {"version": 1, **content}
        mesh = content.get("mesh")
        if isinstance(mesh, Mesh):
            mesh = {"file": mesh}
        if isinstance(mesh, Mapping) and isinstance(mesh.get("file"), Mesh):
            given = mesh["file"]
            self._meshes["mesh.msh"] = given
            content["mesh"] = {**mesh, "file": "mesh.msh"}
        materials = content.get("materials")
        if isinstance(materials, Mapping):
            self._materials = {name: m for name, m in materials.items() if isinstance(m, Material)}
        return _moldwarp.Scene.parse(
            folder / "scene.toml",
            _toml.dumps(content),
            sets,
            [(name, mesh._arrays()) for name, mesh in self._meshes.items()],
            laws(self._materials),
        )

    @property
    def text(self) -> str:
        """The scene as TOML."""
        return self._scene.text

    @property
    def case(self) -> str:
        """A short name: that of the scene's folder."""
        return self._scene.case

    @property
    def title(self) -> str:
        """The title, or the case if it has none."""
        return self._scene.title

    @property
    def notes(self) -> list[str]:
        """What one should know though it is no error."""
        return self._scene.notes

    @property
    def mesh(self) -> Mesh:
        """The mesh at the start, in m."""
        return of_arrays(self._scene.mesh)

    def write(self, folder: str | os.PathLike[str]) -> Path:
        """Writes scene.toml, and the mesh if it came from Python, into a folder, for the command.

        Files that the scene names are not copied. Returns the path of scene.toml.

        Raises
        ------
        FileError
            If there is a scene already, or a material is written in Python: the command does not know it.
        """
        if self._materials:
            names = ", ".join(f"`{name}`" for name in self._materials)
            raise FileError(f"the command cannot compute material {names}, whose law is written in Python")
        path = Path(folder) / "scene.toml"
        if path.exists():
            raise FileError(f"there is a scene in {folder} already")
        path.parent.mkdir(parents=True, exist_ok=True)
        for name, mesh in self._meshes.items():
            mesh.write(path.parent / name)
        path.write_text(self.text, encoding="utf-8")
        return path

    def __repr__(self) -> str:
        return f"<Scene {self.title!r}>"


def laws(materials: Mapping[str, Material]) -> Laws:
    for name, material in materials.items():
        if not isinstance(material, Material):
            raise TypeError(f"material `{name}` is no moldwarp.Material: {material!r}")
    return [(name, material, list(material.state.items())) for name, material in materials.items()]


def of_arrays(arrays: Mapping[str, Any]) -> Mesh:
    return Mesh(arrays["points"], arrays["tets"], arrays["volumes"], arrays["surfaces"])


def _set_value(value: Any) -> str:
    plain = _toml.plain(value)
    if isinstance(plain, str):
        # As a TOML string, so that no text is taken for a number.
        return json.dumps(plain, ensure_ascii=False)
    return _toml._value(plain, ("set",))


def to_scene(source: Scene | str | os.PathLike[str] | Mapping[str, Any]) -> Scene:
    if source is None:
        raise TypeError("a simulation needs a scene: a Scene, a path or a dict")
    return source if isinstance(source, Scene) else Scene(source)


