"""ETH's obsmat.txt and TrajNet++ ndjson: the samples, and the errors for broken files."""

import json
from pathlib import Path

import numpy as np
import pytest

from esplanade.recordings import RecordingError, read_crowd

OBSMAT = (
    "7.8e+02 1.0e+00 8.4 0 3.5 1.6 0 0.1\n7.86e+02 1.0 9.0 0 3.6 1.6 0 0.1\n\n780 2 0 0 1 0 0 0\n"
)
SCENE = {"scene": {"id": 0, "p": 7, "s": 100, "e": 112, "fps": 2.5, "tag": 2}}


def track(f: float, p: int, x: float, y: float, **more: int) -> dict[str, object]:
    return {"track": {"f": f, "p": p, "x": x, "y": y, **more}}


def write(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text)
    return path


def ndjson(folder: Path, *lines: object) -> Path:
    return write(folder, "plaza.ndjson", "".join(json.dumps(line) + "\n" for line in lines))


def test_obsmat_counts_frames_and_leaves_out_the_height(tmp_path: Path) -> None:
    folder = tmp_path / "seq_hotel"
    folder.mkdir()
    crowd = read_crowd(write(folder, "obsmat.txt", OBSMAT))
    assert crowd.name == "seq_hotel"
    assert [track.id for track in crowd.tracks] == ["1", "2"]
    np.testing.assert_allclose(crowd.tracks[0].times, [52.0, 52.4])
    np.testing.assert_allclose(crowd.tracks[0].positions, [[8.4, 3.5], [9.0, 3.6]])


def test_obsmat_at_another_rate(tmp_path: Path) -> None:
    crowd = read_crowd(write(tmp_path, "obsmat.txt", OBSMAT), fps=25.0)
    np.testing.assert_allclose(crowd.tracks[0].times, [31.2, 31.44])


@pytest.mark.parametrize(
    ("text", "line", "fault"),
    [
        ("1 2 3\n", 1, "expected at least 4 columns (frame id x y, id frame x y z, ETH's eight"),
        (OBSMAT + "1 a 0 0 0 0 0 0\n", 5, "id is 'a', expected a number"),
        ("1 1.5 0 0 0 0 0 0\n", 1, "id is 1.5, expected a whole number"),
        ("1 nan 0 0 0 0 0 0\n", 1, "id is nan, expected a whole number"),
        ("1 1 0 0 nan 0 0 0\n", 1, "y is nan, expected a finite number"),
        ("\n", None, "is empty"),
        ("1 1 0 0 0 0 0 0\n2 1 0 0\n", 2, "expected 8 columns frame id x z y vx vz vy, not 4"),
    ],
)
def test_faults_of_obsmat(tmp_path: Path, text: str, line: int | None, fault: str) -> None:
    with pytest.raises(RecordingError) as caught:
        read_crowd(write(tmp_path, "obsmat.txt", text))
    assert fault in str(caught.value)
    assert caught.value.line == line


def test_ndjson_takes_time_from_scenes_and_the_distance_of_frames(tmp_path: Path) -> None:
    path = ndjson(
        tmp_path, SCENE, track(112, 7, 2, 0), track(100, 7, 0, 0), track(106, 7, 1, 0),
        track(100, 3, 5, 5), track(100, 7, 0, 0), track(112, 7, 9, 9, prediction_number=0),
    )  # fmt: skip
    crowd = read_crowd(path)
    assert [track.id for track in crowd.tracks] == ["7", "3"]
    seven = crowd.tracks[0]
    np.testing.assert_allclose(np.diff(seven.times), [0.4, 0.4])
    np.testing.assert_allclose(seven.positions, [[0, 0], [1, 0], [2, 0]])


def test_ndjson_at_a_given_rate_of_frame_numbers(tmp_path: Path) -> None:
    path = ndjson(tmp_path, SCENE, track(100, 7, 0, 0), track(106, 7, 1, 0))
    np.testing.assert_allclose(read_crowd(path, fps=30.0).tracks[0].times, [100 / 30, 106 / 30])


def test_ndjson_without_scenes_has_five_samples_in_two_seconds(tmp_path: Path) -> None:
    crowd = read_crowd(ndjson(tmp_path, track(0, 1, 0, 0), track(10, 1, 1, 0)))
    np.testing.assert_allclose(crowd.tracks[0].times, [0.0, 0.4])


@pytest.mark.parametrize(
    ("lines", "line", "fault"),
    [
        ([SCENE, {"scenes": {}}], 2, 'expected {"scene": {...}} or {"track": {...}}'),
        ([[1]], 1, "expected"),
        ([track(0.5, 1, 0, 0)], 1, "f is 0.5, expected a whole number"),
        ([{"track": {"f": 1, "p": 1, "x": 0}}], 1, "y is None, expected a number"),
        ([{"track": {"f": 1, "p": "a", "x": 0, "y": 0}}], 1, "p is 'a', expected a whole number"),
        ([{"track": {"f": 10**400, "p": 1, "x": 0, "y": 0}}], 1, "f is out of range"),
        ([{"scene": {"fps": 0}}], 1, "fps is 0, expected more than 0"),
        ([SCENE, {"scene": {"fps": 5}}], 2, "fps is 5, but 2.5 in a scene before"),
        ([track(6, 1, 0, 0), track(6, 1, 1, 1)], 2, "'1' is already at t=2.4 in line 1"),
        ([SCENE], None, "holds no samples"),
    ],
)
def test_faults_of_ndjson(
    tmp_path: Path, lines: list[object], line: int | None, fault: str
) -> None:
    with pytest.raises(RecordingError) as caught:
        read_crowd(ndjson(tmp_path, *lines))
    assert fault in str(caught.value)
    assert caught.value.line == line


@pytest.mark.parametrize("text", ["{", "not json", "[" * 100_000, '{"track": {"f": NaN}}'])
def test_lines_that_are_no_json(tmp_path: Path, text: str) -> None:
    with pytest.raises(RecordingError, match=":1: "):
        read_crowd(write(tmp_path, "plaza.ndjson", text + "\n"))


def test_digits_of_print_are_no_numbers(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("1\n2\n\N{SUPERSCRIPT THREE}00\n")
    with pytest.raises(RecordingError):
        read_crowd(path)
