import json
from pathlib import Path

import numpy as np
import pytest

from esplanade.planning import LayeredGrid
from esplanade.server import loading as staging
from esplanade.server.loading import DEFAULT_SCENE, LoadingError, load_scene
from esplanade.server.settings import ServerSettings
from tests.server.worlds import write_mesh_world

CROWD = "t,id,x,y\n0,a,0,0\n1,a,4,0\n0,b,2,3\n1,b,2,-3\n"


@pytest.fixture
def crowd_file(tmp_path: Path) -> Path:
    path = tmp_path / "square.csv"
    path.write_text(CROWD)
    return path


def test_a_scene_is_read_from_its_file(room_file: Path) -> None:
    loaded = load_scene(ServerSettings(scene=room_file))
    assert loaded.scene.name == "room"
    assert loaded.rules.person_clearance_m == 0.25


def test_without_a_scene_there_is_one_that_comes_along() -> None:
    loaded = load_scene(ServerSettings())
    assert DEFAULT_SCENE.is_file()
    assert len(loaded.scene.places) >= 4


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("{", ": is no JSON"),
        ('{"bounds": [0, 0, 1, "x"]}', ":1:22: bounds.3: "),
        (
            '{"bounds": [0, 0, 1, 1], "walls": [{"start": [0, 0], "end": [0, 0]}]}',
            ":1:36: walls.0: the",
        ),
        ('{"bounds": [5, 0, 1, 1]}', ":1:12: bounds: x0 < x1"),
    ],
)
def test_faults_in_a_scene_are_named_with_file_and_place(
    tmp_path: Path, text: str, fault: str
) -> None:
    path = tmp_path / "bad.json"
    path.write_text(text)
    with pytest.raises(LoadingError) as caught:
        load_scene(ServerSettings(scene=path))
    assert str(caught.value).startswith(f"{path}{fault}")


def test_a_crowd_gets_ground_that_fits_and_speed_enough(crowd_file: Path) -> None:
    loaded = load_scene(ServerSettings(crowd=crowd_file))
    assert loaded.scene.name == "square"
    assert loaded.scene.bounds == (-2.0, -5.0, 6.0, 5.0)
    assert loaded.rules.person_clearance_m == 0.0
    assert loaded.rules.person_max_speed_mps == pytest.approx(1.5 * 6.0)
    assert len(loaded.scene.places) == 8
    grid = LayeredGrid.from_scene(loaded.scene)
    for place in loaded.scene.places:
        assert grid.is_free([place.position], [0], 0.25)[0]


def test_walls_beside_a_crowd_are_built_and_opened_where_people_walk(crowd_file: Path) -> None:
    walls = {"segments": [[-1, 4, 5, 4], [1, -4, 1, 2]]}
    crowd_file.with_suffix(".walls.json").write_text(json.dumps(walls))
    loaded = load_scene(ServerSettings(crowd=crowd_file))
    assert len(loaded.scene.walls) == 3
    grid = LayeredGrid.from_scene(loaded.scene)
    ways = [((0.0, 0.0), (4.0, 0.0)), ((2.0, 3.0), (2.0, -3.0))]
    for start, end in ways:
        line = [(end[0] - start[0], end[1] - start[1])]
        reached, _ = grid.walk([start], [0], line, loaded.rules.person_clearance_m)
        assert tuple(reached[0]) == pytest.approx(end)


def test_walls_may_lie_elsewhere(crowd_file: Path, tmp_path: Path) -> None:
    path = tmp_path / "elsewhere.json"
    path.write_text('{"segments": [[-1, 4, 5, 4]]}')
    loaded = load_scene(ServerSettings(crowd=crowd_file, walls=path))
    assert len(loaded.scene.walls) == 1


@pytest.mark.parametrize(
    ("name", "text", "fault"),
    [
        ("square.csv", "t,id,x,y\n0,a,0,nowhere\n", "square.csv:2"),
        ("square.walls.json", '{"segments": [[1, 2]]}', "segments[0]"),
        ("square.csv", "t,id,x,y\n0,a,0,0\n600,a,900,0\n", "bounds: a side may measure"),
        ("square.csv", "t,id,x,y\n0,a,0,0\n1,a,900,0\n", "give --unit mm (0.9 m/s)"),
    ],
)
def test_faults_in_a_crowd_are_named(crowd_file: Path, name: str, text: str, fault: str) -> None:
    (crowd_file.parent / name).write_text(text)
    with pytest.raises(LoadingError) as caught:
        load_scene(ServerSettings(crowd=crowd_file))
    assert fault in str(caught.value)


def test_a_building_from_a_mesh_comes_with_its_triangles(tmp_path: Path) -> None:
    loaded = load_scene(ServerSettings(scene=write_mesh_world(tmp_path)))
    assert loaded.triangles is not None
    corners = np.frombuffer(loaded.triangles, dtype="<f4").reshape(-1, 3, 3)
    assert len(corners) == 4
    assert corners.reshape(-1, 3).min(axis=0) == pytest.approx((0.0, -10.0, 0.0))
    assert corners.reshape(-1, 3).max(axis=0) == pytest.approx((10.0, 0.0, 3.0))


def test_a_mesh_of_too_many_triangles_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(staging, "MAX_TRIANGLES", 3)
    with pytest.raises(LoadingError, match=r"house\.obj: it has 4 triangles, .* at most 3;"):
        load_scene(ServerSettings(scene=write_mesh_world(tmp_path)))


def test_a_file_that_is_no_mesh_is_refused(tmp_path: Path) -> None:
    path = write_mesh_world(tmp_path)
    (tmp_path / "house.obj").write_text("v 0 0 0\n")
    with pytest.raises(LoadingError, match=r"house\.obj: it holds no triangles"):
        load_scene(ServerSettings(scene=path))


def test_glitches_make_nobody_faster(crowd_file: Path) -> None:
    rows = "".join(f"{0.4 * n:.1f},a,{60 if n == 2 else 0.5 * n},0\n" for n in range(4))
    crowd_file.write_text("t,id,x,y\n" + rows)
    assert load_scene(ServerSettings(crowd=crowd_file)).rules.person_max_speed_mps == 3.0
    with pytest.raises(LoadingError, match=r":4: pedestrian 'a' jumps to \(60, 0\)"):
        load_scene(ServerSettings(crowd=crowd_file, strict=True))


def test_what_a_crowd_does_not_say_is_given(crowd_file: Path) -> None:
    crowd_file.write_text("# id frame x y z\n1 0 0 0 0\n1 1 7.8 0 0\n1 2 15.6 0 0\n")
    with pytest.raises(LoadingError, match="give --fps"):
        load_scene(ServerSettings(crowd=crowd_file))
    loaded = load_scene(ServerSettings(crowd=crowd_file, fps=16.0, unit="cm"))
    assert loaded.scene.bounds[2] == pytest.approx(0.156 + 2.0)
