"""Particles' arrays by id."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import numpy.typing as npt

from . import _moldwarp

__all__ = ["Nodes", "Particles"]

Floats = npt.NDArray[np.float64]


class Particles:
    """All particles that are there, in the order of their numbers (``id``).

    Each access copies the array as it is now. Copies are read-only, so that nothing that is written to one is
    lost without a word; velocity and stress are changed by assignment::

        v = sim.particles.velocity.copy()
        v[:, 2] -= 0.1
        sim.particles.velocity = v
    """

    _simulation: _moldwarp.Simulation

    def __init__(self, simulation: _moldwarp.Simulation) -> None:
        object.__setattr__(self, "_simulation", simulation)

    def __len__(self) -> int:
        return self._simulation.count

    @property
    def id(self) -> npt.NDArray[np.uint32]:
        """Numbers of the particles, ascending, shape (n,). A particle keeps its own for ever."""
        return cast("npt.NDArray[np.uint32]", self._simulation.numbers("id"))

    @property
    def body(self) -> npt.NDArray[np.uint16]:
        """Number of each particle's body in ``Simulation.bodies``, shape (n,)."""
        return cast("npt.NDArray[np.uint16]", self._simulation.numbers("body"))

    @property
    def element(self) -> npt.NDArray[np.uint32]:
        """The element of the mesh that each particle is in, shape (n,)."""
        return cast("npt.NDArray[np.uint32]", self._simulation.numbers("element"))

    @property
    def position(self) -> Floats:
        """m, shape (n, 3)."""
        return self._simulation.array("position")

    @property
    def displacement(self) -> Floats:
        """Since the start, or since a stage has reset it, m, shape (n, 3)."""
        displacement = self.position - self._simulation.array("origin")
        displacement.flags.writeable = False
        return displacement

    @property
    def velocity(self) -> Floats:
        """m/s, shape (n, 3). Before the first step those at t = 0, then those of the middle of the coming step.

        Can be assigned. The energy that it gives or takes is booked as given.
        """
        return self._simulation.array("velocity")

    @velocity.setter
    def velocity(self, values: npt.ArrayLike) -> None:
        self._simulation.assign("velocity", self._rows(values, 3, "velocity"))

    @property
    def stress(self) -> Floats:
        """Cauchy stress, Pa, tension positive, shape (n, 6): xx, yy, zz, xy, yz, zx.

        Can be assigned, if the material can have it. Before the first step it is the initial stress, with which
        absorbing boundaries are in equilibrium; later it acts from the end of the coming step on, and the energy
        that the change stores is not in the ledger, which books works.
        """
        return self._simulation.array("stress")

    @stress.setter
    def stress(self, values: npt.ArrayLike) -> None:
        self._simulation.assign("stress", self._rows(values, 6, "stress"))

    @property
    def volume(self) -> Floats:
        """m³, shape (n,)."""
        return self._simulation.array("volume")

    @property
    def initial_volume(self) -> Floats:
        """m³, shape (n,)."""
        return self._simulation.array("initial_volume")

    @property
    def mass(self) -> Floats:
        """kg, shape (n,)."""
        return self._simulation.array("mass")

    @property
    def density(self) -> Floats:
        """kg/m³, shape (n,)."""
        density = self.mass / self.volume
        density.flags.writeable = False
        return density

    @property
    def mean_pressure(self) -> Floats:
        """−(σxx + σyy + σzz) / 3, Pa, compression positive, shape (n,)."""
        return cast(Floats, -self.stress[:, :3].sum(axis=1) / 3.0)

    @property
    def state(self) -> dict[str, Floats]:
        """State variables of the materials by name, shape (n,) each; 0 for particles that have none of a name."""
        fields = self._simulation.state_fields
        if not fields:
            return {}
        values = self._simulation.array("state")
        body = self.body
        state: dict[str, Floats] = {}
        for name, _, column, bodies in fields:
            own = np.where(np.isin(body, bodies), values[:, column], 0.0)
            state[name] = state[name] + own if name in state else own
        return state

    def _rows(self, values: npt.ArrayLike, width: int, what: str) -> Floats:
        array = np.asarray(values)
        if array.dtype.kind not in "fiu":
            raise TypeError(f"the particles' {what} are numbers, not {array.dtype}")
        if array.shape != (len(self), width):
            raise ValueError(f"the particles' {what} is of shape ({len(self)}, {width}), not {array.shape}")
        return np.ascontiguousarray(array, dtype=np.float64)

    def __setattr__(self, name: str, value: Any) -> None:
        if name in ("velocity", "stress"):
            super().__setattr__(name, value)
        elif isinstance(getattr(type(self), name, None), property):
            raise AttributeError(
                f"the particles' {name} cannot be assigned: it follows from their motion; velocity and stress can be"
            )
        else:
            raise AttributeError(f"particles have no array `{name}`")

    def __repr__(self) -> str:
        return f"<Particles, {len(self)} of them>"


class Nodes:
    """Fields over all nodes of the mesh, as they are now; zero where there is no material."""

    def __init__(self, simulation: _moldwarp.Simulation) -> None:
        self._simulation = simulation

    @property
    def velocity(self) -> Floats:
        """m/s, shape (n, 3)."""
        return self._simulation.nodes["velocity"]

    @property
    def mass(self) -> Floats:
        """kg, shape (n,)."""
        return self._simulation.nodes["mass"]

    @property
    def reaction(self) -> Floats:
        """Force of boundaries on the material, N, shape (n, 3)."""
        return self._simulation.nodes["reaction"]
