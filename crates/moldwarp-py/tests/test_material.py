"""Materials written in Python."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import moldwarp
import numpy as np
import numpy.typing as npt
import pytest


class Elastic(moldwarp.Material):
    """Hooke's law."""

    def update(self, step: moldwarp.Increment) -> npt.ArrayLike:
        return step.stress + self.elastic(step.strain)


def elastic(kind: Callable[..., moldwarp.Material] = Elastic) -> moldwarp.Material:
    return kind(young_modulus="100 kPa", poisson_ratio=0.2, unit_weight="18 kN/m3")


def with_soil(column: dict[str, Any], soil: Any) -> dict[str, Any]:
    return {**column, "materials": {"soil": soil}}


def test_hookes_law_is_that_of_the_solver(column: dict[str, Any]) -> None:
    own = moldwarp.Simulation(column).run()
    mine = moldwarp.Simulation(with_soil(column, elastic())).run()
    assert (mine.steps, mine.time) == (own.steps, own.time)
    for name in ["position", "velocity", "stress", "volume"]:
        a, b = getattr(own.particles, name), getattr(mine.particles, name)
        assert np.abs(a - b).max() <= 1e-12 * np.abs(a).max(), name
    for kind, value in own.energy.items():
        assert abs(value - mine.energy[kind]) <= 1e-12 * own.energy_turned_over, kind


def test_on_an_example_beside_another_material(root: Path) -> None:
    """Half of the column's layer is of the solver's model, half of Python's."""
    import tomllib

    content = tomllib.loads((root / "examples/absorbing-column/scene.toml").read_text(encoding="utf-8"))
    content.pop("compare")
    soil = content["materials"]["soil"]
    halves = {"lower": ("0 m", "0.5 m"), "upper": ("0.5 m", "1 m")}
    content["bodies"] = {
        name: {
            "region": {"kind": "box", "min": ["-1 m", "-1 m", low], "max": ["1 m", "1 m", high]},
            "material": "soil" if name == "lower" else "other",
        }
        for name, (low, high) in halves.items()
    }
    content["loads"][0]["body"] = "upper"
    results = []
    for other in [soil, Elastic(young_modulus="100 kPa", poisson_ratio=0.0, unit_weight="18 kN/m3")]:
        scene = {**content, "materials": {"soil": soil, "other": other}}
        results.append(moldwarp.Simulation(moldwarp.Scene(scene, folder=root / "examples/absorbing-column")))
    own, mine = (sim.run(until="0.3 s") for sim in results)
    assert np.abs(own.particles.stress - mine.particles.stress).max() <= 1e-12 * np.abs(own.particles.stress).max()


class Yielding(moldwarp.Material):
    """Von Mises without hardening: radial return."""

    state = {"plastic_strain": "1", "steps": "1"}
    strength = 500.0

    def update(self, step: moldwarp.Increment) -> moldwarp.Update:
        c = self.stiffness()
        trial = step.stress + step.strain @ c
        mean = trial[:, :3].mean(axis=1, keepdims=True)
        deviator = trial - np.pad(np.repeat(mean, 3, axis=1), ((0, 0), (0, 3)))
        size = np.sqrt(1.5 * ((deviator[:, :3] ** 2).sum(1) + 2.0 * (deviator[:, 3:] ** 2).sum(1)))
        keep = np.minimum(1.0, self.strength / np.maximum(size, 1e-300))[:, None]
        stress = trial - (1.0 - keep) * deviator
        plastic = np.linalg.solve(c, (trial - stress).T).T
        equivalent = (size - self.strength).clip(min=0.0) / (3.0 * c[3, 3])
        state = step.state + np.stack([equivalent, np.ones(len(stress))], axis=1)
        return moldwarp.Update(stress, state, plastic)


def test_state_variables_and_plastic_work(column: dict[str, Any]) -> None:
    column["loads"][0]["pressure"] = "3 kPa"
    column["stages"] = [{"name": "all", "steps": 300}]
    sim = moldwarp.Simulation(with_soil(column, elastic(Yielding))).run()
    state = sim.particles.state
    assert list(state) == ["plastic_strain", "steps"]
    assert np.array_equal(state["steps"], np.full(96, 300.0))
    assert state["plastic_strain"].max() > 1e-3
    stress = sim.particles.stress
    s = stress[:, :3] - stress[:, :3].mean(axis=1, keepdims=True)
    von_mises = np.sqrt(1.5 * ((s**2).sum(1) + 2.0 * (stress[:, 3:] ** 2).sum(1)))
    assert von_mises.max() <= Yielding.strength * (1.0 + 1e-9)
    energy = sim.energy
    assert energy["plastic"] > 0.01 * sim.energy_turned_over
    assert abs(energy["residual"]) < 1e-10 * sim.energy_turned_over


def test_what_it_is_given(column: dict[str, Any]) -> None:
    seen: list[moldwarp.Increment] = []

    class Looking(Elastic):
        def update(self, step: moldwarp.Increment) -> npt.ArrayLike:
            seen.append(step)
            with pytest.raises(ValueError, match="read-only"):
                step.strain[0, 0] = 1.0
            return super().update(step)

    moldwarp.Simulation(with_soil(column, elastic(Looking))).step(3)
    assert len(seen) == 3
    step = seen[0]
    assert sorted(step.id) == list(range(96))
    assert step.stress.shape == step.strain.shape == (96, 6) and step.state.shape == (96, 0)
    assert step.strain[:, 0].flags.c_contiguous


@pytest.mark.parametrize(
    ("says", "kind", "said"),
    [
        (lambda step: step.stress[:-1], ValueError, r"returned stresses of shape \(95, 6\), not \(96, 6\)"),
        (lambda step: None, TypeError, "returned stresses that are None"),
        (lambda step: step.stress.astype(complex), TypeError, "of type complex128, not float"),
        (lambda step: moldwarp.Update(step.stress, state=np.zeros((96, 2))), ValueError,
         r"state variables of shape \(96, 2\), not \(96, 0\)"),
        (lambda step: moldwarp.Update(step.stress, plastic_strain=[1.0]), ValueError, "plastic strains of shape"),
        (lambda step: 1 / 0, ZeroDivisionError, "division by zero"),
    ],
)
def test_errors_of_a_material(column: dict[str, Any], says: Any, kind: type[Exception], said: str) -> None:
    class Wrong(Elastic):
        def update(self, step: moldwarp.Increment) -> npt.ArrayLike:
            answer: npt.ArrayLike = says(step)
            return answer

    sim = moldwarp.Simulation(with_soil(column, elastic(Wrong)))
    with pytest.raises(moldwarp.StoppedError, match="material `soil` has a law that raised") as caught:
        sim.step()
    cause = caught.value.__cause__
    assert isinstance(cause, kind)
    with pytest.raises(kind, match=said):
        raise cause
    assert cause.__traceback__ is not None
    with pytest.raises(moldwarp.StoppedError, match="cannot go on"):
        sim.step()


def test_what_is_not_a_number_is_refused(column: dict[str, Any]) -> None:
    class Nonsense(Elastic):
        def update(self, step: moldwarp.Increment) -> npt.ArrayLike:
            return np.where(step.id[:, None] == 17, np.nan, step.stress)

    sim = moldwarp.Simulation(with_soil(column, elastic(Nonsense)))
    with pytest.raises(moldwarp.StoppedError, match="not a finite number, first of particle 17"):
        sim.run()


def test_wrong_materials(column: dict[str, Any], tmp_path: Path) -> None:
    class Many(Elastic):
        state = dict.fromkeys("abcde", "1")

    with pytest.raises(ValueError, match="has 5 state variables; 4 are the most"):
        moldwarp.Scene(with_soil(column, elastic(Many)))
    with pytest.raises(moldwarp.SceneError, match="0.5 is incompressible"):
        moldwarp.Scene(with_soil(column, Elastic(young_modulus=1e5, poisson_ratio=0.5, density=1.0)))
    with pytest.raises(moldwarp.SceneError, match="density"):
        moldwarp.Scene(with_soil(column, Elastic(young_modulus=1e5, poisson_ratio=0.3)))
    external = {"model": "external", "young_modulus": 1e5, "poisson_ratio": 0.3, "density": 1.0}
    with pytest.raises(moldwarp.SceneError, match="nobody has given its law"):
        moldwarp.Scene(with_soil(column, external))
    scene = moldwarp.Scene(with_soil(column, elastic()))
    with pytest.raises(moldwarp.FileError, match="whose law is written in Python"):
        scene.write(tmp_path)
    with pytest.raises(TypeError, match="abstract"):
        moldwarp.Material(young_modulus=1.0, poisson_ratio=0.0, density=1.0)  # type: ignore[abstract]


def test_kept_and_loaded(column: dict[str, Any], tmp_path: Path) -> None:
    sim = moldwarp.Simulation(with_soil(column, elastic(Yielding)))
    sim.step(30)
    sim.save(tmp_path / "a.mw")
    with pytest.raises(moldwarp.SceneError, match="nobody has given its law"):
        moldwarp.Simulation.load(tmp_path / "a.mw")
    with pytest.raises(TypeError, match="no moldwarp.Material"):
        moldwarp.Simulation.load(tmp_path / "a.mw", materials={"soil": Yielding})  # type: ignore[dict-item]
    loaded = moldwarp.Simulation.load(tmp_path / "a.mw", materials={"soil": elastic(Yielding)})
    assert loaded.run().state_hash == sim.run().state_hash


def test_ctrl_c_within_a_material(column: dict[str, Any]) -> None:
    """The step is made whole, and can be gone on from."""
    # A shell that starts programs in the background has them ignore it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    calls: list[int] = []

    class Slow(Elastic):
        def update(self, step: moldwarp.Increment) -> npt.ArrayLike:
            calls.append(len(calls))
            if len(calls) == 5:
                main = threading.main_thread().ident
                assert main is not None
                signal.pthread_kill(main, signal.SIGINT)
                for _ in range(100_000):
                    pass
            return super().update(step)

    sim = moldwarp.Simulation(with_soil(column, elastic(Slow)))
    with pytest.raises(KeyboardInterrupt):
        sim.run()
    assert sim.steps == 5 and len(calls) >= 5
    untouched = moldwarp.Simulation(with_soil(column, elastic())).run()
    assert sim.run().state_hash == untouched.state_hash


def test_it_may_not_use_its_simulation(column: dict[str, Any]) -> None:
    class Curious(Elastic):
        sim: moldwarp.Simulation

        def update(self, step: moldwarp.Increment) -> npt.ArrayLike:
            return self.sim.particles.stress

    soil = Curious(young_modulus=1e5, poisson_ratio=0.2, density=1800.0)
    soil.sim = moldwarp.Simulation(with_soil(column, soil))
    with pytest.raises(moldwarp.StoppedError) as caught:
        soil.sim.step()
    assert isinstance(caught.value.__cause__, moldwarp.BusyError)
