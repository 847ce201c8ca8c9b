"""Reading walls, and finding them beside a recording."""

import math
from pathlib import Path

import pytest

from esplanade.recordings import RecordingError, read_obstacles, read_walls, walls_beside


def write(folder: Path, text: str) -> Path:
    path = folder / "square.walls.json"
    path.write_text(text)
    return path


def test_segments_are_walls(tmp_path: Path) -> None:
    path = write(tmp_path, '{"segments": [[0, 0, 1, 2], [1.5, -2, 3, 4]], "circles": []}')
    assert read_walls(path) == [((0.0, 0.0), (1.0, 2.0)), ((1.5, -2.0), (3.0, 4.0))]


def test_a_circle_is_a_closed_polygon_just_around_it(tmp_path: Path) -> None:
    walls = read_walls(write(tmp_path, '{"circles": [[3, 4, 0.5]]}'))
    assert len(walls) == 16
    for (start, end), (following, _) in zip(walls, walls[1:] + walls[:1], strict=True):
        assert end == following
        middle = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)
        assert math.dist(middle, (3, 4)) == pytest.approx(0.5)
        assert 0.5 < math.dist(start, (3, 4)) < 0.51


def test_obstacles_keep_circles_as_they_are(tmp_path: Path) -> None:
    text = '{"segments": [[0, 0, 1, 2]], "circles": [[3, 4, 0.5]]}'
    obstacles = read_obstacles(write(tmp_path, text))
    assert obstacles.segments == (((0.0, 0.0), (1.0, 2.0)),)
    assert obstacles.circles == ((3.0, 4.0, 0.5),)
    assert len(obstacles.as_walls()) == 17


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("", "is not JSON"),
        ("{", "is not JSON"),
        ("[]", "expected an object with segments and circles"),
        ('{"walls": []}', "unknown key 'walls'"),
        ('{"segments": {}}', "segments is no list"),
        ('{"segments": [[1, 2, 3]]}', "segments[0] is [1, 2, 3], expected [x1, y1, x2, y2]"),
        ('{"segments": [[0, 0, 1, 1], 7]}', "segments[1] is 7"),
        ('{"segments": [[1, 2, 3, "4"]]}', "segments[0] holds '4', expected numbers"),
        ('{"segments": [[1, 2, 3, true]]}', "segments[0] holds True, expected numbers"),
        ('{"segments": [[1, 2, 3, NaN]]}', "segments[0] holds nan"),
        ('{"circles": [[1, 2, 1e999]]}', "circles[0] holds inf"),
        ('{"circles": [[1, 2, ' + "9" * 5000 + "]]}", "holds a number out of range"),
        ('{"segments": [[1, 2, 1, 2]]}', "segments[0] has no length"),
        ('{"circles": [[1, 2, 0]]}', "circles[0] has radius 0"),
        ("[" * 100_000, "nested too deeply"),
    ],
)
def test_faults_name_the_file_and_the_place(tmp_path: Path, text: str, fault: str) -> None:
    path = write(tmp_path, text)
    with pytest.raises(RecordingError) as caught:
        read_walls(path)
    assert fault in str(caught.value)
    assert str(caught.value).startswith(str(path))


def test_walls_beside_a_recording(tmp_path: Path) -> None:
    crowd = tmp_path / "square.csv"
    assert walls_beside(crowd) is None
    path = write(tmp_path, "{}")
    assert walls_beside(crowd) == path
    assert walls_beside(str(crowd)) == path
    assert read_walls(path) == []


def test_missing_walls_are_told(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="cannot be read"):
        read_walls(tmp_path / "absent.walls.json")
