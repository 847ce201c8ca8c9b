"""Scene files: what is read, and the words in which faults are told."""

import json
import math
from pathlib import Path
from typing import Any

import pytest

from esplanade.planning.scene.bounded_reading import TooLargeError
from esplanade.planning.scene.scene_file import MAX_FILE_BYTES, SceneError, read_scene

TRIANGLE = [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0]]


def write(folder: Path, **parts: Any) -> Path:
    path = folder / "scene.json"
    path.write_text(json.dumps({"bounds": [0.0, 0.0, 20.0, 10.0], **parts}))
    return path


def faults(path: Path) -> list[str]:
    with pytest.raises(SceneError) as caught:
        read_scene(path)
    error = caught.value
    lines = [
        f"{path}:{spot[0]}:{spot[1]}: {fault}" if spot else f"{path}: {fault}"
        for fault, spot in zip(error.faults, error.spots, strict=True)
    ]
    assert str(error).splitlines() == lines
    return list(caught.value.faults)


def test_a_scene_is_read(tmp_path: Path) -> None:
    path = write(tmp_path, name="Yard", polygons=[{"points": TRIANGLE, "height_m": 2.0}])
    scene = read_scene(path)
    assert scene.name == "Yard"
    assert scene.polygons[0].height_m == 2.0


@pytest.mark.parametrize(
    ("parts", "fault"),
    [
        (
            {"polygons": [{"points": TRIANGLE, "height_m": -1}]},
            "polygons.0.height_m: must be > 0, got -1",
        ),
        (
            {"polygons": [{"points": TRIANGLE, "height_m": 501}]},
            "polygons.0.height_m: must be <= 500, got 501",
        ),
        (
            {"polygons": [{"points": TRIANGLE[:2], "height_m": 1}]},
            "polygons.0.points: needs at least 3 of them, got 2",
        ),
        ({"walls": [{"start": [1, 1]}]}, "walls.0.end: is missing"),
        ({"colour": "red"}, "colour: there is no such key"),
        ({"bounds": None}, "bounds: must be a list"),
        ({"spawns": [{"position": [50, 1]}]}, "spawns.0: (50, 1) lies outside the bounds"),
        (
            {"places": [{"name": "gate", "position": [1, "a"]}]},
            "places.0.position.1: must be a number, got 'a'",
        ),
        ({"places": [{"name": " ", "position": [1, 1]}]}, "places.0.name: must not be empty"),
    ],
)
def test_a_fault_is_told_with_its_place(tmp_path: Path, parts: Any, fault: str) -> None:
    assert faults(write(tmp_path, **parts)) == [fault]


def test_all_faults_are_told_at_once(tmp_path: Path) -> None:
    path = write(tmp_path, colour="red", polygons=[{"points": TRIANGLE, "height_m": 0}])
    assert len(faults(path)) == 2


def test_faults_of_parts_and_of_how_they_fit_are_told_together(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.write_text(
        """{
  "bounds": [0, 0, 20, 10],
  "walls": [{"start": [1, 1]}],
  "spawns": [
    {"position": [1, "a"]},
    {"position": [50, 1]}
  ],
  "places": [
    {"name": "gate", "position": [1, 1]},
    {"name": "gate", "position": [2, 99]}
  ]
}"""
    )
    with pytest.raises(SceneError) as caught:
        read_scene(path)
    assert str(caught.value).splitlines() == [
        f"{path}:3:13: walls.0.end: is missing",
        f"{path}:5:22: spawns.0.position.1: must be a number, got 'a'",
        f"{path}:6:5: spawns.1: (50, 1) lies outside the bounds",
        f"{path}:10:5: places.1: (2, 99) lies outside the bounds",
        f"{path}:10:5: places.1: the name 'gate' is taken",
    ]


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le"])
def test_a_scene_is_read_in_any_unicode(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "scene.json"
    path.write_text('{"name": "Öde", "bounds": [0, 0, 20, 10]}', encoding=encoding)
    assert read_scene(path).name == "Öde"


def test_a_scene_that_is_no_unicode_is_refused_with_the_line(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.write_bytes(b'{"bounds": [0, 0, 20, 10],\n"name": "caf\xe9"}')
    assert "is not UTF-8 text (byte 39, line 2)" in faults(path)[0]


RING = [[2, 2], [6, 2], [6, 6], [2, 6]]


@pytest.mark.parametrize(
    "points",
    [
        [*RING, RING[0]],
        [*RING, RING[0], RING[0]],
        [RING[0], *RING],
        [RING[0], RING[1], RING[1], RING[1], *RING[2:], RING[0]],
        [*RING, [2 + 1e-12, 2]],
    ],
)
def test_a_ring_that_repeats_points_is_a_ring(tmp_path: Path, points: Any) -> None:
    path = write(tmp_path, polygons=[{"points": points, "height_m": 1.0}])
    assert read_scene(path).polygons[0].points == tuple(map(tuple, RING))


def test_a_ring_of_one_point_is_none(tmp_path: Path) -> None:
    path = write(tmp_path, polygons=[{"points": [[1, 1]] * 5, "height_m": 1.0}])
    assert faults(path) == ["polygons.0.points: the polygon has no area"]


def test_what_is_no_json_is_told_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.write_text('{\n  "bounds": [0, 0, 20')
    (fault,) = faults(path)
    assert fault.startswith("is no JSON: ")
    assert "line 2" in fault


def test_a_mesh_lies_beside_the_file(tmp_path: Path) -> None:
    mesh = tmp_path / "hall.glb"
    path = write(tmp_path, mesh=mesh.name)
    assert faults(path) == [f"mesh: there is no file {mesh}"]
    mesh.touch()
    assert read_scene(path).mesh == mesh


def test_a_scene_of_a_mesh_has_no_parts_of_its_own(tmp_path: Path) -> None:
    path = write(tmp_path, mesh="hall.glb", walls=[{"start": [1, 1], "end": [2, 2]}])
    assert faults(path) == ["walls: a scene of a mesh has none"]


def test_a_file_that_is_not_there_is_an_error_of_the_system(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        read_scene(tmp_path / "none.json")


def ring(corners: int) -> list[tuple[float, float]]:
    turns = [2.0 * math.pi * k / corners for k in range(corners)]
    return [(50.0 + 20.0 * math.cos(turn), 50.0 + 20.0 * math.sin(turn)) for turn in turns]


@pytest.mark.parametrize(
    ("parts", "fault"),
    [
        (
            {"polygons": [{"points": ring(20_000), "height_m": 1.0}]},
            "polygons.0.points: must have at most 1000 of them",
        ),
        (
            {"polygons": [{"points": ring(1_000), "height_m": 1.0}] * 101},
            "polygons: they have 101000 corners in all, 100000 are possible",
        ),
        (
            {
                "stairs": [{"start": (1, 1), "end": (9, 1), "width_m": 1, "top_m": 9, "steps": 500}]
                * 61
            },
            "there are 30500 polygons and treads of stairs, 30000 are possible",
        ),
        (
            {"spawns": [{"position": (1, 1)}] * 2_001},
            "spawns: must have at most 2000 of them",
        ),
        ({"name": "a\x1b[31m"}, "name: character 2 is U+001B, a control character"),
        (
            {"places": [{"name": "x\u202ey", "position": (1, 1)}]},
            "places.0.name: character 2 is U+202E, a control character",
        ),
    ],
)
def test_sizes_and_names_are_bounded(tmp_path: Path, parts: Any, fault: str) -> None:
    bounds = (0.0, 0.0, 100.0, 100.0)
    assert faults(write(tmp_path, bounds=bounds, **parts)) == [fault]


def test_a_file_is_read_no_further_than_its_bound(tmp_path: Path) -> None:
    large = tmp_path / "zeros.json"
    large.write_text('{"bounds": [' + "0," * (MAX_FILE_BYTES // 2) + "0]}")
    for endless in (large, Path("/dev/zero")):
        with pytest.raises(TooLargeError, match="more than 16 MiB"):
            read_scene(endless)
