"""Scenes that change while people are inside."""

import json
import math
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest

from esplanade.protocol.messages import Travel, Welcome
from esplanade.server.app import Running
from esplanade.server.loading import LoadingError
from esplanade.server.main import Reloading
from tests.server.client import Client, joined
from tests.server.conftest import Serving
from tests.server.http import get
from tests.server.zones import BEFORE_GATE, HALL, YARD, until, write_town

STAND = (12.0, 13.0, 0)
HOUSE = {"kind": "building", "height_m": 6, "points": [[10, 11], [14, 11], [14, 14], [10, 14]]}
"""It stands where people stood before; from there it is a metre to the nearest ground."""


@pytest.fixture
async def town(serving: Serving, tmp_path: Path) -> AsyncIterator[Running]:
    world = write_town(tmp_path, actors=0)
    async with serving(scene=None, world=world, actors=2) as server:
        yield server


def change(folder: Path, **parts: Any) -> None:
    (folder / "yard.json").write_text(json.dumps({**YARD, **parts}))


async def moved(client: Client) -> Welcome:
    """Read on until the client is in the changed scene, and has seen itself there."""
    travel = await client.until(Travel)
    assert (travel.zone, travel.portal) == ("yard", "")
    client.entities.clear()
    client.positions.clear()
    client.tick = 0
    welcome = await client.until(Welcome)
    await client.wait_for(lambda: client.id in client.positions)
    return welcome


async def test_everyone_stands_at_the_nearest_place_in_a_changed_scene(
    town: Running, tmp_path: Path
) -> None:
    async with (
        joined(town.port, "Ann", at=STAND) as ann,
        joined(town.port, "Bob", at=(6.0, 6.0, 0)) as bob,
    ):
        before = ann.welcome
        assert before is not None
        actors = dict(town.world.actors)
        change(tmp_path, polygons=[HOUSE])
        assert await town.reload() == ["yard"]
        after = await moved(ann)
        assert (after.id, after.name, after.resume) == (before.id, before.name, before.resume)
        assert after.scene["polygons"]
        x, y = ann.position
        assert 1.0 < math.dist((x, y), STAND[:2]) < 2.0
        assert y > 14.0
        await moved(bob)
        assert math.dist(bob.position, (6.0, 6.0)) < 0.1
        await ann.move(math.pi / 2, 2.0)
        await ann.wait_for(lambda: ann.position[1] > 16.0)
        # The actors have come along, with their ids; nobody is left in the zone of before.
        assert dict(town.world.actors).keys() == actors.keys()
        assert town.world.count() == (2, 2)
        metrics = (await get(town.private_port, "/metrics")).body.decode()
    assert 'esplanade_people{zone="yard"} 2.0' in metrics.splitlines()


async def test_portals_lead_into_and_out_of_a_changed_scene(town: Running, tmp_path: Path) -> None:
    async with joined(town.port, "Ann", at=BEFORE_GATE) as ann:
        change(tmp_path, polygons=[HOUSE])
        await town.reload()
        await moved(ann)
        await ann.move(0.0, 2.0)
        assert (await ann.until(Travel)).zone == "hall"
        assert (await ann.until(Welcome)).scene["name"] == "The hall"
        await ann.move(math.pi, 2.0)
        assert (await ann.until(Travel)).zone == "yard"
        assert (await ann.until(Welcome)).scene["polygons"]


async def test_an_avatar_that_waits_for_its_person_goes_along(
    town: Running, tmp_path: Path
) -> None:
    async with joined(town.port, "Ann", at=STAND) as ann:
        assert ann.welcome is not None
        token = ann.welcome.resume
        ann.connection.transport.abort()
    await until(lambda: not town.zone.hub.sessions)
    change(tmp_path, polygons=[HOUSE])
    await town.reload()
    async with joined(town.port, "Ann", resume=token) as again:
        assert again.welcome is not None
        assert again.welcome.resumed
        assert again.welcome.scene["polygons"]
        assert again.id == ann.id
        assert math.dist(again.position, STAND[:2]) < 2.0


async def test_newcomers_enter_the_changed_scene(town: Running, tmp_path: Path) -> None:
    change(tmp_path, polygons=[HOUSE])
    await town.reload()
    async with joined(town.port, "Ann") as ann:
        assert ann.welcome is not None
        assert ann.welcome.scene["polygons"]
        assert town.gate.live is town.zone.live
        assert town.gate.console is town.zone.console


async def test_a_scene_at_fault_changes_nothing(town: Running, tmp_path: Path) -> None:
    async with joined(town.port, "Ann", at=STAND) as ann:
        zone = town.zone
        (tmp_path / "yard.json").write_text("{")
        with pytest.raises(LoadingError, match=r"zones\.1\.scene: .*yard\.json: is no JSON"):
            await town.reload()
        wall = {**HOUSE, "points": [[15, 7], [19, 7], [19, 13], [15, 13]]}
        change(tmp_path, polygons=[wall])
        with pytest.raises(LoadingError, match="portal 'gate': nobody gets there"):
            await town.reload()
        # Of two that have changed one can be run, and the other cannot.
        change(tmp_path, polygons=[HOUSE])
        wall = {**HOUSE, "points": [[0, 4], [3, 4], [3, 8], [0, 8]]}
        (tmp_path / "hall.json").write_text(json.dumps({**HALL, "polygons": [wall]}))
        with pytest.raises(LoadingError, match="portal 'door': nobody gets there"):
            await town.reload()
        assert town.zone is zone
        await ann.ticks(3)
        assert math.dist(ann.position, STAND[:2]) < 0.1
        metrics = (await get(town.private_port, "/metrics")).body.decode()
    assert 'esplanade_people{zone="yard"} 1.0' in metrics.splitlines()


async def test_only_what_has_changed_is_made_anew(town: Running, tmp_path: Path) -> None:
    zones = dict(town.zones)
    assert await town.reload() == []
    change(tmp_path, name="Another yard")
    reloading = Reloading(town)
    reloading.begin()
    await until(lambda: town.zones["yard"] is not zones["yard"])
    await reloading.end()
    assert town.zones["hall"] is zones["hall"]


async def test_zones_cannot_be_added_and_one_scene_cannot_be_reloaded(
    town: Running, tmp_path: Path, serving: Serving
) -> None:
    path = tmp_path / "town.json"
    world = json.loads(path.read_text())
    world["zones"].append({"name": "attic", "scene": "hall.json"})
    world["exits"].append({**world["exits"][1], "from": {"zone": "attic", "portal": "door"}})
    path.write_text(json.dumps(world))
    with pytest.raises(LoadingError, match="a reload cannot add, take away or reorder zones"):
        await town.reload()
    async with serving() as server:
        with pytest.raises(LoadingError, match="only a world of a file"):
            await server.reload()
