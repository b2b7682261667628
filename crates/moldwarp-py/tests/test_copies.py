"""Copies of arrays: whoever has one keeps it as it was; the memory of those that nobody has is used again."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import moldwarp
import numpy as np
import pytest


def address(array: np.ndarray[Any, Any]) -> int:
    return int(array.__array_interface__["data"][0])


@pytest.fixture
def sim(column: dict[str, Any]) -> moldwarp.Simulation:
    sim = moldwarp.Simulation(column)
    sim.step(5)
    return sim


def test_memory_that_nobody_has_is_used_again(sim: moldwarp.Simulation) -> None:
    p = sim.particles
    seen = set()
    for _ in range(5):
        velocity, stress, mass = p.velocity, p.stress, p.mass
        seen.add((address(velocity), address(stress), address(mass)))
        assert mass.shape == (96,) and not mass.flags.writeable and not velocity.flags.writeable
        del velocity, stress, mass
        sim.step()
    assert len(seen) == 1


def test_what_somebody_has_stays_as_it_was(sim: moldwarp.Simulation) -> None:
    """Itself, a part of it, or whatever else looks at its memory."""
    keep: dict[str, Callable[[Any], Any]] = {
        "itself": lambda a: a,
        "part": lambda a: a[3:90:2],
        "memoryview": memoryview,
        "in a list": lambda a: [a],
        "of another type": lambda a: a.view(np.uint64),
        "turned": lambda a: a.T,
    }
    for name, held in keep.items():
        for of in ["velocity", "stress", "mass"]:
            array = getattr(sim.particles, of)
            kept = held(array)
            before = np.array(kept)
            del array
            for _ in range(5):
                sim.step()
                other = getattr(sim.particles, of)
                assert np.array_equal(np.array(kept), before), name
                assert not any(np.shares_memory(other, part) for part in (kept if name == "in a list" else [kept]))
                del other
            assert of == "mass" or not np.array_equal(np.ravel(getattr(sim.particles, of))[: before.size],
                                                      np.ravel(before)), name


def test_many_copies_are_all_different(sim: moldwarp.Simulation) -> None:
    copies, again = [], []
    for _ in range(10):
        copies.append(sim.particles.velocity)
        again.append(np.array(copies[-1]))
        sim.step()
    assert len({address(copy) for copy in copies}) == 10
    assert all(np.array_equal(a, b) for a, b in zip(copies, again, strict=True))


def test_what_was_done_to_a_copy_is_not_seen_in_the_next(sim: moldwarp.Simulation) -> None:
    first = sim.particles.velocity
    expected = first.copy()
    first.flags.writeable = True
    first[:] = 7.0
    del first
    second = sim.particles.velocity
    assert np.array_equal(second, expected) and not second.flags.writeable
    second.flags.writeable = True
    second.shape = (3, 96)
    del second
    third: Any = sim.particles.velocity
    assert third.shape == (96, 3) and np.array_equal(third, expected)
    third.flags.writeable = True
    third.dtype = np.dtype(np.int64)
    del third
    fourth = sim.particles.velocity
    assert fourth.dtype == np.float64 and np.array_equal(fourth, expected)
    fourth.flags.writeable = True
    fourth.resize((10, 3), refcheck=False)
    del fourth
    assert np.array_equal(sim.particles.velocity, expected)


def test_numbers_with_gaps(column: dict[str, Any]) -> None:
    """Of bodies that are not there the numbers are reserved: rows are by ascending number all the same."""
    column["bodies"] = {
        "lower": {"region": {"min": [0, 0, 0], "max": ["1 m", "1 m", "0.2 m"]}, "material": "soil"},
        "upper": {"region": {"min": [0, 0, "0.2 m"], "max": ["1 m", "1 m", "1 m"]}, "material": "soil"},
    }
    column["loads"] = []
    column["stages"] = [{"name": "both", "steps": 3}, {"name": "one", "steps": 3, "remove": ["lower"]}]
    sim = moldwarp.Simulation(column)
    assert np.array_equal(sim.particles.id, np.arange(96))
    both = sim.particles.position
    sim.step(4)
    p = sim.particles
    assert len(p) == 48 and np.array_equal(p.id, np.arange(48, 96))
    assert p.position.shape == (48, 3) and np.abs(p.position - both[48:]).max() < 5e-3
    with sim.frozen() as frozen:
        by_id = np.argsort(frozen.id)
        for name in ["position", "velocity", "stress", "mass"]:
            assert np.array_equal(getattr(frozen, name).copy()[by_id], getattr(p, name)), name
