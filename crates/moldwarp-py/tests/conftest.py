"""What tests share: a small column of soil, and where the repository is."""

from __future__ import annotations

import copy
import os
import shutil
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[3]

COLUMN: dict[str, Any] = {
    "title": "column",
    "gravity": [0, 0, "-10 m/s2"],
    "mesh": {"box": {"size": ["0.1 m", "0.1 m", "0.4 m"], "cells": [1, 1, 4]}},
    "materials": {
        "soil": {
            "model": "linear-elastic",
            "young_modulus": "100 kPa",
            "poisson_ratio": 0.2,
            "unit_weight": "18 kN/m3",
        }
    },
    "bodies": {"layer": {"volume": "box", "material": "soil"}},
    "boundaries": [
        {"surface": "z-min", "kind": "absorbing", "virtual_thickness": "1 m"},
        {"surface": ["x-min", "x-max", "y-min", "y-max"], "kind": "roller"},
    ],
    "loads": [{"surface": "z-max", "body": "layer", "pressure": "1 kPa"}],
    "probes": {"bottom": {"surface": "z-min", "quantities": ["displacement"]}},
    "stages": [{"name": "all", "steps": 100}],
}


@pytest.fixture
def column() -> dict[str, Any]:
    """A loaded column of 96 particles that stands on an absorbing boundary, 100 steps."""
    return copy.deepcopy(COLUMN)


@pytest.fixture
def root() -> Path:
    """The repository."""
    return ROOT


@pytest.fixture
def command() -> str:
    """The command `moldwarp`, built from the same sources."""
    found = os.environ.get("MOLDWARP_COMMAND") or shutil.which("moldwarp")
    if not found:
        pytest.skip("the command is not there: MOLDWARP_COMMAND names it")
    return found
