"""Simulations: running, looking, changing, keeping."""

from __future__ import annotations

import csv
import json
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import moldwarp
import numpy as np
import pytest


def test_the_column_is_that_of_the_command(root: Path, command: str, tmp_path: Path) -> None:
    """Its state hash, and its history row for row."""
    out = tmp_path / "out"
    subprocess.run([command, "run", root / "examples/absorbing-column", "--out", out], check=True, capture_output=True)
    summary = json.loads((out / "summary.json").read_text())
    sim = moldwarp.Simulation(root / "examples/absorbing-column").run()
    assert sim.state_hash == summary["state_hash"]
    assert sim.scene_hash == summary["scene_hash"]
    assert sim.energy == summary["energy"]
    with (out / "history.csv").open() as file:
        header, *rows = csv.reader(file)
    assert list(sim.history) == header
    written = np.array(rows, dtype=np.float64)
    assert np.array_equal(np.stack(list(sim.history.values()), axis=1), written)
    assert sim.history.units == summary["units"]


def test_steps_and_times(column: dict[str, Any]) -> None:
    sim = moldwarp.Simulation(column)
    assert (sim.time, sim.steps, sim.stage, sim.finished) == (0.0, 0, "all", False)
    sim.step()
    sim.step(9)
    assert sim.steps == 10 and sim.time_step > 0.0
    wanted = sim.time + 10.5 * sim.next_time_step
    sim.run(until=f"{1000 * wanted} ms")
    # The first step at or after it: output never shortens a step.
    assert sim.time >= wanted > sim.time - sim.time_step
    steps = sim.steps
    assert sim.run(until=sim.time).steps == steps
    with pytest.raises(ValueError, match="already, after 0.0 s"):
        sim.run(until=0)
    sim.run()
    assert sim.finished and sim.steps == 100 and sim.stage is None
    sim.step(5)
    assert sim.steps == 100
    assert "finished" in repr(sim)
    wrong: list[float | str] = ["3 m", "soon", -1.0, float("nan")]
    for until in wrong:
        with pytest.raises(ValueError):
            moldwarp.Simulation(column).run(until=until)
    numbers: list[Any] = [-1, 1.5, True]
    for number in numbers:
        with pytest.raises(ValueError, match="whole number"):
            moldwarp.Simulation(column).step(number)


def test_callbacks_come_every_n_steps_and_at_the_end(column: dict[str, Any]) -> None:
    seen: list[int] = []
    moldwarp.Simulation(column).run(callback=lambda sim: seen.append(sim.steps), every=30)
    assert seen == [30, 60, 90, 100]
    stopped = moldwarp.Simulation(column).run(callback=lambda sim: sim.steps < 40, every=20)
    assert stopped.steps == 40

    def fails(_: moldwarp.Simulation) -> None:
        raise KeyError("mine")

    sim = moldwarp.Simulation(column)
    with pytest.raises(KeyError, match="mine"):
        sim.run(callback=fails, every=7)
    assert sim.run().steps == 100
    with pytest.raises(ValueError, match="every"):
        moldwarp.Simulation(column).run(callback=print, every=0)


def test_a_run_with_interruptions_is_the_same(column: dict[str, Any]) -> None:
    one = moldwarp.Simulation(column).run()
    other = moldwarp.Simulation(column, threads=1)
    while not other.finished:
        other.step(7)
        assert len(other.particles.position) == len(other.particles)
        with other.frozen() as particles:
            assert particles.mass.sum() > 0.0
    assert one.state_hash == other.state_hash


def test_arrays_are_by_id(root: Path) -> None:
    sim = moldwarp.Simulation(root / "examples/slope")
    sim.step(400)
    p = sim.particles
    assert np.array_equal(p.id, np.arange(len(p)))
    with sim.frozen() as frozen:
        by_id = np.argsort(frozen.id)
        # They have crossed elements, so that the solver has them in another order.
        assert not np.array_equal(by_id, np.arange(len(p)))
        for name, width in [("position", 3), ("velocity", 3), ("stress", 6)]:
            values = getattr(p, name)
            assert values.shape == (len(p), width) and values.dtype == np.float64
            assert np.array_equal(getattr(frozen, name).copy()[by_id], values)
        assert np.array_equal(frozen.element.copy()[by_id], p.element)
        assert np.array_equal(frozen.volume.copy()[by_id], p.volume)
    assert np.allclose(p.density, p.mass / p.volume)
    assert np.allclose(p.mean_pressure, -p.stress[:, :3].mean(axis=1))
    assert sim.bodies[p.body[0]] == "slope" or len(sim.bodies) >= 1
    assert set(p.state) >= {"plastic_strain"}
    assert sim.nodes.velocity.shape == sim.mesh.points.shape
    assert np.isclose(sim.nodes.mass.sum(), p.mass.sum(), rtol=1e-12)
    # Particles are in their elements.
    corners = sim.mesh.points[sim.mesh.tets[p.element]]
    assert (p.position >= corners.min(axis=1) - 1e-9).all() and (p.position <= corners.max(axis=1) + 1e-9).all()


def test_velocities_can_be_assigned(column: dict[str, Any]) -> None:
    column["gravity"] = [0, 0, 0]
    column["loads"] = []
    sim = moldwarp.Simulation(column)
    assert not sim.particles.velocity.any()
    sim.particles.velocity = np.tile([0.0, 0.0, 0.1], (len(sim.particles), 1))
    assert np.array_equal(sim.particles.velocity[5], [0.0, 0.0, 0.1])
    assert np.isclose(sim.energy["kinetic"], 0.5 * sim.particles.mass.sum() * 0.01)
    sim.step(20)
    by_plan = {**column, "stages": [{"name": "all", "steps": 100, "initial_velocity": {"layer": [0, 0, "0.1 m/s"]}}]}
    other = moldwarp.Simulation(by_plan)
    other.step(20)
    assert np.array_equal(sim.particles.position, other.particles.position)
    # What is assigned unchanged changes nothing.
    sim.particles.velocity = sim.particles.velocity
    assert np.array_equal(sim.particles.velocity, other.particles.velocity)
    sim.particles.velocity = 0.5 * sim.particles.velocity
    sim.run()
    assert abs(sim.energy["residual"]) < 1e-10 * sim.energy_turned_over


def test_stresses_can_be_assigned(column: dict[str, Any]) -> None:
    column["loads"] = []
    sim = moldwarp.Simulation(column)
    weight = -18000.0 / 9.81 * 10.0
    stress = np.zeros((len(sim.particles), 6))
    stress[:, 2] = weight * (0.4 - sim.particles.position[:, 2])
    stress[:, :2] = 0.25 * stress[:, 2:3]
    sim.particles.stress = stress
    sim.run()
    # It rests: in free fall it would have 0.3 m/s.
    assert sim.time > 0.02 and np.abs(sim.particles.velocity).max() < 1e-3
    assert np.abs(sim.particles.stress - stress).max() < 50.0


def test_what_cannot_be_assigned(column: dict[str, Any], root: Path) -> None:
    sim = moldwarp.Simulation(column)
    n = len(sim.particles)
    for name in ["position", "mass", "displacement", "element", "state"]:
        with pytest.raises(AttributeError, match="cannot be assigned"):
            setattr(sim.particles, name, np.zeros((n, 3)))
    with pytest.raises(AttributeError, match="no array `velocities`"):
        sim.particles.velocities = np.zeros((n, 3))
    with pytest.raises(AttributeError, match="cannot be replaced"):
        setattr(sim, "particles", np.zeros(3))
    with pytest.raises(ValueError, match="read-only"):
        sim.particles.velocity[:, 2] = 0.0
    with pytest.raises(ValueError, match=r"of shape \(96, 3\), not \(95, 3\)"):
        sim.particles.velocity = np.zeros((n - 1, 3))
    with pytest.raises(ValueError, match="in row 7 is not a finite number"):
        sim.particles.velocity = np.where(np.arange(n)[:, None] == 7, np.nan, np.zeros((n, 3)))
    with pytest.raises(TypeError, match="numbers"):
        sim.particles.velocity = np.full((n, 3), "fast")
    slope = moldwarp.Simulation(root / "examples/slope")
    beyond = np.zeros((len(slope.particles), 6))
    beyond[:, 0] = 1e9
    with pytest.raises(ValueError, match="particle 0 is beyond the strength"):
        slope.particles.stress = beyond
    assert sim.steps == 0 and sim.run().finished


def test_the_history_is_a_dict_of_arrays(column: dict[str, Any]) -> None:
    column["output"] = {"history": 20}
    column["stages"] = [{"name": "all", "duration": "1 s"}]
    sim = moldwarp.Simulation(column)
    assert len(sim.history["time"]) == 1
    history = sim.run().history
    # At its end there is a row, too.
    assert 20 <= len(history["time"]) <= 22
    assert history["time"][0] == 0.0 and history["time"][-1] == sim.time
    assert history.units["bottom.displacement.z"] == "m"
    assert dict(history)["energy.kinetic"][-1] == sim.energy["kinetic"]
    with pytest.raises(KeyError, match="did you mean `bottom.displacement.z`"):
        history["bottom.displacment.z"]
    pandas = pytest.importorskip("pandas")
    frame = history.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and frame.index.name == "time"
    assert np.array_equal(frame["step"], history["step"])


def test_saved_and_loaded_it_goes_on_bit_for_bit(column: dict[str, Any], tmp_path: Path) -> None:
    sim = moldwarp.Simulation(column)
    sim.step(40)
    sim.save(tmp_path / "a.mw")
    loaded = moldwarp.Simulation.load(tmp_path / "a.mw")
    assert loaded.steps == 40 and loaded.state_hash == sim.state_hash
    assert loaded.run().state_hash == sim.run().state_hash
    for name, values in sim.history.items():
        assert np.array_equal(loaded.history[name], values)
    with pytest.raises(moldwarp.FileError, match="cannot read"):
        moldwarp.Simulation.load(tmp_path / "b.mw")
    (tmp_path / "b.mw").write_bytes((tmp_path / "a.mw").read_bytes()[:-1])
    with pytest.raises(moldwarp.FileError) as caught:
        moldwarp.Simulation.load(tmp_path / "b.mw")
    assert caught.value.message.endswith("b.mw: it is damaged")
    (tmp_path / "b.mw").write_text("no such thing")
    with pytest.raises(moldwarp.FileError) as caught:
        moldwarp.Simulation.load(tmp_path / "b.mw")
    assert caught.value.message.endswith("b.mw: it is no checkpoint of moldwarp")
    with pytest.raises(moldwarp.FileError, match="cannot write"):
        sim.save(tmp_path / "no" / "such" / "folder.mw")


def test_a_guard_stops_it_and_it_can_be_looked_at(column: dict[str, Any]) -> None:
    column["mesh"]["box"]["size"] = ["0.1 m", "0.1 m", "0.8 m"]
    column["bodies"]["layer"] = {
        "region": {"kind": "box", "min": [0, 0, "0.4 m"], "max": ["0.1 m", "0.1 m", "0.6 m"]},
        "material": "soil",
    }
    column.update(loads=[], probes={}, gravity=[0, 0, 0])
    column["boundaries"] = column["boundaries"][1:]
    column["stages"] = [{"name": "thrown", "duration": "1 s", "initial_velocity": {"layer": [0, 0, "5 m/s"]}}]
    sim = moldwarp.Simulation(column)
    with pytest.raises(moldwarp.StoppedError, match="left the mesh"):
        sim.run()
    assert sim.particles.position[:, 2].max() > 0.79
    assert sim.history["time"][-1] == sim.time
    with pytest.raises(moldwarp.StoppedError, match="cannot go on: particle"):
        sim.step()


def test_a_limit_without_equilibrium(column: dict[str, Any]) -> None:
    column["stages"] = [{"name": "settling", "until": "equilibrium", "duration": "10 ms"}]
    with pytest.raises(moldwarp.NotAtRestError, match="`settling` reached its limit without equilibrium"):
        moldwarp.Simulation(column).run()


def test_ctrl_c_ends_a_run_between_two_steps(column: dict[str, Any]) -> None:
    column["stages"] = [{"name": "long", "duration": "1 h"}]
    sim = moldwarp.Simulation(column)
    main = threading.main_thread().ident
    assert main is not None
    # A shell that starts programs in the background has them ignore it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.3, lambda: signal.pthread_kill(main, signal.SIGINT))
    timer.start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        sim.run()
    assert time.monotonic() - begun < 5.0
    steps = sim.steps
    assert steps > 10
    same = moldwarp.Simulation(column)
    same.step(steps)
    assert same.state_hash == sim.state_hash
    sim.step(3)
    assert sim.steps == steps + 3


def test_other_threads_go_on_while_it_steps(column: dict[str, Any]) -> None:
    """The lock of Python is released: a thread counts while another one computes."""
    column["stages"] = [{"name": "long", "duration": "1 h"}]
    sim = moldwarp.Simulation(column, threads=1)
    computing = threading.Thread(target=lambda: sim._simulation.advance(2**62, 1e9, 1.0))
    computing.start()
    time.sleep(0.1)
    begun, counted = time.monotonic(), 0
    with pytest.raises(moldwarp.BusyError, match="computing"):
        sim.step()
    while time.monotonic() - begun < 0.3:
        counted += 1
        time.sleep(0.001)
    assert computing.is_alive()
    computing.join()
    assert counted > 20


def test_simulations_side_by_side(column: dict[str, Any]) -> None:
    from concurrent.futures import ThreadPoolExecutor

    def computed(nu: float) -> str:
        scene = moldwarp.Scene(column, set={"materials.soil.poisson_ratio": nu})
        return moldwarp.Simulation(scene, threads=1).run().state_hash

    values = [0.0, 0.1, 0.2, 0.3]
    with ThreadPoolExecutor() as pool:
        together = list(pool.map(computed, values))
    assert together == [computed(nu) for nu in values]
    with pytest.raises(ValueError, match="number of threads"):
        moldwarp.Simulation(column, threads=0)


FORKED = """
import os, sys, moldwarp
sim = moldwarp.Simulation(sys.argv[1])
sim.step()
child = os.fork()
if child == 0:
    for use in [sim.step, lambda: sim.particles.mass, lambda: moldwarp.Simulation(sys.argv[1], threads=1)]:
        try:
            use()
            os._exit(1)
        except RuntimeError as error:
            if "forked" not in str(error):
                os._exit(2)
    os._exit(0)
sim.step()
sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""


def test_a_forked_process_is_told_so(root: Path) -> None:
    """It would wait for ever for threads that are not there."""
    arguments = [sys.executable, "-c", FORKED, str(root / "examples/absorbing-column")]
    assert subprocess.run(arguments, timeout=60, check=False).returncode == 0


def test_progress_in_a_plain_line(column: dict[str, Any], capsys: pytest.CaptureFixture[str],
                                  monkeypatch: pytest.MonkeyPatch) -> None:
    import moldwarp._progress as progress

    monkeypatch.setattr(progress, "FIRST", 0.0)
    monkeypatch.setattr(progress, "EVERY", 0.0)
    monkeypatch.setattr(progress, "_tqdm", lambda title, total: False)
    column["stages"] = [{"name": "long", "duration": "2 s"}]
    moldwarp.Simulation(column).run(progress=True)
    said = capsys.readouterr().err
    assert said.startswith("\rcolumn: ") and said.endswith("\n") and "100 %" in said
    moldwarp.Simulation(column).run(progress=False)
    assert capsys.readouterr().err == ""


def test_to_pyvista(column: dict[str, Any]) -> None:
    pytest.importorskip("pyvista")
    sim = moldwarp.Simulation(column).run()
    cloud = sim.to_pyvista()
    assert cloud.n_points == len(sim.particles)
    assert np.allclose(cloud["displacement"], sim.particles.displacement)
    grid = sim.mesh_to_pyvista()
    assert grid.n_cells == len(sim.mesh.tets) and np.isclose(grid.volume, 0.004)
