"""A folder of recordings keeps to its limits, and a person is forgotten in all of them."""

import json
import os
import shutil
import time
from pathlib import Path

import pytest
from mcap.reader import make_reader

from esplanade import cli
from esplanade.server.file_thread import Ended
from esplanade.server.recording.errors import ZoneRecordingError
from esplanade.server.recording.folder import (
    RecordingFolder,
    is_being_written,
    mark_as_written,
    recordings_in,
)
from esplanade.server.recording.forgetting import forget_in_recordings
from esplanade.server.recording.head import Built, Head
from esplanade.server.recording.reader import Recording
from esplanade.server.recording.zone_recording import ZoneRecording
from tests.server.recording.recorded import hall, inputs_of_file, record, script

DAY_S = 86400.0


@pytest.fixture(scope="module")
def named(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("recordings") / "named.mcap"
    assert record(path, names=True, chat=True) == []
    return path


def recordings(folder: Path, named: Path, count: int) -> list[Path]:
    """Copies of a recording, the first of which is the oldest: a day older than the next."""
    made = []
    for number in range(count):
        path = folder / f"r{number}.mcap"
        shutil.copy(named, path)
        ended_s = time.time() - (count - number - 0.5) * DAY_S
        os.utime(path, (ended_s, ended_s))
        made.append(path)
    return made


def test_the_oldest_recordings_go_and_others_files_stay(named: Path, tmp_path: Path) -> None:
    made = recordings(tmp_path, named, 4)
    other = tmp_path / "other.mcap"
    other.write_bytes(b"\x89MCAP0\r\n of another program" + bytes(10**6))
    os.utime(other, (0, 0))
    gone: list[tuple[str, str]] = []

    def removed(path: Path, why: str) -> None:
        gone.append((path.name, why))

    RecordingFolder(tmp_path, None, None, removed).clear()
    RecordingFolder(tmp_path, 4 * named.stat().st_size, 9.0, removed).clear()
    assert gone == []
    RecordingFolder(tmp_path, None, 3.0, removed).clear()
    ((name, why),) = gone
    assert name == "r0.mcap"
    assert "it ended 3.5 days ago" in why
    with made[1].open("rb") as file:
        mark_as_written(file)
        assert is_being_written(made[1])
        RecordingFolder(tmp_path, 2.5 * named.stat().st_size, None, removed).clear()
    assert [name for name, _ in gone] == ["r0.mcap", "r2.mcap"]
    assert not is_being_written(made[1])
    assert recordings_in(tmp_path) == [made[1], made[3]]
    assert other.exists()


def test_a_long_world_is_recorded_in_several_files_each_of_which_runs_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    world, path, faults = hall(), tmp_path / "hall.mcap", list[Ended]()
    head = Head.of(world.zone, Built.of(world.zone, "hall", 3, 0.25))
    recording = ZoneRecording(world.zone, head, path, faults.append, longest_s=4)
    at = script(ann=4)
    for tick in range(1, 201):
        recording.take(world.frame(*at.get(tick, [])), world.inputs[-1])
    assert is_being_written(recording.path)
    recording.close()
    world.population.close()
    assert faults == []
    files = sorted(tmp_path.glob("*.mcap"))
    assert [each.name for each in files] == ["hall-2.mcap", "hall-3.mcap", "hall.mcap"]
    ticks = []
    for each in (path, *files[:2]):
        with Recording(each) as found:
            seconds = list(found.seconds())
            assert not found.is_cut
        ticks += [tick.tick for second in seconds for tick in second.ticks]
        assert cli.main(["replay", str(each), "--verify"]) == 0
    assert ticks == list(range(2, 201))
    assert "all equal" in capsys.readouterr().out


def test_a_person_is_forgotten_in_recordings_and_these_still_verify(
    named: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "named.mcap"
    shutil.copy(named, path)
    ended_ns = path.stat().st_mtime_ns
    hidden = tmp_path / "hidden.mcap"
    assert record(hidden) == []
    kept = hidden.read_bytes()
    assert forget_in_recordings(tmp_path, "Ann Narcissus") == 1
    assert hidden.read_bytes() == kept
    with path.open("rb") as file:
        for _, channel, message in make_reader(file, validate_crcs=True).iter_messages():
            assert b"Narcissus" not in message.data, channel.topic
            assert b"a secret" not in message.data, channel.topic
    assert b"Narcissus" not in path.read_bytes()
    names = [each["name"] for each in inputs_of_file(path) if each["kind"] == "join"]
    assert names == ["Person", "Ben Echo"]
    assert path.stat().st_mtime_ns == ended_ns
    assert cli.main(["replay", str(path), "--verify"]) == 0
    assert "all equal" in capsys.readouterr().out
    assert forget_in_recordings(tmp_path, "Ann Narcissus") == 0
    assert sorted(each.name for each in tmp_path.iterdir()) == ["hidden.mcap", "named.mcap"]


def test_lines_that_name_a_person_are_forgotten_and_others_lines_are_kept(
    named: Path, tmp_path: Path
) -> None:
    path = tmp_path / "named.mcap"
    shutil.copy(named, path)
    assert forget_in_recordings(tmp_path, "Ben Echo") == 1
    lines = [each["text"] for each in inputs_of_file(path) if each["kind"] == "say"]
    assert lines == ["a secret of Ann's"]
    assert forget_in_recordings(tmp_path, "Ann") == 1
    assert [each for each in inputs_of_file(path) if each["kind"] == "say"] == []
    assert "Ann Narcissus" in json.dumps(inputs_of_file(path))


def test_a_recording_that_is_being_written_is_named_and_left_as_it_is(
    named: Path, tmp_path: Path
) -> None:
    path = tmp_path / "named.mcap"
    shutil.copy(named, path)
    before = path.read_bytes()
    with path.open("rb") as file:
        mark_as_written(file)
        with pytest.raises(ZoneRecordingError, match=r"named\.mcap: it is being written"):
            forget_in_recordings(tmp_path, "Ben Echo")
    assert path.read_bytes() == before


def test_data_forget_reaches_recordings(
    named: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, data = tmp_path / "kept", tmp_path / "world"
    folder.mkdir()
    shutil.copy(named, folder / "named.mcap")
    user = ["op", "user", "add", "olga", "--role", "tuner", "--token"]
    assert cli.main([*user, "--data", str(data)]) == 0
    asked = ["data", "forget", "Ben Echo", "--data", str(data), "--recordings", str(folder)]
    assert cli.main(asked) == 0
    assert "1 in recordings" in capsys.readouterr().out
    assert "Ben Echo" not in json.dumps(inputs_of_file(folder / "named.mcap"))
    assert cli.main(asked) == 1
    assert "nothing is known of 'Ben Echo'" in capsys.readouterr().err
