"""A scene given as a dict, written as the TOML that a user would write.

The text goes through the same reader as a file, so that checks, messages and results are the same.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

__all__ = ["dumps"]


def dumps(scene: Mapping[str, Any]) -> str:
    """The TOML of a dict; None is left out."""
    lines: list[str] = []
    _table(lines, (), plain(scene))
    return "\n".join(lines).lstrip("\n") + "\n"


def _table(lines: list[str], path: tuple[str, ...], table: Mapping[str, Any]) -> None:
    # Of the first two levels tables have headers of their own; below, they stand in a line.
    headed = {key: value for key, value in table.items() if len(path) < 2 and _is_headed(path, value)}
    for key, value in table.items():
        if key not in headed:
            lines.append(f"{_key(key)} = {_value(value, (*path, key))}")
    for key, value in headed.items():
        name = ".".join(map(_key, (*path, key)))
        if isinstance(value, list):
            for item in value:
                lines += ["", f"[[{name}]]"]
                _table(lines, (*path, key, "…"), item)
        else:
            # A table of nothing but tables with headers needs none; an empty one does.
            inner = (*path, key)
            if not value or not all(len(inner) < 2 and _is_headed(inner, v) for v in value.values()):
                lines += ["", f"[{name}]"]
            _table(lines, (*path, key), value)


def _is_headed(path: tuple[str, ...], value: Any) -> bool:
    if isinstance(value, dict):
        return len(path) < 1 or path[0] in ("materials", "bodies", "probes")
    return not path and isinstance(value, list) and bool(value) and all(isinstance(v, dict) for v in value)


def plain(value: Any) -> Any:
    """A value in terms of TOML's types."""
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "_scene") and not isinstance(value, type):
        value = value._scene()
    if isinstance(value, Mapping):
        return {_name(key): item for key, item in value.items() if item is not None}
    if isinstance(value, Sequence) and not isinstance(value, str | bytes):
        return [plain(item) for item in value]
    return value


def _name(key: Any) -> str:
    if not isinstance(key, str):
        raise TypeError(f"keys of a scene are texts, not {key!r}")
    return key


def _key(key: str) -> str:
    bare = key.isascii() and key.replace("-", "a").replace("_", "a").isalnum()
    return key if bare else _text(key)


def _text(text: str) -> str:
    escaped = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}
    shown = (escaped.get(c, c if c >= " " and c != "\x7f" else f"\\u{ord(c):04x}") for c in text)
    return '"' + "".join(shown) + '"'


def _value(value: Any, path: tuple[str, ...]) -> str:
    value = plain(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if math.isnan(value):
            return "nan"
        return ("inf" if value > 0 else "-inf") if math.isinf(value) else repr(value)
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, list):
        return "[" + ", ".join(_value(item, path) for item in value) + "]"
    if isinstance(value, dict):
        inside = (f"{_key(key)} = {_value(item, (*path, key))}" for key, item in value.items())
        return "{ " + ", ".join(inside) + " }" if value else "{}"
    raise TypeError(f"{'.'.join(path)} is of type {type(value).__name__}, which a scene cannot hold: {value!r}")
