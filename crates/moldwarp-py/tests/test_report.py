"""Reports: the page of a simulation is that of the command's run."""

from __future__ import annotations

import base64
import csv
import json
import os
import re
import shutil
import subprocess
import zlib
from pathlib import Path
from typing import Any

import moldwarp
import numpy as np
import pytest


def data(page: str, name: str) -> str:
    """What stands in one of the page's script elements."""
    found = re.search(f'<script type="[a-z/]+" id="{name}">(.*?)</script>', page, re.DOTALL)
    assert found is not None, name
    return found.group(1)


def summary(page: str) -> dict[str, Any]:
    content: dict[str, Any] = json.loads(data(page, "summary"))
    return content


def history(page: str) -> dict[str, list[float]]:
    header, *rows = csv.reader(zlib.decompress(base64.b64decode(data(page, "history"))).decode().splitlines())
    return {name: [float(row[i]) for row in rows] for i, name in enumerate(header)}


def times(page: str) -> list[float]:
    return [frame["time"] for frame in json.loads(data(page, "about"))["pictures"]["frames"]]


def shown(page: str, table: str) -> dict[str, float]:
    """The first exact number in each row of a table."""
    body = page.split(f'<table id="table-{table}">')[1].split("</table>")[0]
    rows = re.findall(r'<tr data-key="([^"]+)".*?<data value="([^"]+)"', body)
    return {key: float(value) for key, value in rows}


def test_the_page_is_that_of_the_command(root: Path, command: str, tmp_path: Path) -> None:
    """History, energies, answers and every frame: but for the wall time all of it is the same."""
    case = root / "examples/absorbing-column"
    sets = {"stages.0.duration": "0.5 s", "output.frames": 5}
    arguments = [f"--set={name}={value}" for name, value in sets.items()]
    subprocess.run([command, "run", case, "--out", tmp_path / "out", "--report", *arguments], check=True,
                   capture_output=True)
    of_command = (tmp_path / "out/report.html").read_text()
    sim = moldwarp.Simulation(moldwarp.Scene(case, set=sets), keep_frames=True).run()
    written = sim.report(tmp_path / "column.html")
    page = (tmp_path / "column.html").read_text()
    assert written.left_out == [] and os.fspath(written) == str(tmp_path / "column.html")
    assert written.bytes == len(page.encode())
    for element in ["history", "about", *(f"blob-{n}" for n in range(page.count('id="blob-')))]:
        assert data(page, element) == data(of_command, element), element
    ours, theirs = summary(page), summary(of_command)
    for key in ["wall_time", "particle_steps_per_second"]:
        assert ours.pop(key) > 0.0 and theirs.pop(key) > 0.0
    assert ours == theirs and ours["compare"] and ours["exit"] == "done"
    for part in ["answers", "energy", "stages"]:
        heading = re.compile(f'id="{part}".*?</section>', re.DOTALL)
        assert heading.findall(page) == heading.findall(of_command), part
    assert len(times(page)) == 6
    # Of a folder it is the same page, too.
    again = moldwarp.report(tmp_path / "out", tmp_path / "again.html")
    assert again.path.read_text() == of_command
    assert moldwarp.report(tmp_path / "out").path == tmp_path / "out/report.html"
    few = moldwarp.report(tmp_path / "out", tmp_path / "few.html", particles=10, frames=2)
    assert "draws 10 of" in few.left_out[0] and len(times(few.path.read_text())) == 2


def test_figures_are_those_of_the_simulation(column: dict[str, Any], tmp_path: Path) -> None:
    sim = moldwarp.Simulation(column).run()
    page = sim.report(tmp_path / "page.html").path.read_text()
    kept = sim.history
    assert history(page) == {name: values.tolist() for name, values in kept.items()}
    assert summary(page)["energy"] == sim.energy and summary(page)["state_hash"] == sim.state_hash
    assert summary(page)["units"] == kept.units
    assert shown(page, "energies") == pytest.approx(sim.energy, rel=0.0, abs=0.0)
    assert shown(page, "history")["bottom.displacement.z"] == kept["bottom.displacement.z"][-1]
    assert shown(page, "summary")["time"] == sim.time
    greatest = np.linalg.norm(sim.particles.displacement, axis=1).max()
    far = page.split('id="answer-far"')[1].split("</article>")[0]
    value = re.search(r'<data value="([^"]+)"', far)
    assert value is not None and float(value.group(1)) == pytest.approx(greatest, rel=1e-15)
    assert "The run was completed" in page and times(page) == [sim.time]
    assert "the last state alone" in sim.report(tmp_path / "page.html").left_out[0]


def test_the_page_asks_nothing_of_a_network(column: dict[str, Any], tmp_path: Path) -> None:
    page = moldwarp.Simulation(column).run().report(tmp_path / "page.html").path.read_text()
    assert "Content-Security-Policy\" content=\"default-src 'none'" in page
    tags = re.findall(r"<(?:script|link|img|iframe|object|source|use|a)\b[^>]*>", page)
    links = [value for tag in tags for value in re.findall(r'(?:src|href)="([^"]*)"', tag)]
    assert len(links) > 5 and all(link.startswith("#") for link in links), links
    assert "@import" not in page and not re.search(r"url\((?!#|data:)", page)


def test_any_time_is_good_for_a_report(column: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    column["output"] = {"frames": 4}
    column["stages"] = [{"name": "all", "duration": "0.5 s"}]
    sim = moldwarp.Simulation(column, keep_frames=True)
    written = sim.report()
    assert written.path == Path("report.html") and written.path.exists()
    page = written.path.read_text()
    assert times(page) == [0.0] and "this is how it stands at t = " in page
    sim.run(until=0.6 * sim.end)
    page = sim.report().path.read_text()
    assert "The simulation is not over" in page and summary(page)["exit"] == "not over"
    assert len(times(page)) == 4 and times(page)[-1] == sim.time
    # Within a frozen block and in callbacks, too; and the simulation is as it was.
    with sim.frozen():
        sim.report()
    sim.run(callback=lambda sim: sim.report(), every=30)
    assert sim.state_hash == moldwarp.Simulation(column).run().state_hash
    assert len(times(sim.report().path.read_text())) == 5
    assert str(sim.report().left_out) == "[]"


def test_what_is_loaded_keeps_frames_from_then_on(column: dict[str, Any], tmp_path: Path) -> None:
    sim = moldwarp.Simulation(column)
    sim.step(50)
    sim.save(tmp_path / "a.mw")
    loaded = moldwarp.Simulation.load(tmp_path / "a.mw", keep_frames=True).run()
    written = loaded.report(tmp_path / "page.html")
    page = written.path.read_text()
    assert times(page)[0] == sim.time and times(page)[-1] == loaded.time and len(times(page)) > 20
    assert written.left_out[0].startswith("The 3D view begins at t = ")
    assert summary(page)["steps"] == 100 and summary(page)["min_dt"] < summary(page)["time"] / 100 * 1.01


def test_what_is_assigned_at_the_start_is_in_the_first_frame(column: dict[str, Any], tmp_path: Path) -> None:
    column["output"] = {"frames": 1}
    sim = moldwarp.Simulation(column, keep_frames=True)
    sim.particles.velocity = np.tile([0.0, 0.0, 0.25], (len(sim.particles), 1))
    page = sim.report(tmp_path / "page.html").path.read_text()
    assert times(page) == [0.0]
    ranges = json.loads(data(page, "about"))["pictures"]["frames"][0]["ranges"]["velocity"]
    assert any(0.2 < part["greatest"] < 0.3 for part in ranges)


def test_a_simulation_that_was_stopped_has_a_report(column: dict[str, Any], tmp_path: Path) -> None:
    column["stages"] = [{"name": "settling", "until": "equilibrium", "duration": "10 ms"}]
    sim = moldwarp.Simulation(column, keep_frames=True)
    with pytest.raises(moldwarp.NotAtRestError):
        sim.run()
    page = sim.report(tmp_path / "page.html").path.read_text()
    assert "The run was stopped at t = " in page and "without equilibrium" in summary(page)["exit"]
    assert times(page)[-1] == sim.time and len(set(times(page))) == len(times(page))


def test_a_reference_of_no_use_is_a_note(column: dict[str, Any], tmp_path: Path) -> None:
    column["compare"] = [{"column": "bottom.displacement.z", "file": "exact.csv"}]

    def computed(reference: str) -> tuple[list[str], Any]:
        (tmp_path / "exact.csv").write_text(reference)
        sim = moldwarp.Simulation(moldwarp.Scene(column, folder=tmp_path)).run()
        # A file of a session needs no reference beside it.
        (tmp_path / "exact.csv").unlink()
        (tmp_path / "kept").mkdir(exist_ok=True)
        sim.save(tmp_path / "kept/a.mw")
        loaded = moldwarp.Simulation.load(tmp_path / "kept/a.mw")
        pages = [s.report(tmp_path / "page.html").path.read_text() for s in (sim, loaded)]
        assert summary(pages[0]) == summary(pages[1])
        return sim.notes, summary(pages[0])["compare"]

    notes, compared = computed("time,value\n0,0\n1,-0.1\n")
    assert notes == [] and compared[0]["file"] == "exact.csv" and compared[0]["reference_peak"] == 0.1
    notes, compared = computed("time\n0\n1\n")
    assert "nothing is compared: " in notes[0] and "exact.csv has one column" in notes[0] and compared == []


def test_what_cannot_be_written_or_read(column: dict[str, Any], tmp_path: Path) -> None:
    sim = moldwarp.Simulation(column)
    sim.step(3)
    notes = tmp_path / "notes.txt"
    notes.write_text("mine")
    for path, what in [
        (tmp_path, "is a folder"),
        (notes, "is there already, and is no report"),
        (tmp_path / "no/page.html", "cannot write"),
    ]:
        with pytest.raises(moldwarp.FileError) as caught:
            sim.report(path)
        assert what in caught.value.message
    assert notes.read_text() == "mine"
    for folder, what in [
        (tmp_path / "nowhere", "there is no folder"),
        (tmp_path, "is not the folder of a run"),
    ]:
        with pytest.raises(moldwarp.FileError) as caught:
            moldwarp.report(folder)
        assert what in caught.value.message
        assert caught.value.help and "moldwarp run" in caught.value.help
    wrong: list[Any] = [0, -1, 2.5, True, "all"]
    for number in wrong:
        with pytest.raises(ValueError, match="`particles` is a whole number from 1 on"):
            sim.report(tmp_path / "page.html", particles=number)
        with pytest.raises(ValueError, match="`frames` is a whole number"):
            moldwarp.report(tmp_path, frames=number)
    assert not (tmp_path / "page.html").exists()


def test_a_frame_that_cannot_be_kept_raises_and_the_simulation_goes_on(column: dict[str, Any], tmp_path: Path) -> None:
    sim = moldwarp.Simulation(column, keep_frames=True)
    assert sim._frames is not None
    kept = Path(sim._frames.name)
    shutil.rmtree(kept / "frames")
    with pytest.raises(moldwarp.FileError, match="particles_00001.vtu"):
        sim.run()
    assert 0 < sim.steps < 100
    (kept / "frames").mkdir()
    assert sim.run().state_hash == moldwarp.Simulation(column).run().state_hash
    del sim
    assert not kept.exists()


def test_notebooks_show_a_link(column: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    written = moldwarp.Simulation(column).run().report("a column & more.html")
    assert repr(written).startswith("<Report 'a column & more.html', ")
    shown = written._repr_html_()
    assert '<a href="a%20column%20%26%20more.html"' in shown and "a column &amp; more.html" in shown
    assert "the last state alone" in shown
    absolute = moldwarp.Simulation(column).report(tmp_path / "x.html")._repr_html_()
    assert f'href="{(tmp_path / "x.html").as_uri()}"' in absolute
