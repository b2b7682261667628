"""Views of particles' arrays without a copy, for as long as a ``with`` block lasts."""

from __future__ import annotations

from types import TracebackType
from typing import TYPE_CHECKING, Any, Generic, Literal, TypeVar, cast, overload

import numpy as np
import numpy.typing as npt
from numpy.lib.mixins import NDArrayOperatorsMixin

from . import _moldwarp
from ._errors import FrozenError

__all__ = ["Columns", "Frozen", "View"]

T = TypeVar("T", bound=np.generic)
AXES = {3: ("x", "y", "z"), 6: ("xx", "yy", "zz", "xy", "yz", "zx")}

if TYPE_CHECKING:
    # NumPy does not say the types of its own.
    class _Operators:
        def __add__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __radd__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __sub__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __rsub__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __mul__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __rmul__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __truediv__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __rtruediv__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __floordiv__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __rfloordiv__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __mod__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __rmod__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __pow__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __rpow__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __lt__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __le__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __gt__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __ge__(self, other: Any, /) -> npt.NDArray[Any]: ...
        def __neg__(self) -> npt.NDArray[Any]: ...
        def __abs__(self) -> npt.NDArray[Any]: ...

else:
    _Operators = NDArrayOperatorsMixin


class View(_Operators, Generic[T]):
    """A read-only view of one component of all particles, in the order in which the solver has them.

    It can be used as an array: ``view.max()``, ``view[:10]``, ``2 * view``, ``numpy.asarray(view)``.
    Slices are views, too; all else is computed into new arrays. After its block a view raises
    :class:`FrozenError`.

    An array that was taken out with ``numpy.asarray`` stays what it was: the simulation goes on with a copy
    then, and the memory is freed with the last such array.
    """

    __slots__ = ("_array", "_lease")

    def __init__(self, array: npt.NDArray[T], lease: _moldwarp.Lease) -> None:
        self._array: npt.NDArray[T] | None = array
        self._lease = lease

    def _now(self) -> npt.NDArray[T]:
        if self._lease.over or self._array is None:
            self._array = None
            raise FrozenError("a view is used after its frozen block; copy what is to be kept: view.copy()")
        return self._array

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> npt.NDArray[Any]:
        array = self._now()
        if dtype is not None and np.dtype(dtype) != array.dtype:
            if copy is False:
                raise ValueError("another type needs a copy")
            return array.astype(dtype)
        return array.copy() if copy else array

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **kwargs: Any) -> Any:
        plain = [i._now() if isinstance(i, View) else i for i in inputs]
        if "out" in kwargs and any(isinstance(o, View) for o in kwargs["out"]):
            raise ValueError("a view is read-only: assign to the particles after the block")
        return getattr(ufunc, method)(*plain, **kwargs)

    @overload
    def __getitem__(self, key: slice) -> View[T]: ...
    @overload
    def __getitem__(self, key: Any) -> Any: ...
    def __getitem__(self, key: Any) -> Any:
        part = self._now()[key]
        if isinstance(part, np.ndarray) and not part.flags.owndata:
            return View(cast("npt.NDArray[T]", part), self._lease)
        return part

    def __len__(self) -> int:
        return len(self._now())

    @property
    def shape(self) -> tuple[int, ...]:
        return self._now().shape

    @property
    def dtype(self) -> np.dtype[T]:
        return self._now().dtype

    def copy(self) -> npt.NDArray[T]:
        """An array of its own, which stays."""
        copy: npt.NDArray[T] = self._now().copy()
        return copy

    def min(self) -> Any:
        return self._now().min()

    def max(self) -> Any:
        return self._now().max()

    def sum(self) -> Any:
        return self._now().sum()

    def mean(self) -> Any:
        return self._now().mean()

    def __repr__(self) -> str:
        if self._lease.over:
            return "<View whose block is over>"
        return f"<View of {len(self)} {self.dtype}>"


class Columns(tuple[View[np.float64], ...]):
    """The components of a vector or a tensor, a view each: ``velocity.z`` or ``velocity[2]``."""

    __slots__ = ()

    def __getattr__(self, name: str) -> View[np.float64]:
        axes = AXES.get(len(self), ())
        if name in axes:
            return self[axes.index(name)]
        raise AttributeError(f"no component `{name}`; there are {', '.join(axes)}")

    def copy(self) -> npt.NDArray[np.float64]:
        """All components as an array of shape (n, number of components)."""
        return np.stack([view._now() for view in self], axis=1)


class Frozen:
    """The particles while nothing can change them: views in the order of the solver, without a copy.

    Rows of all views belong together; ``id`` says which particle each is.
    """

    def __init__(self, simulation: _moldwarp.Simulation) -> None:
        self._simulation = simulation
        self._lease: _moldwarp.Lease | None = None

    def __enter__(self) -> Frozen:
        if self._lease is not None:
            raise FrozenError("a frozen block is entered once; call frozen() again")
        self._lease = self._simulation.freeze()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> Literal[False]:
        if self._lease is not None:
            self._lease.end()
        return False

    def _views(self, name: str) -> Columns:
        if self._lease is None:
            raise FrozenError("views are there within the block: with sim.frozen() as particles: …")
        lease = self._lease
        return Columns(View(column, lease) for column in lease.columns(name))

    def _one(self, name: str) -> Any:
        return self._views(name)[0]

    @property
    def id(self) -> View[np.uint32]:
        """Number of each particle."""
        return cast("View[np.uint32]", self._one("id"))

    @property
    def body(self) -> View[np.uint16]:
        """Number of each particle's body, among ``Simulation.bodies``."""
        return cast("View[np.uint16]", self._one("body"))

    @property
    def element(self) -> View[np.uint32]:
        """The element each particle is in."""
        return cast("View[np.uint32]", self._one("element"))

    @property
    def position(self) -> Columns:
        """x, y, z, m."""
        return self._views("position")

    @property
    def velocity(self) -> Columns:
        """x, y, z, m/s, in the middle of the coming step."""
        return self._views("velocity")

    @property
    def stress(self) -> Columns:
        """xx, yy, zz, xy, yz, zx, Pa, tension positive."""
        return self._views("stress")

    @property
    def volume(self) -> View[np.float64]:
        """m³."""
        return cast("View[np.float64]", self._one("volume"))

    @property
    def mass(self) -> View[np.float64]:
        """kg."""
        return cast("View[np.float64]", self._one("mass"))
