"""Materials written in Python."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

__all__ = ["Increment", "Material", "Update"]

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Increment:
    """What a step does to all n particles of a material.

    The arrays are read-only; their rows are in another order at each step, and ``id`` says which particle
    a row belongs to. A component of all particles, as ``strain[:, 0]``, is contiguous.
    """

    id: npt.NDArray[np.uint32]
    """Numbers of the particles, shape (n,); they never change."""
    stress: Floats
    """Cauchy stress before, turned with the material, Pa, shape (n, 6): xx, yy, zz, xy, yz, zx."""
    strain: Floats
    """Strain increment, shape (n, 6); shears are γ = 2ε."""
    state: Floats
    """State variables, shape (n, number of them), in the order of ``Material.state``."""


@dataclass(frozen=True)
class Update:
    """What a material says to an increment."""

    stress: npt.ArrayLike
    """New stress, Pa, shape (n, 6)."""
    state: npt.ArrayLike | None = None
    """New state variables, shape (n, number of them); None leaves them."""
    plastic_strain: npt.ArrayLike | None = None
    """Plastic part of the strain increment, shape (n, 6); its work is booked as ``plastic``."""


class Material(ABC):
    """A material whose stress is computed in Python, for all its particles at once.

    Subclasses define :meth:`update`. Results are only as reproducible as it is.

    Parameters
    ----------
    young_modulus, poisson_ratio
        Elastic constants (Pa, or a text with a unit). They set the stable step, viscosity and absorbing
        boundaries: the material must never be stiffer.
    density, unit_weight
        One of them: kg/m³ or N/m³, or a text with a unit.
    """

    state: ClassVar[Mapping[str, str]] = {}
    """Names and units of the state variables, four at most; all are zero at the start."""

    young_modulus: float | str
    poisson_ratio: float
    density: float | str | None
    unit_weight: float | str | None

    def __init__(
        self,
        *,
        young_modulus: float | str,
        poisson_ratio: float,
        density: float | str | None = None,
        unit_weight: float | str | None = None,
    ) -> None:
        self.young_modulus = young_modulus
        self.poisson_ratio = poisson_ratio
        self.density = density
        self.unit_weight = unit_weight

    @abstractmethod
    def update(self, step: Increment) -> npt.ArrayLike | Update:
        """New stresses (Pa, shape (n, 6)), or an :class:`Update` with state variables and plastic strains."""

    def elastic(self, strain: Floats) -> Floats:
        """Hooke's stress increment of strain increments, Pa, shape (n, 6): λ tr(ε) I + 2G ε."""
        shear, lame = self._moduli()
        stress = np.empty_like(strain)
        pressure = lame * (strain[:, 0] + strain[:, 1] + strain[:, 2])
        for k in range(3):
            np.multiply(strain[:, k], 2.0 * shear, out=stress[:, k])
            stress[:, k] += pressure
            np.multiply(strain[:, k + 3], shear, out=stress[:, k + 3])
        return stress

    def stiffness(self) -> Floats:
        """The same as a matrix, Pa, shape (6, 6): ``strain @ stiffness()``."""
        shear, lame = self._moduli()
        c = np.zeros((6, 6))
        c[:3, :3] = lame
        c[range(3), range(3)] += 2.0 * shear
        c[range(3, 6), range(3, 6)] = shear
        return c

    def _moduli(self) -> tuple[float, float]:
        """G and λ, Pa."""
        from ._moldwarp import quantity

        e = self.young_modulus
        young = quantity(e, "stress") if isinstance(e, str) else float(e)
        nu = float(self.poisson_ratio)
        return young / (2.0 * (1.0 + nu)), young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))

    def _scene(self) -> dict[str, Any]:
        return {
            "model": "external",
            "young_modulus": self.young_modulus,
            "poisson_ratio": self.poisson_ratio,
            "density": self.density,
            "unit_weight": self.unit_weight,
        }

    def _increment(
        self,
        name: str,
        id: npt.NDArray[np.uint32],
        stress: Floats,
        strain: Floats,
        state: Floats,
    ) -> tuple[Floats, Floats | None, Floats | None]:
        said = self.update(Increment(id, stress, strain, state))
        update = said if isinstance(said, Update) else Update(said)
        what = f"material `{name}`: update() returned"
        shape = stress.shape
        new_state = update.state
        plastic = update.plastic_strain
        return (
            _checked(update.stress, shape, f"{what} stresses"),
            None if new_state is None else _checked(new_state, state.shape, f"{what} state variables"),
            None if plastic is None else _checked(plastic, shape, f"{what} plastic strains"),
        )


def _checked(values: npt.ArrayLike | None, shape: tuple[int, ...], what: str) -> Floats:
    if values is None:
        raise TypeError(f"{what} that are None")
    array = np.asarray(values)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{what} of type {array.dtype}, not float")
    if array.shape != shape:
        raise ValueError(f"{what} of shape {array.shape}, not {shape}")
    return np.asarray(array, dtype=np.float64)
