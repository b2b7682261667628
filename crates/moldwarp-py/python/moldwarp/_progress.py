"""How far a run is: by tqdm if it is there, else in a plain line."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import Any

__all__ = ["Bar"]

FIRST = 1.0
"""Seconds that a run has to take before anything is shown."""
EVERY = 0.2
"""Seconds between two times."""


class Bar:
    """Shows simulated time, from ``begin`` to ``end`` (s)."""

    def __init__(self, wanted: bool | None, title: str, begin: float, end: float) -> None:
        self._shown = _is_watched() if wanted is None else wanted
        self._title = title
        self._begin, self._now, self._end = begin, begin, end
        self._start = self._last = time.monotonic()
        self._bar: Any = None

    def __enter__(self) -> Bar:
        return self

    def at(self, now: float, end: float) -> None:
        self._now, self._end = now, end
        clock = time.monotonic()
        if not self._shown or clock - self._start < FIRST or clock - self._last < EVERY:
            return
        self._last = clock
        self._show()

    def _show(self) -> None:
        if self._bar is None:
            self._bar = _tqdm(self._title, self._end - self._begin)
        if self._bar:
            self._bar.total = self._end - self._begin
            self._bar.n = self._now - self._begin
            self._bar.refresh()
        else:
            share = (self._now - self._begin) / max(self._end - self._begin, 1e-300)
            sys.stderr.write(f"\r{self._title}: {100.0 * share:3.0f} %, t = {self._now:.4g} s ")
            sys.stderr.flush()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._show()
            if self._bar:
                self._bar.close()
            else:
                sys.stderr.write("\n")


def _is_watched() -> bool:
    return "ipykernel" in sys.modules or sys.stderr.isatty()


def _tqdm(title: str, total: float) -> Any:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return False
    shape = "{l_bar}{bar}| {n:.3g}/{total:.3g} s [{elapsed}<{remaining}]"
    return tqdm(total=total, desc=title, bar_format=shape)
