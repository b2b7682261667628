"""What can go wrong."""

from __future__ import annotations

__all__ = [
    "BusyError",
    "FileError",
    "FrozenError",
    "MoldwarpError",
    "NotAtRestError",
    "SceneError",
    "StoppedError",
]


class MoldwarpError(Exception):
    """All errors of moldwarp."""


class _Reported(MoldwarpError):
    """An error with a report: what the command prints."""

    message: str
    """What is wrong, in one sentence."""
    help: str | None
    """What can be done about it."""

    def __init__(self, report: str, message: str | None = None, help: str | None = None) -> None:
        super().__init__(report)
        self.message = report if message is None else message
        self.help = help

    def __str__(self) -> str:
        return str(self.args[0])


class SceneError(_Reported, ValueError):
    """A scene that cannot be computed. Its text is what the command shows: the place and the remedy."""


class FileError(_Reported, OSError):
    """A file that cannot be read or written."""

    def __init__(self, report: str, message: str | None = None, help: str | None = None) -> None:
        super().__init__(report, message, help)


class StoppedError(MoldwarpError, RuntimeError):
    """A guard has stopped the simulation; it cannot go on, but can be looked at."""


class NotAtRestError(StoppedError):
    """A stage reached its limit without equilibrium."""


class FrozenError(MoldwarpError, RuntimeError):
    """Something is done in a frozen block that would change the simulation, or after it with a view."""


class BusyError(MoldwarpError, RuntimeError):
    """The simulation is asked while it computes."""
