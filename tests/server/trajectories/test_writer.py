"""The thread that writes trajectories: its bound, a disk that is full or slow, and its end."""

import resource
import threading
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from esplanade.recordings import read_crowd
from esplanade.recordings.jupedsim_tables import box
from esplanade.recordings.samples import SAMPLE, Head, Note, Samples
from esplanade.recordings.writing import WritingError
from esplanade.server.file_thread import Ended
from esplanade.server.trajectories import writer as module
from esplanade.server.trajectories.blocks import Block
from esplanade.server.trajectories.writer import MOST_BLOCKS, TrajectoryWriter, free_path
from tests.patience import PATIENCE_S

BOUNDS = (0.0, 0.0, 10.0, 10.0)
HEAD = Head({"written by": "tests"}, 20.0, BOUNDS, box(BOUNDS))


def block(tick: int, people: int = 3) -> Block:
    samples = np.zeros(people, dtype=SAMPLE)
    samples["frame"], samples["t"] = tick, tick / 20.0
    samples["id"], samples["x"] = np.arange(1, people + 1), 0.06 * tick
    samples["y"] = samples["id"]
    return Block(tick, tick, samples)


class Heard:
    """The last words of a writer, waited for."""

    def __init__(self) -> None:
        self.faults: list[Ended] = []
        self._some = threading.Event()

    def __call__(self, fault: Ended) -> None:
        self.faults.append(fault)
        self._some.set()

    def wait(self) -> Ended:
        assert self._some.wait(PATIENCE_S)
        return self.faults[0]


def test_blocks_become_a_complete_file(tmp_path: Path) -> None:
    heard, path = Heard(), tmp_path / "a.csv"
    writer = TrajectoryWriter(path, HEAD, heard)
    for tick in range(1, 101):
        writer.put(block(tick))
    writer.close()
    assert heard.faults == []
    assert (writer.written, writer.waiting) == (100, 0)
    assert [len(track.times) for track in read_crowd(path).tracks] == [100, 100, 100]
    assert path.read_text().endswith("# frame 100, tick 100, end: {}\n")


def test_a_full_disk_ends_the_file_and_nothing_else(tmp_path: Path) -> None:
    heard, path = Heard(), tmp_path / "a.csv"
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, hard))
    try:
        writer = TrajectoryWriter(path, HEAD, heard)
        tick = 0
        while writer.fault is None and tick < MOST_BLOCKS:
            tick += 1
            writer.put(block(tick, people=100))
        fault = heard.wait()
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert fault.code == "unwritable"
    assert "File too large" in fault.text
    writer.put(block(tick + 1))
    assert writer.waiting == 0
    writer.close()
    assert len(heard.faults) == 1
    assert path.stat().st_size <= 100_000


class StuckDisk:
    """A stream whose first block does not come to an end before it is let."""

    def __init__(self) -> None:
        self.taken = threading.Event()
        self.go_on = threading.Event()
        self.added: list[int] = []
        self.notes: list[Note] = []

    def add(self, samples: Samples) -> None:
        self.taken.set()
        self.go_on.wait(PATIENCE_S)
        self.added.append(int(samples["frame"][0]))

    def note(self, note: Note) -> None:
        self.notes.append(note)

    def flush(self) -> None:
        pass

    def close(self) -> None:
        pass


def test_a_disk_that_takes_less_than_the_world_gives_ends_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    disk = StuckDisk()
    monkeypatch.setattr(module, "open_stream", lambda path, head: disk)
    heard = Heard()
    writer = TrajectoryWriter(tmp_path / "a.csv", HEAD, heard)
    writer.put(block(1))
    assert disk.taken.wait(PATIENCE_S)
    for tick in range(2, MOST_BLOCKS + 2):
        writer.put(block(tick))
    assert (writer.waiting, heard.faults) == (MOST_BLOCKS, [])
    writer.put(block(MOST_BLOCKS + 2))
    assert heard.wait().code == "too_slow"
    assert writer.waiting == 0
    disk.go_on.set()
    writer.close()
    assert disk.added == [1]
    assert disk.notes[-1].text == '{"fault": "too_slow"}'


def test_large_blocks_are_bounded_by_their_bytes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    disk = StuckDisk()
    monkeypatch.setattr(module, "open_stream", lambda path, head: disk)
    monkeypatch.setattr(module, "MOST_BYTES", 100_000)
    heard = Heard()
    writer = TrajectoryWriter(tmp_path / "a.csv", HEAD, heard)
    for tick in range(1, 20):
        writer.put(block(tick, people=100))
    assert heard.wait().code == "too_slow"
    disk.go_on.set()
    writer.close()


def test_a_file_that_cannot_be_written_is_refused_at_the_start(tmp_path: Path) -> None:
    with pytest.raises(WritingError, match="No such file or directory"):
        TrajectoryWriter(tmp_path / "no" / "a.csv", HEAD, Heard())


def test_a_fault_of_what_makes_blocks_ends_the_file_in_good_order(tmp_path: Path) -> None:
    heard, path = Heard(), tmp_path / "a.csv"
    writer = TrajectoryWriter(path, HEAD, heard)
    writer.put(cast(Block, SimpleNamespace(size=1, tick=1)))
    assert heard.wait().code == "failed"
    writer.close()
    assert path.read_text().startswith("# written by: tests\n")


def test_no_file_is_written_over(tmp_path: Path) -> None:
    path = tmp_path / "day.csv"
    assert free_path(path) == path
    path.touch()
    (tmp_path / "day-2.csv").touch()
    assert free_path(path) == tmp_path / "day-3.csv"
