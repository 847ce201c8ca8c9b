"""Round trips: a crowd in each format is read as the same crowd; real readers read it too."""

import sqlite3
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from esplanade.recordings import Crowd, Track, read_crowd
from esplanade.recordings.writing import WritingError, write_crowd

FROM = {"version": "0", "command": "esplanade recording convert a\nb"}
FORMATS = [".csv", ".txt", ".sqlite", *([".parquet"] if find_spec("pyarrow") else [])]


def crowd_of(*walks: tuple[int, int, float]) -> Crowd:
    """People by their first sample, number of samples and heading; 1.25 m/s at 2.5 a second."""
    tracks = []
    for person, (first, count, heading) in enumerate(walks, start=1):
        times = np.arange(first, first + count) / 2.5
        way = 1.25 * (times - times[0])
        places = np.column_stack([way * np.cos(heading), person + way * np.sin(heading)])
        tracks.append(Track(str(person), times, places))
    return Crowd("ours", tuple(tracks))


walks = st.lists(
    st.tuples(st.integers(0, 50), st.integers(2, 12), st.floats(-3.0, 3.0)), min_size=1, max_size=5
)


@pytest.mark.parametrize("suffix", FORMATS)
@settings(
    max_examples=25,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(walks=walks)
def test_round_trip(tmp_path: Path, suffix: str, walks: list[tuple[int, int, float]]) -> None:
    crowd = crowd_of(*walks)
    path = tmp_path / f"a{suffix}"
    write_crowd(path, crowd, FROM)
    found = {track.id: track for track in read_crowd(path, strict=True).tracks}
    assert len(found) == len(crowd.tracks)
    for track in crowd.tracks:
        np.testing.assert_allclose(found[track.id].times, track.times, atol=1e-9)
        np.testing.assert_allclose(found[track.id].positions, track.positions, atol=1e-9)


def test_samples_at_another_rate(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    write_crowd(path, crowd_of((0, 6, 0.0)), FROM, hz=10.0)
    (track,) = read_crowd(path).tracks
    np.testing.assert_allclose(np.diff(track.times), 0.1)
    assert path.read_text().startswith("# version: 0\n# command: esplanade recording convert a b\n")


def test_times_between_frames_are_refused_where_frames_count(tmp_path: Path) -> None:
    times = np.array([0.0, 0.4, 0.8, 1.15])
    crowd = Crowd("odd", (Track("1", times, np.column_stack([times, times])),))
    write_crowd(tmp_path / "a.csv", crowd, FROM)
    for suffix in (".txt", ".sqlite"):
        with pytest.raises(WritingError, match=r"samples are not 0\.4 s apart: give --hz"):
            write_crowd(tmp_path / f"a{suffix}", crowd, FROM)
    with pytest.raises(WritingError, match=r"ends in none of \.csv"):
        write_crowd(tmp_path / "a.doc", crowd, FROM)


def test_jupedsim_opens_the_sqlite(tmp_path: Path) -> None:
    recording = pytest.importorskip("jupedsim").Recording
    path = tmp_path / "a.sqlite"
    write_crowd(path, crowd_of((0, 6, 0.0), (2, 6, 1.0)), FROM)
    found = recording(str(path))
    assert found.num_frames == 8
    assert found.fps == 2.5
    assert [agent.id for agent in found.frame(3).agents] == [1, 2]
    assert found.frame(3).agents[0].position == pytest.approx((1.5, 1.0))
    with sqlite3.connect(path) as connection:
        told = dict(connection.execute("SELECT key, value FROM metadata"))
    assert told["esplanade.version"] == "0"
