"""Operators work in each zone of a world: paths with /zones/NAME are about that zone."""

from collections.abc import AsyncIterator
from pathlib import Path

import pytest_asyncio

from esplanade.protocol import CloseCode
from esplanade.protocol.messages import Bye, Travel
from esplanade.server.app import Running
from tests.server.client import joined
from tests.server.conftest import Serving
from tests.server.console.operators import Operator, operator
from tests.server.http import get
from tests.server.live.consoles import live_console
from tests.server.zones import IN_GATE, until, write_town


@pytest_asyncio.fixture
async def town(serving: Serving, tmp_path: Path) -> AsyncIterator[Running]:
    async with serving(scene=None, world=write_town(tmp_path), actors=2) as server:
        await until(lambda: all(zone.live.map.tick > 0 for zone in server.zones.values()))
        yield server


async def in_zone(server: Running, zone: str) -> Operator:
    asked = await operator(server, f"olga-{zone}", "admin")
    return Operator(asked.port, asked.token, zone)


async def test_each_zone_is_told_and_has_paths_of_its_own(town: Running) -> None:
    olga = await operator(town, "olga", "admin")
    status, found = await olga.get("/zones")
    assert (status, found["here"]) == (200, "yard")
    assert [(one["name"], one["scene"], one["actors"]) for one in found["zones"]] == [
        ("yard", "The yard", 2),
        ("hall", "The hall", 2),
    ]
    hall = Operator(olga.port, olga.token, "hall")
    assert (await hall.get("/zones"))[1]["here"] == "hall"
    assert (await hall.get("/world"))[1]["scene"] == "The hall"
    assert (await olga.get("/world"))[1]["scene"] == "The yard"
    _, actors = await hall.get("/actors")
    assert {one["id"] for one in actors["actors"]} == {"hall/actor-1", "hall/actor-2"}
    status, refused = await Operator(olga.port, olga.token, "attic").get("/world")
    assert (status, refused["faults"][0]["code"]) == (404, "no_such_zone")
    assert "there are: yard, hall" in refused["faults"][0]["text"]


async def test_a_command_changes_the_zone_that_it_is_sent_to(town: Running) -> None:
    hall = await in_zone(town, "hall")
    command = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 12}}
    status, answer = await hall.send(command)
    assert status == 200, answer
    assert (await hall.values("hall/actor-1"))["risk_weight"] == 12.0
    yard = Operator(hall.port, hall.token, "yard")
    assert (await yard.values("yard/actor-1"))["risk_weight"] != 12.0
    # The audit is one for the whole world.
    for asker in (hall, yard):
        _, page = await asker.get("/audit?command=set_parameters&limit=5")
        assert {row["writer"] for row in page["rows"]} == {"zone hall"}


async def test_the_live_socket_tells_of_its_zone(town: Running) -> None:
    hall = await in_zone(town, "hall")
    async with live_console(hall.port, hall.token, "/zones/hall") as console:
        await console.subscribe("map", hz=10)
        await console.until(lambda: len(console.entities) == 2)
    assert {one["actor"] for one in console.entities.values()} == {"hall/actor-1", "hall/actor-2"}


async def test_the_page_is_there_for_each_zone(town: Running) -> None:
    answer = await get(town.private_port, "/zones/hall/console")
    assert (answer.status, answer.headers["location"]) == (308, "/zones/hall/console/")
    assert (await get(town.private_port, "/zones/hall/console/")).status in {200, 503}


async def test_a_scene_alone_is_one_zone_without_a_name(serving: Serving) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "viewer")
        _, found = await olga.get("/zones")
        assert found["here"] == ""
        assert [one["name"] for one in found["zones"]] == [""]


async def test_a_ban_reaches_who_is_in_another_zone_at_once(town: Running) -> None:
    mona = await operator(town, "mona", "moderator")
    async with joined(town.port, "Eve", at=IN_GATE) as eve, joined(town.port, "Ann") as ann:
        assert (await eve.until(Travel)).zone == "hall"
        await until(lambda: eve.id in town.zones["hall"].hub.sessions)
        command = {"op": "ban", "name_pattern": "Eve", "text": "No."}
        status, answer = await Operator(mona.port, mona.token, "yard").send(command)
        assert status == 200, answer
        messages, code = await eve.last_words()
        assert code == CloseCode.BANNED
        assert [each.text for each in messages if isinstance(each, Bye)] == ["No."]
        await ann.ticks(5)
    await until(lambda: not any(zone.hub.people for zone in town.zones.values()))
