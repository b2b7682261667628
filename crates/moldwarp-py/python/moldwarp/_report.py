"""Reports: one page of a simulation or of a run."""

from __future__ import annotations

import html
import os
from pathlib import Path
from urllib.parse import quote

import numpy as np

from . import _moldwarp

__all__ = ["Report", "report"]


class Report(os.PathLike[str]):
    """A page that was written. In notebooks it shows as a link; it can be used wherever a path can."""

    path: Path
    """Where it is."""
    bytes: int
    """How large it is."""
    left_out: list[str]
    """What it does not show, a sentence each."""

    def __init__(self, path: Path, size: int, left_out: list[str]) -> None:
        self.path = path
        self.bytes = size
        self.left_out = left_out

    def __fspath__(self) -> str:
        return str(self.path)

    def __repr__(self) -> str:
        return f"<Report {str(self.path)!r}, {self.bytes / 1e6:.1f} MB>"

    def _repr_html_(self) -> str:
        # Notebooks open paths that are relative to their own folder, which is the current one.
        address = self.path.as_uri() if self.path.is_absolute() else quote(self.path.as_posix())
        link = f'<a href="{html.escape(address)}" target="_blank">{html.escape(str(self.path))}</a>'
        size = f"{self.bytes / 1e6:.1f} MB, opens in a browser"
        return "<br>".join([f"{link} ({size})", *map(html.escape, self.left_out)])


def report(
    folder: str | os.PathLike[str],
    path: str | os.PathLike[str] | None = None,
    *,
    particles: int | None = None,
    frames: int | None = None,
) -> Report:
    """Writes the report of a run of the command, as ``moldwarp report`` does.

    Parameters
    ----------
    folder
        The folder that ``moldwarp run`` has written.
    path
        Where the page goes; report.html in that folder if not said. A file that is no report is not replaced.
    particles, frames
        How many are drawn at most.

    Raises
    ------
    FileError
        If the folder is not that of a run, is damaged, or the page cannot be written.
    """
    return Report(*_moldwarp.report_in(folder, path, wishes(particles, frames)))


def wishes(particles: int | None, frames: int | None) -> tuple[int | None, int | None]:
    return _at_most("particles", particles), _at_most("frames", frames)


def _at_most(what: str, number: int | None) -> int | None:
    if number is None:
        return None
    if isinstance(number, bool) or not isinstance(number, int | np.integer) or number < 1:
        raise ValueError(f"`{what}` is a whole number from 1 on, not {number!r}")
    return int(number)
