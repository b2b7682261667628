"""Views without a copy: what they are, and that nothing can be done wrong with them."""

from __future__ import annotations

import gc
from collections.abc import Callable
from typing import Any

import moldwarp
import numpy as np
import pytest


def address(array: Any) -> int:
    return int(np.asarray(array).__array_interface__["data"][0])


def test_views_are_the_solvers_own_memory(column: dict[str, Any]) -> None:
    sim = moldwarp.Simulation(column)
    with sim.frozen() as particles:
        first, second = address(particles.position.z), address(particles.position.z)
        assert first == second
        assert address(particles.velocity.z) != first
        assert not np.asarray(particles.position.z).flags.owndata
        # Three components are three arrays.
        assert len({address(c) for c in particles.position}) == 3
    with sim.frozen() as particles:
        assert address(particles.position.z) == first
        assert particles.stress.xy is not None and particles.stress[3].shape == (96,)
        with pytest.raises(AttributeError, match="no component `w`; there are x, y, z"):
            particles.position.w
    assert address(sim.particles.position) != address(sim.particles.position.copy())


def test_views_are_read_only(column: dict[str, Any]) -> None:
    sim = moldwarp.Simulation(column)
    with sim.frozen() as particles:
        array = np.asarray(particles.velocity.x)
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0
        with pytest.raises(ValueError, match="cannot set WRITEABLE"):
            array.flags.writeable = True
        with pytest.raises(TypeError):
            particles.velocity.x[0] = 1.0  # type: ignore[index]
        with pytest.raises(ValueError, match="read-only"):
            np.add(particles.mass, 1.0, out=particles.mass)  # type: ignore[call-overload]
        x: Any = particles.velocity.x
        with pytest.raises(ValueError, match="read-only"):
            x += 1.0


def test_views_compute(column: dict[str, Any]) -> None:
    sim = moldwarp.Simulation(column)
    sim.step(20)
    with sim.frozen() as particles:
        v = particles.velocity
        speed = np.sqrt(v.x**2 + v.y**2 + v.z**2)
        assert isinstance(speed, np.ndarray) and speed.flags.owndata
        assert np.isclose(0.5 * (particles.mass * speed**2).sum(),
                          0.5 * (sim.particles.mass * (sim.particles.velocity**2).sum(axis=1)).sum())
        part = particles.mass[10:20]
        assert isinstance(part, moldwarp.View) and len(part) == 10
        assert (part.min(), part.max(), part.mean(), part.sum()) == pytest.approx(
            (sim.particles.mass.min(), sim.particles.mass.max(), sim.particles.mass.mean(),
             10 * sim.particles.mass[0]))
        assert np.asarray(part, dtype=np.float32).dtype == np.float32
        assert particles.mass[particles.mass > 0.0].flags.owndata


@pytest.mark.parametrize("keep", ["stepping", "running", "assigning"])
def test_nothing_changes_a_frozen_simulation(column: dict[str, Any], keep: str) -> None:
    sim = moldwarp.Simulation(column)
    change: Callable[[], object] = {
        "stepping": lambda: sim.step(),
        "running": lambda: sim.run(until="1 s"),
        "assigning": lambda: setattr(sim.particles, "velocity", np.zeros((96, 3))),
    }[keep]
    with sim.frozen() as outer:
        with sim.frozen() as inner:
            with pytest.raises(moldwarp.FrozenError, match="frozen"):
                change()
            assert inner.mass.sum() == outer.mass.sum()
        with pytest.raises(moldwarp.FrozenError, match="frozen"):
            change()
        assert len(sim.particles.position) == 96
    change()
    with pytest.raises(moldwarp.FrozenError, match="with sim.frozen"):
        sim.frozen().mass
    block = sim.frozen()
    with block:
        pass
    with pytest.raises(moldwarp.FrozenError, match="once"), block:
        pass


def test_a_view_after_its_block_raises(column: dict[str, Any]) -> None:
    sim = moldwarp.Simulation(column)
    with sim.frozen() as particles:
        view, part, velocity = particles.mass, particles.mass[2:5], particles.velocity
    uses: list[Any] = [
        lambda: view[0],
        lambda: view + 1.0,
        lambda: np.asarray(view),
        lambda: np.sqrt(part),
        lambda: part.copy(),
        lambda: len(view),
        lambda: view.shape,
        lambda: view.sum(),
        lambda: velocity.z.max(),
        lambda: velocity.copy(),
        lambda: particles.mass,
    ]
    for use in uses:
        with pytest.raises(moldwarp.FrozenError, match="after its frozen block|block is over"):
            use()
    assert repr(view) == "<View whose block is over>"


def test_an_array_that_was_taken_out_stays_as_it_was(column: dict[str, Any]) -> None:
    """However its simulation goes on, and also without it."""
    sim, untouched = moldwarp.Simulation(column), moldwarp.Simulation(column)
    sim.step(10)
    with sim.frozen() as particles:
        taken, part = np.asarray(particles.velocity.z), np.asarray(particles.velocity.z)[3:7]
    then, where = taken.copy(), address(taken)
    sim.step(10)
    with sim.frozen() as particles:
        now = np.asarray(particles.velocity.z)
        # The simulation has moved out: what was taken is nobody else's.
        assert address(now) != where
        assert not np.array_equal(now, then)
    assert np.array_equal(taken, then) and np.array_equal(part, then[3:7])
    untouched.step(20)
    assert sim.state_hash == untouched.state_hash
    del taken
    sim.run()
    assert np.array_equal(part, then[3:7])
    later = now.copy()
    del sim, particles
    gc.collect()
    ballast = [np.random.default_rng(n).random(96) for n in range(1000)]
    assert np.array_equal(part, then[3:7]) and np.array_equal(now, later)
    assert len(ballast) == 1000


def test_without_views_nothing_is_copied(column: dict[str, Any]) -> None:
    sim = moldwarp.Simulation(column)
    with sim.frozen() as particles:
        where = address(particles.mass)
        total = particles.mass.sum()
    sim.step(5)
    with sim.frozen() as particles:
        assert address(particles.mass) == where and particles.mass.sum() == total


def test_an_error_in_the_block_ends_it(column: dict[str, Any]) -> None:
    sim = moldwarp.Simulation(column)
    with pytest.raises(ZeroDivisionError), sim.frozen() as particles:
        particles.mass.sum() / 0 if False else 1 / 0
    assert sim.run().finished


def test_a_block_that_is_never_left_ends_with_its_last_view(column: dict[str, Any]) -> None:
    sim = moldwarp.Simulation(column)
    block = sim.frozen()
    view = block.__enter__().mass
    with pytest.raises(moldwarp.FrozenError):
        sim.step()
    del block, view
    gc.collect()
    sim.step()
