"""`esplanade replay`: all is equal, or the first tick that differs is named with its field."""

import sys
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader

from esplanade import cli
from esplanade.actors.locomotion.footsteps import walkers
from esplanade.recordings import read_crowd
from esplanade.server.recording import head
from esplanade.server.recording.reader import Recording
from tests.server.recording.recorded import record, rewritten


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("recordings") / "hall.mcap"
    assert record(path) == []
    return path


def replay(path: Path, *options: str) -> int:
    return cli.main(["replay", str(path), *options])


def chunk_at(path: Path, number: int) -> int:
    """The place in the file of one of its chunks."""
    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    return summary.chunk_indexes[number].chunk_start_offset


def test_all_digests_are_equal(recording: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert replay(recording, "--verify") == 0
    told = capsys.readouterr().out
    assert "14 digests, all equal" in told
    assert "1 to 250" in told


def test_a_recording_that_ends_in_the_middle_of_a_tick_has_only_what_can_be_compared(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "hall.mcap"
    assert record(path, 50, ends_in_a_tick=True) == []
    assert replay(path, "--verify") == 0
    told = capsys.readouterr().out
    assert "3 digests, all equal" in told
    assert "1 to 40" in told


def test_trajectories_are_those_of_the_world(recording: Path, tmp_path: Path) -> None:
    out = tmp_path / "walks.csv"
    assert replay(recording, "--trajectories", str(out), "--hz", "10") == 0
    crowd = read_crowd(out)
    assert len(crowd.tracks) == 5
    text = out.read_text()
    assert "# recording: hall.mcap\n" in text
    assert text.rstrip().endswith("end: {}")


def test_a_part_begins_at_the_nearest_state_and_is_that_of_the_world(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    whole, part = tmp_path / "whole.csv", tmp_path / "part.csv"
    assert replay(recording, "--trajectories", str(whole)) == 0
    capsys.readouterr()
    options = ("--from", "00:00:11", "--to", "12", "--verify", "--trajectories", str(part))
    assert replay(recording, *options) == 0
    told = capsys.readouterr().out
    assert "200 to 241, 2.05 s" in told
    assert "all equal" in told

    def rows(path: Path) -> list[str]:
        return [line for line in path.read_text().splitlines() if line[:1].isdigit()]

    assert rows(part)
    frames = {int(row.split(",")[0]) for row in rows(part)}
    assert (min(frames), max(frames)) == (222, 241)
    assert set(rows(part)) <= set(rows(whole))


def test_nothing_is_read_between_the_beginning_and_the_nearest_state(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    damaged = tmp_path / "damaged.mcap"
    data = bytearray(recording.read_bytes())
    data[chunk_at(recording, 4) + 150] ^= 1
    damaged.write_bytes(data)
    assert replay(damaged, "--verify") == 1
    assert "is damaged" in capsys.readouterr().err
    assert replay(damaged, "--from", "10.5", "--verify") == 0
    assert "200 to 250" in capsys.readouterr().out


def test_a_part_of_a_file_that_is_cut_off_is_found_without_an_index(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(recording.read_bytes()[: chunk_at(recording, -1) + 20])
    assert replay(cut, "--from", "10.5", "--verify") == 0
    assert "200 to 240" in capsys.readouterr().out


@pytest.mark.parametrize("is_cut", [False, True])
def test_a_moment_after_the_end_is_refused(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], *, is_cut: bool
) -> None:
    path = tmp_path / "hall.mcap"
    data = recording.read_bytes()
    path.write_bytes(data[: chunk_at(recording, -1) + 20] if is_cut else data)
    assert replay(path, "--from", "1:00:00") == 2
    length = "11.95" if is_cut else "12.45"
    assert f"--from 3600 s: the recording has {length} s" in capsys.readouterr().err


def test_moments_that_are_none_are_refused(
    recording: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit, match="2"):
        replay(recording, "--from", "noon")
    assert "'noon' is no moment such as 00:12:30" in capsys.readouterr().err
    with pytest.raises(SystemExit, match="2"):
        replay(recording, "--from", "5", "--to", "5")
    assert "--to: it must be after --from" in capsys.readouterr().err


def test_what_is_in_a_recording_is_told(
    recording: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert replay(recording, "--info") == 0
    told = capsys.readouterr().out
    assert "esplanade recording 1" in told
    assert "left out" in told


def test_another_direction_of_one_person_is_named(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def turned(topic: str, told: Any) -> Any:
        for inputs in told["inputs"] if topic == "inputs" else ():
            for each in inputs:
                if each["kind"] == "steer":
                    each["direction_rad"] = 0.31
        return told

    path = rewritten(recording, tmp_path / "turned.mcap", message=turned)
    assert replay(path, "--verify") == 1
    fault = capsys.readouterr().err
    assert "tick 12 is the first that differs, in avatars, people" in fault
    assert "avatars.positions" in fault


def test_one_bit_in_an_input_is_named(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    data = bytearray(recording.read_bytes())
    data[chunk_at(recording, 4) + 120] ^= 1
    path = tmp_path / "bit.mcap"
    path.write_bytes(data)
    assert replay(path, "--verify") == 1
    assert "the second of the world that ends at 4.00 s is damaged: " in capsys.readouterr().err


def test_a_changed_constant_is_named(
    recording: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(walkers, "TRACK_HALF_WIDTH", 0.2)
    assert replay(recording, "--verify") == 1
    fault = capsys.readouterr().err
    assert "tick 5 is the first that differs, in " in fault
    assert "feet" in fault


def test_a_cut_file_is_verified_up_to_its_last_whole_second(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    data = recording.read_bytes()
    path = tmp_path / "cut.mcap"
    path.write_bytes(data[: chunk_at(recording, 8) + 200])
    assert replay(path, "--verify") == 0
    told = capsys.readouterr().out
    assert "cut off" in told
    assert "8 digests, all equal" in told


@pytest.mark.parametrize("name", ["scene.json", "settings.json"])
def test_a_missing_attachment_is_named(
    recording: Path, tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = rewritten(recording, tmp_path / "less.mcap", keep=lambda each: each != name)
    assert replay(path, "--verify") == 1
    assert f"the attachment {name} is missing" in capsys.readouterr().err


def test_a_damaged_attachment_is_named(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "damaged.mcap"
    path.write_bytes(recording.read_bytes().replace(b'"seed": 3', b'"seed": 4', 1))
    assert replay(path) == 1
    assert "the attachment settings.json is damaged" in capsys.readouterr().err


def test_a_missing_second_is_named(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def without(topic: str, told: Any) -> Any:
        if topic == "inputs" and told["tick"] == 41:
            told["inputs"], told["checks"] = told["inputs"][1:], told["checks"][1:]
            told["tick"] = 42
        return told

    path = rewritten(recording, tmp_path / "gap.mcap", message=without)
    assert replay(path, "--verify") == 1
    assert "tick 42 comes after tick 40" in capsys.readouterr().err


def test_what_another_program_recorded_is_refused_in_words(
    recording: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    mine = head.this_program()
    monkeypatch.setattr(head, "this_program", lambda: {**mine, "sources sha256": "0" * 64})
    assert replay(recording, "--verify") == 2
    fault = capsys.readouterr().err
    assert "another program has recorded it" in fault
    assert "sources sha256" in fault
    assert replay(recording, "--verify", "--other-program") == 0


def test_a_file_that_is_no_recording_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.mcap"
    path.write_bytes(b"frame,x,y\n1,2,3\n")
    assert replay(path) == 1
    assert "a.mcap: " in capsys.readouterr().err


def test_without_the_library_the_extra_is_named(
    recording: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in [each for each in sys.modules if each.partition(".")[0] == "mcap"]:
        monkeypatch.delitem(sys.modules, name)
    for name in ("recording.reader", "replay.running"):
        monkeypatch.delitem(sys.modules, f"esplanade.server.{name}")
    monkeypatch.setitem(sys.modules, "mcap", None)
    assert replay(recording) == 1
    assert "recordings need mcap: install esplanade[record]" in capsys.readouterr().err


def test_options_that_do_not_fit_are_refused(recording: Path) -> None:
    for options in (("--hz", "10"), ("--info", "--verify")):
        with pytest.raises(SystemExit) as ended:
            replay(recording, *options)
        assert ended.value.code == 2


def test_the_reader_gives_seconds_from_a_state_on(recording: Path) -> None:
    with Recording(recording) as opened:
        seconds = list(opened.seconds())
    assert seconds[0].state is not None
    assert [tick.tick for second in seconds for tick in second.ticks] == list(range(2, 251))
    assert not opened.is_cut
