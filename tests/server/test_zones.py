"""Several zones in one server: what is read, what is refused, and who is where."""

import json
from pathlib import Path

import pytest

from esplanade.server.app import running
from esplanade.server.loading import LoadingError
from esplanade.server.settings import ServerSettings
from esplanade.server.zones import zones_to_serve
from tests.server.client import joined
from tests.server.conftest import NO_CLIENT, Serving
from tests.server.http import get
from tests.server.zones import HALL, YARD, until, write_town


def test_newcomers_enter_the_first_of_the_zones(tmp_path: Path) -> None:
    settings = ServerSettings(world=write_town(tmp_path, actors=3, people=7), max_clients=50)
    yard, hall = zones_to_serve(settings)
    assert (yard.name, hall.name) == ("yard", "hall")
    assert (yard.settings.actors, hall.settings.actors) == (settings.actors, 3)
    assert (yard.settings.max_clients, hall.settings.max_clients) == (50, 7)
    assert hall.loaded.roster is not None
    assert len(hall.loaded.roster.actors) == 3
    zone, portal = yard.exits["gate"]
    assert (zone, portal.name) == ("hall", "door")


def test_a_scene_alone_is_the_whole_world(room_file: Path) -> None:
    (zone,) = zones_to_serve(ServerSettings(scene=room_file))
    assert (zone.name, dict(zone.exits)) == ("", {})


@pytest.mark.parametrize("other", ["scene", "crowd", "roster"])
def test_what_a_world_of_several_zones_cannot_have_is_refused(tmp_path: Path, other: str) -> None:
    path = tmp_path / ("x.csv" if other == "trajectories" else "x.json")
    with pytest.raises(ValueError, match=f"world and {other}: "):
        ServerSettings(world=write_town(tmp_path), **{other: path})


def test_a_world_that_is_at_fault_is_refused_by_name(tmp_path: Path) -> None:
    path = write_town(tmp_path)
    path.write_text(path.read_text().replace('"door"', '"window"'))
    with pytest.raises(LoadingError, match="no portal named 'window'; the scene has: door"):
        zones_to_serve(ServerSettings(world=path))
    with pytest.raises(LoadingError, match=r"nowhere\.json: cannot be read"):
        zones_to_serve(ServerSettings(world=tmp_path / "nowhere.json"))


async def test_a_portal_that_nobody_gets_to_is_refused_by_name(tmp_path: Path) -> None:
    path = write_town(tmp_path, actors=0)
    wall = {"kind": "wall", "height_m": 3, "points": [[0, 4], [3, 4], [3, 8], [0, 8]]}
    (tmp_path / "hall.json").write_text(json.dumps(HALL | {"polygons": [wall]}))
    settings = ServerSettings(world=path, actors=0, port=0, private_port=0)
    with pytest.raises(LoadingError, match="zone 'hall': portal 'door': nobody gets there"):
        async with running(settings, NO_CLIENT):
            pass


async def test_people_see_where_the_portals_lead(serving: Serving, tmp_path: Path) -> None:
    async with (
        serving(scene=None, world=write_town(tmp_path)) as server,
        joined(server.port) as ann,
    ):
        assert ann.welcome is not None
        scene = ann.welcome.scene
    assert scene["name"] == "The yard"
    assert scene["zone"] == "yard"
    (portal,) = scene["portals"]
    assert (portal["name"], portal["zone"], portal["title"]) == ("gate", "hall", "The hall")
    assert portal["points"] == [[16.0, 8.0], [18.0, 8.0], [18.0, 12.0], [16.0, 12.0]]


async def test_a_zone_that_is_the_whole_world_tells_of_no_portals(
    serving: Serving, tmp_path: Path
) -> None:
    write_town(tmp_path)
    scene = tmp_path / "yard.json"
    async with serving(scene=scene) as server, joined(server.port) as ann:
        assert ann.welcome is not None
        assert {"zone", "portals"}.isdisjoint(ann.welcome.scene)
        metrics = (await get(server.private_port, "/metrics")).body
    assert b"esplanade_people 1.0" in metrics


async def test_metrics_tell_the_zones_apart(serving: Serving, tmp_path: Path) -> None:
    world = write_town(tmp_path, actors=2)
    async with serving(scene=None, world=world, actors=0) as server, joined(server.port) as ann:
        await ann.ticks(3)
        metrics = (await get(server.private_port, "/metrics")).body.decode()
        ready = await get(server.private_port, "/readyz")
    assert ready.status == 200
    lines = metrics.splitlines()
    assert 'esplanade_people{zone="yard"} 1.0' in lines
    assert 'esplanade_people{zone="hall"} 0.0' in lines
    assert 'esplanade_actors{zone="hall"} 2.0' in lines
    assert "esplanade_connections 1.0" in lines
    for zone in ("yard", "hall"):
        assert any(
            line.startswith(f'esplanade_tick_p99_seconds{{zone="{zone}"}}') for line in lines
        )
        assert any(f'tick_duration_seconds_count{{zone="{zone}"}}' in line for line in lines)
        assert any(f'stage="people",zone="{zone}"' in line for line in lines)


async def test_actors_walk_from_zone_to_zone(serving: Serving, tmp_path: Path) -> None:
    world = write_town(tmp_path, with_actors=True, actors=1)
    # All of the yard is a portal, so that nobody has to walk there first.
    portal = {**YARD["portals"][0], "points": [[0, 0], [20, 0], [20, 20], [0, 20]]}
    (tmp_path / "yard.json").write_text(json.dumps({**YARD, "portals": [portal]}))
    async with serving(scene=None, world=world, actors=3) as server:
        yard, hall = (server.zones[name].world for name in ("yard", "hall"))
        await until(lambda: not yard.actors and len(hall.actors) == 4)
        came = {f"yard/actor-{number}" for number in (1, 2, 3)}
        assert set(hall.actors) == {"hall/actor-1", *came}
        metrics = (await get(server.private_port, "/metrics")).body.decode()
    assert 'esplanade_actors_came_total{zone="hall"} 3.0' in metrics.splitlines()


async def test_no_two_people_or_actors_of_a_world_have_one_id(
    serving: Serving, tmp_path: Path
) -> None:
    world = write_town(tmp_path, actors=2)
    async with serving(scene=None, world=world, actors=2) as server, joined(server.port) as ann:
        await ann.ticks(2)
        ids = {
            name: set(zone.world.state.ids[zone.world.state.live()].tolist())
            for name, zone in server.zones.items()
        }
    assert len(ids["yard"]) == 3
    assert len(ids["hall"]) == 2
    assert not ids["yard"] & ids["hall"]
