"""Reading crowds: the tracks, and the error for every kind of broken file."""

from pathlib import Path

import numpy as np
import pytest

from esplanade.recordings import RecordingError, read_crowd
from esplanade.recordings.errors import read_text
from tests.recordings.data import recorded

HEADER = "t,id,x,y\n"


def write(folder: Path, text: str | bytes, name: str = "square.csv") -> Path:
    path = folder / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def test_tracks_come_in_order_of_appearance(tmp_path: Path) -> None:
    path = write(tmp_path, HEADER + "1,ann,0,0\n1.5,bob,4,-2\n2,ann,1,0\n2.5,bob,4,3\n3,ann,1,2\n")
    crowd = read_crowd(path)
    assert crowd.name == "square"
    assert [track.id for track in crowd.tracks] == ["ann", "bob"]
    ann, bob = crowd.tracks
    np.testing.assert_array_equal(ann.times, [1, 2, 3])
    np.testing.assert_array_equal(ann.positions, [[0, 0], [1, 0], [1, 2]])
    assert (bob.start_s, bob.end_s) == (1.5, 2.5)
    assert (crowd.start_s, crowd.end_s, crowd.duration_s) == (1.0, 3.0, 2.0)
    assert crowd.bounds == (0.0, -2.0, 4.0, 3.0)
    assert crowd.max_present == 2


def test_speed_is_the_fastest_step(tmp_path: Path) -> None:
    crowd = read_crowd(write(tmp_path, HEADER + "0,a,0,0\n0.5,a,0,1\n2.5,a,3,5\n0,b,0,0\n"))
    assert crowd.tracks[0].max_speed_mps == pytest.approx(2.5)
    assert crowd.tracks[1].max_speed_mps == 0.0
    assert crowd.max_speed_mps == pytest.approx(2.5)


def test_position_between_samples_is_on_the_line_and_outside_at_the_ends(tmp_path: Path) -> None:
    (track,) = read_crowd(write(tmp_path, HEADER + "0,a,0,0\n2,a,4,2\n")).tracks
    assert track.at(0.5) == pytest.approx((1.0, 0.5))
    assert track.at(-1.0) == (0.0, 0.0)
    assert track.at(9.0) == (4.0, 2.0)


def test_a_single_sample_is_a_track_without_duration(tmp_path: Path) -> None:
    (track,) = read_crowd(write(tmp_path, HEADER + "7,a,1,2\n")).tracks
    assert (track.start_s, track.end_s, track.max_speed_mps) == (7.0, 7.0, 0.0)
    assert track.at(100.0) == (1.0, 2.0)


def test_people_who_leave_before_others_come_are_not_counted_together(tmp_path: Path) -> None:
    crowd = read_crowd(write(tmp_path, HEADER + "0,a,0,0\n1,a,0,1\n2,b,0,0\n3,b,0,1\n"))
    assert crowd.max_present == 1


def test_samples_cannot_be_written(tmp_path: Path) -> None:
    (track,) = read_crowd(write(tmp_path, HEADER + "0,a,0,0\n")).tracks
    with pytest.raises(ValueError, match="read-only"):
        track.positions[0, 0] = 1.0


def test_byte_order_mark_windows_lines_and_blank_lines_are_fine(tmp_path: Path) -> None:
    path = write(tmp_path, b"\xef\xbb\xbft, id, x, y\r\n0, a, 1, 2\r\n\r\n1, a, 2, 2\r\n")
    (track,) = read_crowd(path).tracks
    np.testing.assert_array_equal(track.times, [0, 1])


@pytest.mark.parametrize(
    ("text", "line", "fault"),
    [
        ("", None, "is empty, expected the header"),
        ("0,a,1,2\n", 1, "expected the header t,id,x,y"),
        (HEADER, None, "holds no samples"),
        (HEADER + "0,a,1\n", 2, "expected 4 columns t,id,x,y, not 3"),
        (HEADER + "0,a,1,2,3\n", 2, "expected 4 columns"),
        (HEADER + "0,a,1,2\n1,a,north,2\n", 3, "x is 'north', expected a number"),
        (HEADER + "0,,1,2\n", 2, "expected a pedestrian's id"),
        (HEADER + "0,a,nan,2\n", 2, "x is nan, expected a finite number"),
        (HEADER + "0,a,1,-inf\n", 2, "y is -inf, expected a finite number"),
        (HEADER + "inf,a,1,2\n", 2, "t is inf, expected a finite number"),
        (HEADER + "0,a,1e300,2\n", 2, "x is 1e+300, expected at most 100000"),
        (HEADER + "0,a,1,2\n\n0,a,1,3\n", 4, "'a' is already at t=0 in line 2, elsewhere"),
        (HEADER + "0,a,1,2\n1_0,a,1,2\n", 3, "t is '1_0', expected a number"),
        (HEADER + "0,nan,1,2\n", 2, "id is nan, expected the id of a pedestrian"),
    ],
)
def test_faults_name_file_line_and_expectation(
    tmp_path: Path, text: str, line: int | None, fault: str
) -> None:
    path = write(tmp_path, text)
    with pytest.raises(RecordingError) as caught:
        read_crowd(path)
    assert fault in caught.value.text
    assert caught.value.line == line
    assert str(caught.value).startswith(f"{path}:{line}: " if line else f"{path}: ")


@pytest.mark.parametrize(
    ("name", "content", "fault"),
    [
        ("crowd.csv", b"t,id,x,y\n0,\xff,1,2\x01", "is not UTF-8 text (byte 11, line 2)"),
        ("crowd.csv", b"PK\x03\x04", "is a ZIP archive or a spreadsheet: unpack it, or save it"),
        ("crowd.csv", b"<frame/>", "is XML with the root <frame> and without people"),
        ("crowd.csv", b"\x1f\x8b\x08", "its gzip is damaged"),
        ("crowd.txt", b"one\n", "none of 'one' is time or frame or id or x or y"),
        ("crowd.csv", b"\x00\x01\x02", "is no text, but bytes"),
    ],
)
def test_files_of_another_kind(tmp_path: Path, name: str, content: bytes, fault: str) -> None:
    with pytest.raises(RecordingError) as caught:
        read_crowd(write(tmp_path, content, name))
    assert fault in str(caught.value)


@pytest.mark.parametrize("name", ["missing.csv", "."])
def test_files_that_cannot_be_read_are_refused(tmp_path: Path, name: str) -> None:
    folder = tmp_path / "folder.csv"
    folder.mkdir()
    path = folder if name == "." else tmp_path / name
    with pytest.raises(RecordingError, match="cannot be read"):
        read_crowd(path)


@pytest.mark.parametrize(
    ("name", "people", "duration_s", "max_present", "max_speed_mps"),
    [
        ("eth", 360, 773.4, 27, 4.593),
        ("hotel", 390, 722.4, 18, 2.555),
        ("zara1", 148, 360.4, 20, 2.653),
        ("students3", 428, 215.6, 62, 2.840),
    ],
)
def test_recorded_crowds(
    name: str, people: int, duration_s: float, max_present: int, max_speed_mps: float
) -> None:
    crowd = read_crowd(recorded(name))
    assert len(crowd.tracks) == people
    assert crowd.duration_s == pytest.approx(duration_s)
    assert crowd.max_present == max_present
    assert crowd.max_speed_mps == pytest.approx(max_speed_mps, abs=1e-3)


def test_a_device_without_an_end_is_refused() -> None:
    with pytest.raises(RecordingError, match="has more than 128 MiB, the most that is read"):
        read_text(Path("/dev/zero"))
