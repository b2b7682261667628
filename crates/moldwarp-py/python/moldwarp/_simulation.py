"""Simulations."""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from . import _moldwarp
from ._history import History
from ._material import Material
from ._mesh import Mesh
from ._particles import Nodes, Particles
from ._progress import Bar
from ._report import Report, wishes
from ._scene import Scene, laws, of_arrays, to_scene
from ._views import Frozen

__all__ = ["Simulation"]

BUDGET = 0.05
"""Seconds of stepping between two looks at Ctrl-C."""


class Simulation:
    """A scene that is being computed.

    Parameters
    ----------
    scene
        A :class:`Scene`, or what one is made of: a path or a dict.
    threads
        Threads of its own; without it, it shares those of all simulations, one a core. For many simulations at
        a time give each one thread. Results are the same bit for bit.
    keep_frames
        Whether to keep frames for :meth:`report`, as often as the scene's ``output`` asks for them, in a temporary
        folder that goes with the simulation. Each has about 200 bytes a particle; the environment's ``TMPDIR`` says
        where the folder is made.

    Raises
    ------
    SceneError
        If the scene cannot be set up.
    """

    def __init__(
        self,
        scene: Scene | str | os.PathLike[str] | Mapping[str, Any],
        *,
        threads: int | None = None,
        keep_frames: bool = False,
    ) -> None:
        scene = to_scene(scene)
        self._simulation = _moldwarp.Simulation(scene._scene, _threads(threads))
        self._title = scene.title
        self._keep_frames(keep_frames)

    @classmethod
    def load(
        cls,
        path: str | os.PathLike[str],
        *,
        materials: Mapping[str, Material] | None = None,
        threads: int | None = None,
        keep_frames: bool = False,
    ) -> Simulation:
        """What :meth:`save` has written; it goes on bit for bit.

        ``materials`` are those written in Python, by name: the file does not hold their code, nor frames.
        """
        simulation = cls.__new__(cls)
        simulation._simulation = _moldwarp.Simulation.load(path, laws(materials or {}), _threads(threads))
        simulation._title = simulation._simulation.case
        simulation._keep_frames(keep_frames)
        return simulation

    def _keep_frames(self, wanted: bool) -> None:
        # The folder goes with the last reference to it.
        self._frames = tempfile.TemporaryDirectory(prefix="moldwarp-") if wanted else None
        if self._frames is not None:
            self._simulation.keep_frames(self._frames.name)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the whole state with its history into a file, which is for this version of moldwarp."""
        self._simulation.save(path)

    def step(self, steps: int = 1) -> None:
        """Makes so many steps, or those that are left.

        Raises
        ------
        StoppedError
            If a guard stops it. It can be looked at, but not go on.
        """
        if isinstance(steps, bool) or not isinstance(steps, int | np.integer) or steps < 0:
            raise ValueError(f"a number of steps is a whole number from 0 on, not {steps!r}")
        self._advance(int(steps), math.inf, None, None, False)

    def run(
        self,
        until: float | str | None = None,
        *,
        callback: Callable[[Simulation], object] | None = None,
        every: int = 1,
        progress: bool | None = None,
    ) -> Simulation:
        """Computes to the end, or to the first step at or after a time. Returns the simulation.

        Ctrl-C ends it between two steps with ``KeyboardInterrupt``; it can go on then.

        Parameters
        ----------
        until
            Time since the start, s, or with its unit: ``"0.5 s"``.
        callback
            Called with the simulation after every ``every`` steps, and at the end. It may look at it and change
            what can be changed; ``return False`` ends the run.
        progress
            Whether to show how far it is; in notebooks and terminals if not said.

        Raises
        ------
        StoppedError
            If a guard stops it.
        FileError
            If a frame that is to be kept cannot be written. It can go on, without that frame.
        """
        time = math.inf if until is None else _time(until)
        if time < self.time:
            raise ValueError(f"the simulation is at {self.time} s already, after {time} s")
        if isinstance(every, bool) or not isinstance(every, int | np.integer) or every < 1:
            raise ValueError(f"`every` is a number of steps from 1 on, not {every!r}")
        self._advance(None, time, callback, int(every), progress)
        return self

    def _advance(
        self,
        steps: int | None,
        time: float,
        callback: Callable[[Simulation], object] | None,
        every: int | None,
        progress: bool | None,
    ) -> None:
        left = 2**63 if steps is None else steps
        since = 0
        with Bar(progress, self._title, self.time, min(time, self.end)) as bar:
            while left > 0 and not self.finished and self.time < time * (1.0 - 1e-12):
                most = left if callback is None else min(left, (every or 1) - since)
                done = self._simulation.advance(most, time, BUDGET)
                left -= done
                since += done
                bar.at(self.time, min(time, self.end))
                over = left <= 0 or self.finished or self.time >= time * (1.0 - 1e-12)
                if callback is not None and since > 0 and (since == every or over):
                    since = 0
                    if callback(self) is False:
                        break

    @property
    def particles(self) -> Particles:
        """Particles' arrays by id: copies that can be assigned back."""
        return Particles(self._simulation)

    @particles.setter
    def particles(self, value: object) -> None:
        raise AttributeError("particles cannot be replaced; assign sim.particles.velocity or sim.particles.stress")

    @property
    def nodes(self) -> Nodes:
        """Fields over the nodes of the mesh."""
        return Nodes(self._simulation)

    @property
    def mesh(self) -> Mesh:
        """The mesh as it is now: a copy."""
        return of_arrays(self._simulation.mesh)

    def frozen(self) -> Frozen:
        """A block with views of the particles' arrays, without a copy::

            with sim.frozen() as particles:
                fastest = np.abs(particles.velocity.z).max()

        Stepping or changing the simulation inside raises :class:`FrozenError`, and so does a view that is used
        after the block.
        """
        return Frozen(self._simulation)

    @property
    def history(self) -> History:
        """Probes, contacts and energies over time, as the scene's ``output.history`` asks for: a copy."""
        return History(self._simulation.history)

    @property
    def energy(self) -> dict[str, float]:
        """Energies by kind, of the whole body, J. All but ``residual`` come from their own formulas."""
        return self._simulation.energy

    @property
    def energy_turned_over(self) -> float:
        """What errors of energies are judged against, J."""
        return self._simulation.energy_turned_over

    @property
    def warnings(self) -> list[str]:
        """What to doubt in the results: a ledger that does not close, particles where they should not be."""
        return self._simulation.warnings

    @property
    def notes(self) -> list[str]:
        """What one should know of the scene."""
        return self._simulation.notes

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies, by number."""
        return self._simulation.bodies

    @property
    def stages(self) -> list[str]:
        """Names of the stages, by number."""
        return self._simulation.stages

    @property
    def stage(self) -> str | None:
        """Name of the stage that it is in; None when all are done."""
        number = self._simulation.clock[5]
        stages = self.stages
        return stages[number] if number < len(stages) else None

    @property
    def time(self) -> float:
        """Since the start, s."""
        return self._simulation.clock[0]

    @property
    def end(self) -> float:
        """When it will end, s; an estimate where stages are given in steps."""
        return self._simulation.clock[1]

    @property
    def time_step(self) -> float:
        """The last step, s; 0 before the first."""
        return self._simulation.clock[2]

    @property
    def next_time_step(self) -> float:
        """The coming step, s; 0 at the end."""
        return self._simulation.clock[3]

    @property
    def steps(self) -> int:
        """Steps made."""
        return self._simulation.clock[4]

    @property
    def finished(self) -> bool:
        """Whether all stages are done."""
        return self._simulation.clock[6]

    @property
    def rate(self) -> float:
        """Particles times steps per second of stepping so far."""
        return self._simulation.rate

    @property
    def scene_hash(self) -> str:
        """Fingerprint of the scene, as in the command's summary.json."""
        return self._simulation.scene_hash

    @property
    def state_hash(self) -> str:
        """Fingerprint of the state: two simulations are the same, bit for bit, when it is the same."""
        return self._simulation.state_hash

    def report(
        self,
        path: str | os.PathLike[str] = "report.html",
        *,
        particles: int | None = None,
        frames: int | None = None,
    ) -> Report:
        """Writes the report of the simulation as it stands: one page that opens in any browser, without a network.

        It is the page that ``moldwarp report`` makes of a run: answers, curves of the history, the energy ledger,
        tables, and the ground in 3D, in its present state, and over time with ``keep_frames=True``.

        Parameters
        ----------
        path
            Where it goes. A report that is there is replaced, another file is not.
        particles, frames
            How many are drawn at most.

        Raises
        ------
        FileError
            If it cannot be written.
        """
        with tempfile.TemporaryDirectory(prefix="moldwarp-") as work:
            return Report(*_moldwarp.report_of(self._simulation, work, path, wishes(particles, frames)))

    def to_pyvista(self) -> Any:
        """The particles as a ``pyvista.PolyData`` with the fields of the command's frames, by id."""
        pyvista = _pyvista()
        p = self.particles
        stress = p.stress
        cloud = pyvista.PolyData(np.array(p.position))
        deviator = stress.copy()
        deviator[:, :3] += p.mean_pressure[:, None]
        squares = (deviator[:, :3] ** 2).sum(axis=1) + 2.0 * (deviator[:, 3:] ** 2).sum(axis=1)
        fields = {
            "id": p.id,
            "body": p.body,
            "velocity": p.velocity,
            "displacement": p.displacement,
            # VTK counts XX YY ZZ XY YZ XZ.
            "stress": stress,
            "mean_pressure": p.mean_pressure,
            "deviatoric_stress": np.sqrt(1.5 * squares),
            "density": p.density,
            **p.state,
        }
        for name, values in fields.items():
            cloud.point_data[name] = np.array(values)
        return cloud

    def mesh_to_pyvista(self) -> Any:
        """The mesh as a ``pyvista.UnstructuredGrid`` with velocity, mass and reaction of its nodes."""
        pyvista = _pyvista()
        mesh = self.mesh
        grid = pyvista.UnstructuredGrid({pyvista.CellType.TETRA: mesh.tets}, mesh.points)
        for name, values in self._simulation.nodes.items():
            grid.point_data[name] = values
        return grid

    def __repr__(self) -> str:
        state = "finished" if self.finished else f"in stage {self.stage!r}"
        return f"<Simulation {self._title!r}, t = {self.time:.6g} s, {len(self.particles)} particles, {state}>"

    def __getstate__(self) -> Any:
        raise TypeError("a simulation is not pickled; save() and Simulation.load() keep it in a file")


def _time(until: float | str) -> float:
    time = _moldwarp.quantity(until, "time") if isinstance(until, str) else float(until)
    if math.isnan(time) or time < 0.0:
        raise ValueError(f"a time is from 0 s on, not {until!r}")
    return time


def _threads(threads: int | None) -> int | None:
    if threads is not None and (isinstance(threads, bool) or not isinstance(threads, int) or threads < 1):
        raise ValueError(f"a number of threads is a whole number from 1 on, not {threads!r}")
    return threads


def _pyvista() -> Any:
    try:
        import pyvista
    except ImportError:
        raise ImportError("to_pyvista() needs pyvista: pip install pyvista") from None
    return pyvista
