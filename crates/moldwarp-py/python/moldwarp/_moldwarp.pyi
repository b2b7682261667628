"""The compiled part of moldwarp."""

import os
from pathlib import Path
from typing import Any, final

import numpy as np
import numpy.typing as npt

__all__ = ["Lease", "Scene", "Simulation", "VERSION", "quantity", "report_in", "report_of"]

_Floats = npt.NDArray[np.float64]
_Ints = npt.NDArray[np.int64]
_Mesh = tuple[_Floats, _Ints, list[tuple[str, _Ints]], list[tuple[str, _Ints]]]
_Report = tuple[Path, int, list[str]]
_Wishes = tuple[int | None, int | None]
_Law = tuple[str, object, list[tuple[str, str]]]

VERSION: str

@final
class Scene:
    text: str
    case: str
    title: str
    folder: str
    notes: list[str]
    mesh: dict[str, Any]
    @staticmethod
    def load(path: str | os.PathLike[str], sets: list[str]) -> Scene: ...
    @staticmethod
    def parse(
        file: str | os.PathLike[str],
        text: str,
        sets: list[str],
        meshes: list[tuple[str, _Mesh]],
        laws: list[_Law],
    ) -> Scene: ...
    def inherit(self, source: str, /) -> Scene: ...

@final
class Lease:
    over: bool
    def columns(self, name: str) -> tuple[npt.NDArray[Any], ...]: ...
    def end(self) -> None: ...

@final
class Simulation:
    state_fields: list[tuple[str, str, int, list[int]]]
    count: int
    bodies: list[str]
    stages: list[str]
    mesh: dict[str, Any]
    nodes: dict[str, _Floats]
    history: list[tuple[str, str, _Floats]]
    energy: dict[str, float]
    clock: tuple[float, float, float, float, int, int, bool]
    energy_turned_over: float
    warnings: list[str]
    notes: list[str]
    text: str
    case: str
    scene_hash: str
    state_hash: str
    rate: float
    def __new__(cls, scene: Scene, threads: int | None) -> Simulation: ...
    @staticmethod
    def load(path: str | os.PathLike[str], laws: list[_Law], threads: int | None) -> Simulation: ...
    def save(self, path: str | os.PathLike[str]) -> None: ...
    def keep_frames(self, folder: str) -> None: ...
    def advance(self, steps: int, time: float, budget: float) -> int: ...
    def freeze(self) -> Lease: ...
    def array(self, name: str) -> _Floats: ...
    def numbers(self, name: str) -> npt.NDArray[np.integer[Any]]: ...
    def assign(self, name: str, values: _Floats) -> None: ...

def quantity(text: str, dimension: str) -> float: ...
def report_of(
    simulation: Simulation, work: str, to: str | os.PathLike[str], wishes: _Wishes, /
) -> _Report: ...
def report_in(
    folder: str | os.PathLike[str], to: str | os.PathLike[str] | None, wishes: _Wishes, /
) -> _Report: ...
