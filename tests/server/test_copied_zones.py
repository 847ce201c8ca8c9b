"""A zone with copies in one process: who enters which one."""

import math
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack
from functools import partial
from pathlib import Path

import pytest

from esplanade.protocol import VERSION
from esplanade.protocol.messages import Hello, Travel
from esplanade.server.app import Running
from tests.server.client import Client, connected, joined
from tests.server.conftest import Serving
from tests.server.http import get
from tests.server.zones import until, write_town

PEOPLE = 5
FULL_ENOUGH = 4
BEFORE_DOOR = (3.0, 6.0, 0)
EAST, WEST = 0.0, math.pi


@pytest.fixture
async def halls(serving: Serving, tmp_path: Path) -> AsyncIterator[Running]:
    """A world that people enter in the hall or in its copy."""
    world = write_town(tmp_path, start="hall", copies=2, people=PEOPLE, actors=0)
    async with serving(scene=None, world=world, actors=0) as server:
        yield server


def zone_of(client: Client) -> str:
    assert client.welcome is not None
    return str(client.welcome.scene["zone"])


async def crowd(stack: AsyncExitStack, server: Running, number: int) -> list[Client]:
    return [await stack.enter_async_context(joined(server.port, "Ann")) for _ in range(number)]


async def test_newcomers_enter_a_copy_when_the_zone_is_full_enough(halls: Running) -> None:
    async with AsyncExitStack() as stack:
        people = await crowd(stack, halls, FULL_ENOUGH + 1)
        assert [zone_of(each) for each in people] == ["hall"] * FULL_ENOUGH + ["hall-2"]
        first, other = people[0], people[-1]
        assert first.welcome is not None
        assert other.welcome is not None
        assert [each.welcome.scene["copy"] for each in (first, other) if each.welcome] == [1, 2]
        # They are places of their own, and names are those of the whole world.
        assert first.id not in other.entities
        assert len({each.welcome.name for each in people if each.welcome}) == len(people)
        listed = (await get(halls.private_port, "/metrics")).body.decode()
    assert 'zone="hall-2"' in listed


async def test_a_link_names_the_copy_as_long_as_it_has_room(halls: Running) -> None:
    async with AsyncExitStack() as stack:
        await crowd(stack, halls, FULL_ENOUGH)
        port = halls.port
        friend = await stack.enter_async_context(joined(port, "Ben", zone="hall"))
        assert zone_of(friend) == "hall"
        late = await stack.enter_async_context(joined(port, "Cleo", zone="hall"))
        assert zone_of(late) == "hall-2"
        for strange in ("yard", "moon", "%00", "hall&zone=hall-2"):
            other = await stack.enter_async_context(joined(port, "Dan", zone=strange))
            assert zone_of(other) == "hall-2", strange


async def test_all_copies_full_means_that_the_world_is_full(halls: Running) -> None:
    async with AsyncExitStack() as stack:
        await crowd(stack, halls, 2 * PEOPLE)
        async with connected(halls.port) as late:
            await late.send(Hello(name="Late", version=VERSION))
            assert (await late.refusal())[0] == "server_full"


async def test_a_portal_leads_to_the_copy_that_newcomers_enter(halls: Running) -> None:
    async with AsyncExitStack() as stack:
        others = await crowd(stack, halls, FULL_ENOUGH)
        ann = await stack.enter_async_context(joined(halls.port, "Walker", at=BEFORE_DOOR))
        assert zone_of(ann) == "hall-2"
        for direction, zone in ((WEST, "yard"), (EAST, "hall-2")):
            await ann.move(direction, 2.0)
            assert (await ann.until(Travel)).zone == zone
            there = halls.zones[zone].world
            await until(partial(there.state.__contains__, ann.id))
            await ann.ticks(5)
        await others[0].connection.close()
        await until(lambda: halls.zones["hall"].hub.people < FULL_ENOUGH)
        ben = await stack.enter_async_context(joined(halls.port, "Ben"))
        assert zone_of(ben) == "hall"


async def test_whoever_comes_back_is_in_the_copy_where_they_were(halls: Running) -> None:
    async with AsyncExitStack() as stack:
        people = await crowd(stack, halls, FULL_ENOUGH + 1)
        last = people[-1].welcome
        assert last is not None
        async with joined(halls.port, "Ann", resume=last.resume, zone="hall") as back:
            assert (zone_of(back), back.id) == ("hall-2", last.id)
