"""Two people see each other walk; their zone's host dies, and another goes on with everyone."""

import asyncio
import math

from esplanade.protocol.messages import Chat, ChatLine
from tests.server.client import joined
from tests.server.clustering.clusters import Cluster, Process, ready
from tests.server.clustering.people import go_on, sees, walk

PLACE = (6.0, 10.0, 0)
OTHER = (6.0, 12.0, 0)


async def owner_and_other(at_town: Cluster, *hosts: Process) -> tuple[Process, Process]:
    """The one of two hosts that owns the yard, and the one that stands by."""
    ready(*hosts)
    name = None
    while name is None:
        await asyncio.sleep(0.05)
        name = at_town.owner("yard")[0]
    owner = next(host for host in hosts if host.name == name)
    await owner.told("open", zone="yard")
    return owner, next(host for host in hosts if host is not owner)


async def test_people_at_two_gateways_outlive_the_host_of_their_zone(at_town: Cluster) -> None:
    hosts = [at_town.host("yard", name=name) for name in ("ash", "birch")]
    east, west = (at_town.gateway(name=name) for name in ("east", "west"))
    owner, other = await owner_and_other(at_town, *hosts)
    async with joined(east.port, "Ann", PLACE) as ann, joined(west.port, "Ben", OTHER) as ben:
        await walk(ben, 1.5)
        await sees(ann, ben)
        await ann.send(ChatLine(text="hello"))
        assert (await ben.until(Chat)).text == "hello"
        await go_on(ann, ben, ticks=60)  # longer than from one checkpoint to the next
        place, tick, epoch = ben.position, ann.tick, at_town.owner("yard")[1]
        owner.kill()
        await other.told("open", zone="yard")
        assert at_town.owner("yard")[1] > epoch
        await asyncio.gather(ann.until_tick(tick + 40), ben.until_tick(tick + 40))
        assert math.dist(ben.position, place) <= 0.02
        await walk(ben, 1.0)
        await sees(ann, ben)
        await ben.send(ChatLine(text="still here"))
        assert (await ann.until(Chat)).text == "still here"
