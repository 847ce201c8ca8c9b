"""Scenes: what is accepted, and that every fault is named with its place."""

import json
import math

import pytest
from pydantic import ValidationError

from esplanade.planning import Place, Polygon, Scene

BOUNDS = [0.0, 0.0, 20.0, 10.0]
SQUARE = [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]]


def read(**parts) -> Scene:
    return Scene.model_validate_json(json.dumps({"bounds": BOUNDS, **parts}))


def test_a_spawn_names_what_is_seen_first_there() -> None:
    scene = read(spawns=[{"position": [10.0, 5.0], "view": [12.0, 5.0]}, {"position": [1.0, 5.0]}])
    assert [spawn.view for spawn in scene.spawns] == [(12.0, 5.0), None]
    with pytest.raises(ValidationError, match=r"spawns\.0: \(25, 5\) lies outside the bounds"):
        read(spawns=[{"position": [10.0, 5.0], "view": [25.0, 5.0]}])


def test_a_whole_scene_is_read() -> None:
    scene = read(
        name="square",
        polygons=[{"points": SQUARE, "height_m": 4.0, "kind": "building", "name": "hall"}],
        walls=[{"start": [5.0, 1.0], "end": [5.0, 4.0]}],
        spawns=[{"position": [10.0, 5.0]}],
        places=[{"name": " gate ", "position": [12.0, 5.0]}],
    )
    assert scene.place("gate") == Place(name="gate", position=(12.0, 5.0))
    assert scene.walls[0].height_m == 2.5
    assert scene.polygons[0].points[2] == (3.0, 3.0)
    assert Scene.model_validate_json(scene.model_dump_json()) == scene


def test_open_space_is_bounds_and_walls() -> None:
    block = Polygon(points=((1.0, 1.0), (2.0, 1.0), (2.0, 2.0)), height_m=1.0)
    scene = Scene.open_space((0.0, 0.0, 9.0, 9.0), walls=[((1, 5), (4, 5))], polygons=[block])
    assert (scene.walls[0].start, scene.walls[0].end) == ((1.0, 5.0), (4.0, 5.0))
    assert scene.polygons == (block,)


def test_stairs_are_solid_treads_of_even_height() -> None:
    flight = {"start": [1, 5], "end": [4, 5], "width_m": 2, "bottom_m": 1, "top_m": 2.5}
    scene = read(polygons=[{"points": SQUARE, "height_m": 1}], stairs=[flight | {"steps": 3}])
    house, *treads = scene.solids()
    assert house == scene.polygons[0]
    assert [tread.offset_m for tread in treads] == [1.0] * 3
    assert [tread.top_at(2.0, 5.0) for tread in treads] == pytest.approx([1.5, 2.0, 2.5])
    assert set(treads[0].points) == {(1.0, 4.0), (2.0, 4.0), (2.0, 6.0), (1.0, 6.0)}
    for tread in treads:
        assert Polygon.model_validate(tread.model_dump()) == tread


def test_ramps_rise_from_start_to_end_and_no_further() -> None:
    ramp = {"start": [1, 0], "end": [3, 0], "start_height_m": 0.5}
    scene = read(polygons=[{"points": SQUARE, "offset_m": 1, "height_m": 1.5, "ramp": ramp}])
    tops = [scene.polygons[0].top_at(x, 2.0) for x in (0.0, 1.0, 2.0, 3.0, 4.0)]
    assert tops == pytest.approx([1.5, 1.5, 2.0, 2.5, 2.5])


def test_an_unknown_place_is_answered_with_those_there_are() -> None:
    with pytest.raises(KeyError, match=r"no place named 'moon'; the scene has: gate, stage"):
        read(
            places=[
                {"name": "gate", "position": [1.0, 1.0]},
                {"name": "stage", "position": [2.0, 1.0]},
            ]
        ).place("moon")
    with pytest.raises(KeyError, match="the scene has: none"):
        read().place("moon")


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ({"bounds": [5.0, 0.0, 5.0, 10.0]}, "x0 < x1"),
        ({"bounds": [0.0, 0.0, 700.0, 10.0]}, "a side may measure 650 m"),
        ({"bounds": [0.0, 0.0, math.nan, 10.0]}, "bounds"),
        ({"colour": "red"}, "colour"),
        ({"polygons": [{"points": SQUARE[:2], "height_m": 1.0}]}, "polygons.0.points"),
        ({"polygons": [{"points": [[0, 0], [1, 1], [2, 2]], "height_m": 1.0}]}, "no area"),
        (
            {"polygons": [{"points": [[0, 0], [2, 2], [2, 0], [0, 3]], "height_m": 1.0}]},
            "edge 0 meets edge 2",
        ),
        (
            {"polygons": [{"points": [[0, 0], [4, 0], [2, 0], [2, 3]], "height_m": 1.0}]},
            "crosses itself",
        ),
        ({"polygons": [{"points": SQUARE, "height_m": 0.0}]}, "height_m"),
        ({"polygons": [{"points": SQUARE, "height_m": 1.0, "kind": "cloud"}]}, "kind"),
        ({"walls": [{"start": [1.0, 1.0], "end": [1.0, 1.0]}]}, "the wall has no length"),
        (
            {"stairs": [{"start": [1, 1], "end": [3, 1], "width_m": 1, "top_m": 0.0, "steps": 3}]},
            "stairs.0.top_m",
        ),
        (
            {
                "stairs": [
                    {"start": [1, 1], "end": [3, 1], "width_m": 1, "bottom_m": 2, "top_m": 1}
                    | {"steps": 3}
                ]
            },
            "the stairs end no higher than they begin",
        ),
        (
            {"doors": [{"name": "a", "start": [1, 1], "end": [1, 1]}]},
            "the door has no length",
        ),
        (
            {"doors": [{"name": "a", "start": [1, 1], "end": [2, k]} for k in (1, 2)]},
            "doors.1: the name 'a' is taken",
        ),
        (
            {
                "polygons": [
                    {"points": SQUARE, "height_m": 1, "ramp": {"start": [1, 1], "end": [1, 1]}}
                ]
            },
            "the ramp has no length",
        ),
        ({"spawns": [{"position": [50.0, 1.0]}]}, r"spawns.0: \(50, 1\) lies outside"),
        ({"spawns": [{"position": [5.0, 1.0], "layer": 1}]}, "spawns.0.layer"),
        ({"places": [{"name": "a", "position": [-1.0, 1.0]}]}, "places.0"),
        ({"places": [{"name": " ", "position": [1.0, 1.0]}]}, "places.0.name"),
        (
            {"places": [{"name": "a", "position": [1, 1]}, {"name": "a", "position": [2, 2]}]},
            "places.1: the name 'a' is taken",
        ),
    ],
)
def test_faults_are_named(parts, message) -> None:
    with pytest.raises(ValidationError, match=message):
        read(**parts)


def test_a_scene_does_not_change() -> None:
    with pytest.raises(ValidationError, match="frozen"):
        read().name = "other"
