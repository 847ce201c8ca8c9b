"""World files: what is read, and the words in which faults are told."""

import json
from pathlib import Path
from typing import Any

import pytest

from esplanade.planning.scene.world_file import MAX_ZONES, WorldError, read_world

GATE = {"name": "gate", "points": [[8, 4], [9, 4], [9, 6], [8, 6]], "arrival": [7, 5]}
DOOR = {"name": "door", "points": [[1, 4], [2, 4], [2, 6], [1, 6]]}
YARDS = {"name": "yard", "scene": "yard.json", "people": 9, "copies": 8}
EXITS = [
    {"from": {"zone": "yard", "portal": "gate"}, "to": {"zone": "hall", "portal": "door"}},
    {"from": {"zone": "hall", "portal": "door"}, "to": {"zone": "yard", "portal": "gate"}},
]


def write_scene(folder: Path, name: str, *portals: dict[str, Any]) -> None:
    scene = {"name": name, "bounds": [0, 0, 10, 10], "portals": portals}
    (folder / f"{name}.json").write_text(json.dumps(scene))


def write(folder: Path, **parts: Any) -> Path:
    """A world of a yard and a hall, with some parts replaced."""
    write_scene(folder, "yard", GATE)
    write_scene(folder, "hall", DOOR)
    zones = [{"name": "yard", "scene": "yard.json"}, {"name": "hall", "scene": "hall.json"}]
    path = folder / "town.json"
    path.write_text(json.dumps({"name": "Town", "zones": zones, "exits": EXITS, **parts}))
    return path


def faults(path: Path) -> list[str]:
    with pytest.raises(WorldError) as caught:
        read_world(path)
    assert len(str(caught.value).splitlines()) == len(caught.value.faults)
    assert all(line.startswith(f"{path}:") for line in str(caught.value).splitlines())
    return list(caught.value.faults)


def test_a_world_is_read_with_its_scenes(tmp_path: Path) -> None:
    world = read_world(write(tmp_path))
    assert world.file.name == "Town"
    assert world.file.start_zone == "yard"
    assert world.scenes["hall"].name == "hall"
    assert [zone.actors for zone in world.file.zones] == [None, None]
    zone, portal = world.exits("yard")["gate"]
    assert (zone, portal.name) == ("hall", "door")
    assert world.exits_of_actors("yard") == frozenset()
    assert world.arrivals("yard") == [(7.0, 5.0, 0.0)]
    assert world.arrivals("hall") == [(1.5, 5.0, 0.0)]


def test_the_zone_to_enter_can_be_another_than_the_first(tmp_path: Path) -> None:
    assert read_world(write(tmp_path, start="hall")).file.start_zone == "hall"


def test_copies_are_zones_with_the_scene_and_the_exits_of_the_first(tmp_path: Path) -> None:
    zones = [
        {"name": "yard", "scene": "yard.json"},
        {"name": "hall", "scene": "hall.json", "people": 40, "copies": 3},
    ]
    world = read_world(write(tmp_path, zones=zones))
    assert [zone.name for zone in world.file.entries] == ["yard", "hall", "hall-2", "hall-3"]
    assert {zone.people for zone in world.file.entries[1:]} == {40}
    assert world.scenes["hall-3"] == world.scenes["hall"]
    assert world.paths["hall-3"] == world.paths["hall"]
    assert world.exits("hall-2") == world.exits("hall")
    assert world.arrivals("hall-2") == world.arrivals("hall") != []
    assert world.exits("yard")["gate"][0] == "hall"


def exits(**changes: Any) -> list[dict[str, Any]]:
    """The exits, the first with another `from` or `to`."""
    first: dict[str, Any] = {
        end: {**EXITS[0][end], **changes.get(end, {})} for end in ("from", "to")
    }
    return [first, EXITS[1]]


@pytest.mark.parametrize(
    ("parts", "fault"),
    [
        (
            {"exits": exits(to={"zone": "hal"})},
            "exits.0.to.zone: there is no zone 'hal'; the world has: hall, yard",
        ),
        (
            {"exits": exits(to={"portal": "window"})},
            "exits.0.to.portal: zone 'hall': no portal named 'window'; the scene has: door",
        ),
        ({"exits": EXITS[:1]}, "zones.1: portal 'door' of 'hall' leads nowhere"),
        (
            {"exits": [*EXITS, EXITS[0]]},
            "exits.2.from: portal 'gate' of zone 'yard' leads somewhere already",
        ),
        (
            {"exits": exits(to={"zone": "yard", "portal": "gate"})},
            "exits.0: portal 'gate' of zone 'yard' leads to itself",
        ),
        ({"start": "moon"}, "start: there is no zone 'moon'; the world has: hall, yard"),
        ({"zones": []}, "zones: needs at least 1 of them, got 0"),
        (
            {"zones": [{"name": "yard", "scene": "yard.json"}] * (MAX_ZONES + 1)},
            f"zones: must have at most {MAX_ZONES} of them",
        ),
        (
            {"zones": [{"name": "yard", "scene": "yard.json"}] * 2, "exits": []},
            "zones.1.name: the name 'yard' is taken",
        ),
        (
            {"zones": [{"name": "yard", "scene": "yard.json", "copies": 2}], "exits": []},
            "zones.0.copies: zone 'yard' needs people: the most in each copy",
        ),
        (
            {"zones": [YARDS, {"name": "yard-2", "scene": "hall.json"}], "exits": []},
            "zones.0.copies: a copy of 'yard' has the name 'yard-2', which is that of another zone",
        ),
        (
            {"zones": [YARDS | {"name": "y" * 31}], "exits": []},
            f"zones.0.copies: '{'y' * 31}-2', the name of a copy, has more than 32 characters",
        ),
        (
            {"zones": [YARDS | {"name": name} for name in "abc"], "exits": []},
            f"zones: 24 with all copies, there may be {MAX_ZONES}",
        ),
        (
            {"zones": [{"name": "The Yard", "scene": "yard.json"}], "exits": []},
            "zones.0.name: must match ^[a-z0-9][a-z0-9-]{0,31}$, got 'The Yard'",
        ),
        ({"zones": [{"name": "yard"}], "exits": []}, "zones.0.scene: is missing"),
        ({"portals": []}, "portals: there is no such key"),
    ],
)
def test_faults_are_told_by_their_names(tmp_path: Path, parts: Any, fault: str) -> None:
    assert fault in faults(write(tmp_path, **parts))


def test_a_scene_that_is_missing_is_named(tmp_path: Path) -> None:
    path = write(tmp_path)
    (tmp_path / "hall.json").unlink()
    (fault,) = faults(path)
    assert fault.startswith(f"zones.1.scene: {tmp_path / 'hall.json'} cannot be read: No such file")


def test_faults_of_a_scene_have_its_file_and_place(tmp_path: Path) -> None:
    path = write(tmp_path)
    write_scene(tmp_path, "hall", DOOR, {**DOOR, "arrival": [70, 1]})
    told = faults(path)
    assert any("hall.json:1:" in fault and "(70, 1) lies outside" in fault for fault in told)
    assert any("the name 'door' is taken" in fault for fault in told)


def test_a_fault_has_its_line(tmp_path: Path) -> None:
    path = write(tmp_path)
    path.write_text(json.dumps(json.loads(path.read_text()) | {"start": "moon"}, indent=1))
    with pytest.raises(WorldError, match=rf"{path}:\d+:\d+: start: there is no zone 'moon'"):
        read_world(path)


@pytest.mark.parametrize("text", ["", "[1", "\x00", "{}"])
def test_a_file_that_holds_no_world_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "town.json"
    path.write_text(text)
    assert faults(path)
