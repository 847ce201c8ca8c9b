"""`esplanade replay` with a change: a table, files, and faults in words."""

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from esplanade import cli
from esplanade.planning import Wall
from esplanade.recordings import read_crowd
from esplanade.server.recording import head
from esplanade.server.recording.reader import Recording
from esplanade.server.replay.replayed_zone import ReplayedZone
from esplanade.server.roster import read_roster
from esplanade.server.whatif.changes import Changes
from esplanade.server.whatif.runner import run_all
from esplanade.server.whatif.runs import Plan, run
from esplanade.server.whatif.stretch import read_stretch
from tests.patience import PATIENCE_S
from tests.server.populated import HALL, spec
from tests.server.recording.recorded import record


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("recordings") / "hall.mcap"
    assert record(path) == []
    return path


def replay(path: Path, *options: str) -> int:
    return cli.main(["replay", str(path), *options])


@pytest.fixture(scope="module")
def roster(tmp_path_factory: pytest.TempPathFactory) -> Path:
    wanders = {"least_pause_s": 0.1, "most_pause_s": 0.3}
    actors = [spec(k, "wander", behaviour=wanders).model_dump(mode="json") for k in (1, 2, 3)]
    path = tmp_path_factory.mktemp("rosters") / "wanderers.json"
    path.write_text(json.dumps({"actors": actors}))
    return path


def test_one_run_is_compared_and_says_that_nothing_is_known_of_chance(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "figures.json"
    options = ("--from", "1", "--to", "11", "--set", "speed_mps=0.6", "--json", str(out))
    assert replay(recording, *options) == 0
    told = capsys.readouterr().out
    assert "from 1 s to 11 s of hall.mcap, changed: speed_mps = 0.6." in told
    assert "nothing is known of chance" in told
    assert "whatever actors do" in told
    figures = {each["name"]: each for each in json.loads(out.read_text())["figures"]}
    assert figures["speed_mps"]["changed"] < 0.61 < figures["speed_mps"]["unchanged"]
    assert "low" not in figures["speed_mps"]
    assert "displacement_m" not in figures


def test_seeds_give_intervals_and_one_page(
    recording: Path, roster: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page, out = tmp_path / "out.html", tmp_path / "figures.json"
    changed = ("--roster", str(roster), "--set", "speed_mps=0.6")
    runs = ("--seeds", "3", "--processes", "1", "--to", "8")
    assert replay(recording, *changed, *runs, "--report", str(page), "--json", str(out)) == 0
    told = capsys.readouterr().out
    assert "3 runs each" in told
    assert "fewer than 10 seeds" in told
    found = json.loads(out.read_text())
    speed = next(each for each in found["figures"] if each["name"] == "speed_mps")
    assert speed["low"] <= speed["difference"] <= speed["high"] < 0.0
    assert speed["differs"]
    # Those recorded patrol, and draw nothing; the wanderers of the roster do.
    assert len(set(speed["by_seed"]["unchanged"])) == 1
    assert len(set(speed["by_seed"]["changed"])) == 3
    assert len(found["strip"]["begins_s"]) == 8
    text = page.read_text()
    assert text.startswith("<!doctype html>")
    assert "<h1>What if: speed_mps = 0.6, 3 actors of another roster</h1>" in text
    assert text.count("<svg") >= 8
    assert "src=" not in text
    assert "esplanade replay" in text


@pytest.fixture(scope="module")
def walled(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The hall with a wall more, in the eastern half."""
    wall = Wall(start=(9.0, 3.0), end=(9.0, 8.0))
    scene = HALL.model_copy(update={"name": "walled", "walls": (*HALL.walls, wall)})
    path = tmp_path_factory.mktemp("scenes") / "walled.json"
    path.write_text(scene.model_dump_json(exclude_none=True))
    return path


def test_another_scene_is_compared_with_a_new_beginning_in_the_own_one(
    recording: Path, walled: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, walks = tmp_path / "figures.json", tmp_path / "walks.csv"
    options = ("--from", "1", "--scene", str(walled), "--json", str(out))
    assert replay(recording, *options, "--trajectories", str(walks)) == 0
    told = capsys.readouterr().out
    assert "changed: scene walled." in told
    assert "In both worlds actors begin anew" in told
    apart = json.loads(out.read_text())["strip"]["apart_m"]
    assert apart[0] < 0.2 < max(apart)
    assert len(read_crowd(walks).tracks) == 5


def test_people_who_react_are_told_of_with_what_is_imposed_on_them(
    recording: Path, roster: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "figures.json"
    options = ("--roster", str(roster), "--people", "reacting", "--json", str(out))
    assert replay(recording, *options) == 0
    told = capsys.readouterr().out
    assert "by a social force model" in told
    figures = {each["name"]: each for each in json.loads(out.read_text())["figures"]}
    for name in ("displacement_m", "delay_s"):
        assert figures[name]["unchanged"] == 0.0 <= figures[name]["changed"]
    assert figures["displacement_m"]["changed"] > 0.0


def test_processes_have_the_figures_of_this_one(recording: Path, roster: Path) -> None:
    with Recording(recording) as opened, ReplayedZone(opened.head) as replayed:
        first = opened.first_tick
        stretch = read_stretch(opened, replayed, first, first + 100)
        changes = Changes({"speed_mps": 0.6}, read_roster(roster))
        plans = [Plan(changes, "reacting", seed) for seed in (1, 2)]
        # This zone has run something else meanwhile.
        here = [run(replayed, stretch, plan).figures for plan in reversed(plans)]
        there = [each.figures for each in run_all(stretch, plans, 2, lambda: None)]
    assert there == [pytest.approx(each, rel=0.0, abs=0.0, nan_ok=True) for each in here[::-1]]
    assert there[0] != there[1]


def test_the_changed_run_is_written(recording: Path, roster: Path, tmp_path: Path) -> None:
    out = tmp_path / "walks.csv"
    options = ("--from", "2", "--roster", str(roster), "--trajectories", str(out))
    assert replay(recording, *options) == 0
    text = out.read_text()
    assert "# changed: the roster wanderers.json\n" in text
    # Three recorded actors are gone with the first ticks; two people walk on.
    assert len(read_crowd(out).tracks) == 8


def test_ctrl_c_ends_it_soon_and_quietly(recording: Path) -> None:
    words = ["--set", "speed_mps=0.6", "--seeds", "1000", "--processes", "1"]
    command = [sys.executable, "-m", "esplanade", "replay", str(recording), *words]
    with subprocess.Popen(
        command, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as running:
        deadline = time.monotonic() + PATIENCE_S
        # One of them looks after what the others share.
        while len(children(running.pid)) < 2 and time.monotonic() < deadline:
            time.sleep(0.05)
        assert running.poll() is None
        os.killpg(running.pid, signal.SIGINT)
        _, said = running.communicate(timeout=PATIENCE_S)
    assert running.returncode == 130
    assert "Traceback" not in said


def children(process: int) -> list[int]:
    """Processes that a process has started."""
    found = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            # The name, in brackets, may hold anything; the parent is the second field after it.
            parent = path.read_text().rpartition(")")[2].split()[1]
            found += [int(path.parent.name)] if int(parent) == process else []
    return found


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["--set", "risk_wait=20"], "'risk_wait' is no parameter of actors; did you mean"),
        (["--set", "risk_weight=900"], "--set: risk_weight: Input should be less than"),
        (["--set", "risk_weight"], "has no value"),
        (["--set", "speed_mps=2.5"], "max_speed_mps"),
        (["--door", "gate=ajar"], "is not NAME=open or NAME=closed"),
        (["--door", "moon=open"], "the scene has no door 'moon'; it has gate"),
        (["--set", "risk_weight=20", "--from", "3600"], "the recording has 12.45 s"),
        (["--set", "risk_weight=20", "--from", "5", "--to", "5.01"], "there is no tick between"),
    ],
)
def test_what_cannot_be_is_refused_with_2(
    recording: Path, capsys: pytest.CaptureFixture[str], options: list[str], text: str
) -> None:
    assert replay(recording, *options) == 2
    assert text in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["--set", "risk_weight=20", "--seeds", "0"], "--seeds"),
        (["--seeds", "5"], "nothing is changed"),
        (["--people", "reacting"], "nothing is changed"),
        (["--set", "risk_weight=20", "--verify"], "of the recording as it is"),
        (["--set", "risk_weight=20", "--processes", "2"], "belongs to --seeds"),
        (["--set", "a=1", "--seeds", "2", "--trajectories", "a.csv"], "they are of one run"),
    ],
)
def test_options_that_do_not_fit_are_refused(
    recording: Path, capsys: pytest.CaptureFixture[str], options: list[str], text: str
) -> None:
    with pytest.raises(SystemExit) as ended:
        replay(recording, *options)
    assert ended.value.code == 2
    assert text in capsys.readouterr().err


def test_a_scene_that_is_too_small_or_lacks_a_place_is_refused(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "other.json"
    path.write_text('{"name": "small", "bounds": [0, 0, 3, 3]}')
    assert replay(recording, "--scene", str(path)) == 2
    assert "people were recorded outside of its bounds" in capsys.readouterr().err
    path.write_text('{"name": "bare", "bounds": [0, 0, 14, 9]}')
    assert replay(recording, "--scene", str(path)) == 2
    assert "no place named 'east'" in capsys.readouterr().err
    path.write_text('{"name": "broken"}')
    assert replay(recording, "--scene", str(path)) == 2
    assert "bounds: is missing" in capsys.readouterr().err


def test_a_broken_roster_is_named(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "broken.json"
    path.write_text('{"actors": [{"id": "main/a1"}]}')
    assert replay(recording, "--roster", str(path)) == 2
    assert "broken.json: actors.0.name" in capsys.readouterr().err


def test_what_another_program_recorded_is_refused(
    recording: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    mine = head.this_program()
    other: dict[str, Any] = {**mine, "sources sha256": "0" * 64}
    monkeypatch.setattr(head, "this_program", lambda: other)
    assert replay(recording, "--set", "risk_weight=20") == 2
    assert "another program has recorded it" in capsys.readouterr().err
