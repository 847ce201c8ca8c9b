"""The clock of a host is an hour wrong: no zone changes its owner for that."""

import asyncio
from datetime import datetime, timedelta

from esplanade.server.cluster.tenure import LEASE_S
from tests.patience import COMPILING_PATIENCE_S
from tests.server.client import joined
from tests.server.clustering.clocks import clock_ahead
from tests.server.clustering.clusters import ZONES, Cluster, Process
from tests.server.clustering.people import go_on, walk

PLACE = (6.0, 10.0, 0)
HOUR = timedelta(hours=1)
TICKS = round(2 * LEASE_S * 20)
"""Longer than a lease lasts."""


def ahead_of_us(host: Process) -> timedelta:
    """The time by which the clock of a host was ahead when it wrote its first line."""
    told = host.wait_for("ready to claim", COMPILING_PATIENCE_S)["timestamp"]
    return datetime.fromisoformat(told) - datetime.now().astimezone()


async def test_hosts_whose_clocks_are_wrong_keep_their_zones_and_take_no_others(
    at_town: Cluster,
) -> None:
    right = HOUR / 2  # between the lines that are compared a slow machine takes a while
    early = at_town.host(name="early", **clock_ahead(HOUR.total_seconds()))
    late = at_town.host(name="late", **clock_ahead(-HOUR.total_seconds()))
    assert await asyncio.to_thread(ahead_of_us, early) > right
    assert await asyncio.to_thread(ahead_of_us, late) < -right
    async with joined(at_town.ports[0], "Ann", PLACE) as ann:
        owners = [at_town.owner(zone) for zone in ZONES]
        await go_on(ann, ticks=TICKS)
        assert [at_town.owner(zone) for zone in ZONES] == owners

        for zone, host in zip(ZONES, (early, late), strict=True):
            epoch = at_town.owner(zone)[1]
            done = await asyncio.to_thread(at_town.command, "move", zone, host.name)
            assert done.code == 0, done
            assert await at_town.taken_over(zone, epoch) is host
        owners = [at_town.owner(zone) for zone in ZONES]
        await go_on(ann, ticks=TICKS)
        await walk(ann, 0.5)
        assert [at_town.owner(zone) for zone in ZONES] == owners
    for host in (early, late):
        assert await asyncio.to_thread(host.stop) == 0
