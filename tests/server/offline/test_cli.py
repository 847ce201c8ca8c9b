"""`esplanade run`: a file, a summary, clear faults, and Ctrl-C that keeps what was written."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from esplanade.cli import main
from esplanade.planning import Scene
from esplanade.recordings import read_crowd
from tests.patience import PATIENCE_S

ROOM = Scene.open_space((0.0, 0.0, 20.0, 12.0))


@pytest.fixture
def room(tmp_path: Path) -> Path:
    path = tmp_path / "room.json"
    path.write_text(ROOM.model_dump_json(exclude_defaults=True))
    return path


def test_a_world_becomes_a_file(
    room: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "a.txt"
    words = ["run", str(room), "--actors", "3", "--seconds", "2", "--seed", "7"]
    assert main([*words, "--hz", "10", "--out", str(out)]) == 0
    shown = capsys.readouterr()
    assert "2 s in 40 ticks" in shown.out
    assert shown.out.endswith(f"{out}\n")
    crowd = read_crowd(out)
    assert [len(track.times) for track in crowd.tracks] == [20, 20, 20]
    text = out.read_text()
    assert f"# command: esplanade {' '.join(words)} --hz 10 --out {out}\n" in text
    assert "# framerate: 10 fps\n" in text
    assert "# seed: 7\n" in text


def test_the_reader_of_people_is_heard_and_their_columns_named(
    room: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    people, out = tmp_path / "odd.csv", tmp_path / "a.csv"
    rows = "\n".join(f"{t / 10},7,{1 + t / 10},2" for t in range(20))
    people.write_text(f"wann,wer,wo,wie\n{rows}\n")
    words = ["run", str(room), "--people", str(people), "--columns", "t,id,x,y"]
    assert main([*words, "--actors", "0", "--out", str(out)]) == 0
    assert f"esplanade run: {people}: " in capsys.readouterr().err
    assert '"recorded":"7"' in out.read_text().replace(" ", "")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no full disk to try")
def test_a_full_disk_is_one_line(
    room: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    full = tmp_path / "full.csv"
    full.symlink_to("/dev/full")
    assert main(["run", str(room), "--actors", "1", "--seconds", "1", "--out", str(full)]) == 1
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert "No space left on device; it ends at 1.00 s of the world" in line


@pytest.mark.parametrize(
    ("words", "fault"),
    [
        ("--out a.csv", "give a SCENE, or --people to whom the ground is fitted"),
        ("{room} --out a.doc", "a.doc ends in none of .csv, .txt, .sqlite, .parquet"),
        ("{room} --out a.csv --fps 25", "--fps: it says how recorded people are read"),
        ("{room} --out a.csv --hz 3", "3 samples a second lie between the ticks"),
        ("{room} --out no/a.csv", "there is no folder no"),
        ("{room} --out a.csv --people {room}", "room.json"),
        ("{room} --out a.csv --seconds 0", "'0' is no number above 0"),
        ("{broken} --out a.csv", "broken.json"),
    ],
)
def test_faults_are_one_line(
    room: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    words: str,
    fault: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    broken = tmp_path / "broken.json"
    broken.write_text("{")
    given = words.format(room=room, broken=broken).split()
    try:
        code = main(["run", "--actors", "0", *given])
    except SystemExit as end:
        code = int(str(end.code))
    assert code == 2
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert line.startswith("esplanade run: ")
    assert fault in line
    assert not (tmp_path / "a.csv").exists()


def test_ctrl_c_keeps_what_was_written(room: Path, tmp_path: Path) -> None:
    out = tmp_path / "a.csv"
    words = ["run", str(room), "--actors", "2", "--seconds", "1000000", "--out", str(out)]
    running = subprocess.Popen(
        [sys.executable, "-m", "esplanade", *words], stderr=subprocess.PIPE, text=True
    )
    begun = time.monotonic()
    try:
        while not (out.exists() and out.stat().st_size > 40_000):
            assert running.poll() is None
            assert time.monotonic() - begun < PATIENCE_S
            time.sleep(0.05)
        os.kill(running.pid, signal.SIGINT)
        _, said = running.communicate(timeout=PATIENCE_S)
    finally:
        running.kill()
    assert running.returncode == 130
    assert f"interrupted; {out.name} has the first " in said
    tracks = read_crowd(out).tracks
    assert len(tracks) == 2
    assert len(tracks[0].times) == len(tracks[1].times) > 20
