"""Files that are written as a world goes on: read back by us, and by the readers of others."""

import json
import sqlite3
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from esplanade.commandline import trajectory_files
from esplanade.recordings import read_crowd
from esplanade.recordings.jupedsim_tables import box
from esplanade.recordings.samples import SAMPLE, Head, Note, Samples
from esplanade.recordings.streams import SUFFIXES, Stream, open_stream
from esplanade.recordings.writing import WritingError

BOUNDS = (-5.0, -5.0, 45.0, 25.0)
HEAD = Head({"written by": "tests", "command": "a\nb"}, 10.0, BOUNDS, box(BOUNDS))
FORMATS = [s for s in SUFFIXES if s != ".parquet" or find_spec("pyarrow")]
NOTE = Note(3, 6, "parameters", json.dumps({"actors": {"main/actor-1": {"speed_mps": 0.8}}}))
DIGITS_M = 0.5e-4


def frames(first: int, count: int, people: int) -> list[Samples]:
    """People in rows who walk to the east at 1.25 m/s, 10 frames a second; each second is one of
    the actors."""
    found = []
    for frame in range(first, first + count):
        samples = np.zeros(people, dtype=SAMPLE)
        samples["frame"], samples["t"] = frame, frame / 10.0
        samples["id"] = np.arange(1, people + 1)
        samples["actor"] = samples["id"] % 2 == 0
        samples["x"], samples["y"] = 0.125 * (frame - first), samples["id"]
        samples["vx"] = 1.25
        found.append(samples)
    return found


def begun(path: Path, blocks: list[Samples]) -> Stream:
    """A file with these frames, not closed yet."""
    stream = open_stream(path, HEAD)
    for block in blocks:
        if int(block["frame"][0]) == NOTE.frame:
            stream.note(NOTE)
        stream.add(block)
    stream.flush()
    return stream


def write(path: Path, blocks: list[Samples]) -> None:
    begun(path, blocks).close()


@pytest.mark.parametrize("suffix", FORMATS)
@settings(
    max_examples=15,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(first=st.integers(0, 40), count=st.integers(2, 30), people=st.integers(1, 6))
def test_round_trip(tmp_path: Path, suffix: str, first: int, count: int, people: int) -> None:
    path = tmp_path / f"a{suffix}"
    write(path, frames(first, count, people))
    crowd = read_crowd(path, strict=True)
    assert crowd.report is not None
    assert not crowd.report.warnings
    assert sorted(int(track.id) for track in crowd.tracks) == list(range(1, people + 1))
    for track in crowd.tracks:
        np.testing.assert_allclose(track.times, (first + np.arange(count)) / 10.0, atol=1e-9)
        np.testing.assert_allclose(track.positions[:, 0], 0.125 * np.arange(count), atol=DIGITS_M)
        np.testing.assert_allclose(track.positions[:, 1], int(track.id), atol=DIGITS_M)


@pytest.mark.parametrize("suffix", [s for s in FORMATS if s != ".parquet"])
def test_what_was_flushed_can_be_read_though_the_process_ended(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    stream = begun(path, frames(0, 12, 3))
    found = [len(track.times) for track in read_crowd(path).tracks]
    stream.close()
    assert found == [12, 12, 12]


def test_pandas_reads_the_table_with_units_and_notes_as_comments(tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    path = tmp_path / "a.csv"
    write(path, frames(0, 20, 4))
    table = pandas.read_csv(path, comment="#")
    assert list(table.columns[:5]) == ["frame", "t", "id", "kind", "x"]
    assert len(table) == 80
    assert table.t.max() == pytest.approx(1.9)
    assert set(table[table.id == 2].kind) == {"actor"}
    text = path.read_text()
    assert "# command: a b\n" in text
    assert "# frame 3, tick 6, parameters: {" in text
    assert "heading [rad]" in text


def test_pandas_reads_parquet_and_the_file_says_what_it_is(tmp_path: Path) -> None:
    pandas, parquet = pytest.importorskip("pandas"), pytest.importorskip("pyarrow.parquet")
    path = tmp_path / "a.parquet"
    write(path, frames(0, 20, 4))
    table = pandas.read_parquet(path)
    assert len(table) == 80
    assert table.vx.median() == pytest.approx(1.25)
    told = parquet.read_schema(path).metadata
    assert json.loads(told[b"esplanade"])["written by"] == "tests"
    assert json.loads(told[b"units"])["vx"] == "m/s"
    (note,) = json.loads(parquet.read_metadata(path).metadata[b"notes"])
    assert (note["frame"], note["tick"]) == (3, 6)


@pytest.mark.parametrize("suffix", [".txt", ".sqlite"])
def test_pedpy_gives_density_and_speed(tmp_path: Path, suffix: str) -> None:
    pedpy = pytest.importorskip("pedpy")
    path = tmp_path / f"a{suffix}"
    write(path, frames(0, 40, 6))
    if suffix == ".txt":
        data = pedpy.load_trajectory_from_txt(trajectory_file=path)
        area = pedpy.WalkableArea([(-5, -5), (45, -5), (45, 25), (-5, 25)])
    else:
        data = pedpy.load_trajectory_from_jupedsim_sqlite(trajectory_file=path)
        area = pedpy.load_walkable_area_from_jupedsim_sqlite(trajectory_file=path)
    assert data.frame_rate == 10.0
    assert area.polygon.area == pytest.approx(50 * 30)
    square = pedpy.MeasurementArea([(-1, 0), (9, 0), (9, 10), (-1, 10)])
    density = pedpy.compute_classic_density(traj_data=data, measurement_area=square)
    assert density.density.to_numpy() == pytest.approx(6 / 100)
    speed = pedpy.compute_individual_speed(traj_data=data, frame_step=2)
    assert speed.speed.median() == pytest.approx(1.25, abs=0.01)


def test_jupedsim_opens_the_sqlite(tmp_path: Path) -> None:
    recording = pytest.importorskip("jupedsim").Recording
    path = tmp_path / "a.sqlite"
    write(path, frames(0, 8, 3))
    found = recording(str(path))
    assert (found.num_frames, found.fps) == (8, 10.0)
    assert [agent.id for agent in found.frame(4).agents] == [1, 2, 3]
    assert found.frame(4).agents[0].position == pytest.approx((0.5, 1.0))
    assert found.frame(4).agents[0].orientation == pytest.approx((1.0, 0.0))
    assert found.geometry().area == pytest.approx(50 * 30)
    with sqlite3.connect(path) as connection:
        notes = connection.execute("SELECT frame, tick, kind FROM esplanade_notes").fetchall()
    assert notes == [(3, 6, "parameters")]


def test_commands_know_the_same_forms() -> None:
    assert trajectory_files.SUFFIXES == SUFFIXES


def test_files_that_cannot_be_written(tmp_path: Path) -> None:
    with pytest.raises(WritingError, match=r"a\.doc ends in none of \.csv"):
        open_stream(tmp_path / "a.doc", HEAD)
    for suffix in FORMATS:
        with pytest.raises(WritingError, match="cannot be written"):
            open_stream(tmp_path / "no" / f"a{suffix}", HEAD)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no full disk to try")
@pytest.mark.parametrize("suffix", [".csv", ".txt"])
def test_a_full_disk_is_named(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    path.symlink_to("/dev/full")
    stream = open_stream(path, HEAD)

    def fill() -> None:
        for block in frames(0, 200, 200):
            stream.add(block)

    with pytest.raises(WritingError, match="No space left on device"):
        fill()
    with suppress(WritingError):
        stream.close()
