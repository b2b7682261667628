"""The history of a simulation."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["History"]


class History(Mapping[str, npt.NDArray[np.float64]]):
    """Columns by name, each an array with an entry a row; SI units.

    The columns and rows are those of the command's ``history.csv``: ``time``, ``stage``, ``stage_time``, ``step``,
    ``dt``, ``<probe>.<quantity>.<component>``, ``contact.<name>.…``, ``energy.<kind>``.
    """

    def __init__(self, columns: list[tuple[str, str, npt.NDArray[np.float64]]]) -> None:
        self._values = {name: values for name, _, values in columns}
        self.units: dict[str, str] = {name: unit for name, unit, _ in columns}
        """The unit of each column."""

    def __getitem__(self, name: str) -> npt.NDArray[np.float64]:
        try:
            return self._values[name]
        except KeyError:
            near = get_close_matches(str(name), self._values, n=1)
            hint = f"; did you mean `{near[0]}`?" if near else f"; there are {', '.join(self._values)}"
            raise KeyError(f"the history has no column `{name}`{hint}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def to_pandas(self) -> Any:
        """A ``pandas.DataFrame`` whose index is the time, s."""
        try:
            import pandas
        except ImportError:
            raise ImportError("to_pandas() needs pandas: pip install pandas") from None
        columns = {name: values for name, values in self._values.items() if name != "time"}
        return pandas.DataFrame(columns, index=pandas.Index(self._values["time"], name="time"))

    def __repr__(self) -> str:
        return f"<History of {len(self['time'])} rows: {', '.join(self)}>"
