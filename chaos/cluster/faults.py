"""Faults of a cluster, drawn by a seed: each happens, and what it took away is there again."""

import asyncio
import random
from collections.abc import Awaitable, Callable, Mapping
from typing import Final

from tests.server.brokers import Brokers, NatsServers
from tests.server.clustering.clusters import ZONES, Cluster
from tests.server.databases import PostgresqlServer

FROZEN_S: Final = 5.0
BROKER_AWAY_S: Final = 1.0
DATABASE_AWAY_S: Final = 3.0

KINDS: Final = (
    "host killed",
    "host frozen",
    "host ended",
    "gateway killed",
    "gateway frozen",
    "broker killed",
    "broker frozen",
    "database killed",
    "zone fenced",
    "zone moved",
)
OF_SEVERAL_BROKERS: Final = "one broker killed"
"""A kind that needs several brokers; with the others all of them are killed or frozen at once."""

Fault = Callable[[], Awaitable[None]]


class Faults:
    """Makes faults happen to a cluster. Only processes that the cluster has begun are touched."""

    def __init__(
        self,
        cluster: Cluster,
        broker: Brokers,
        database: PostgresqlServer,
        chance: random.Random,
    ) -> None:
        self._cluster = cluster
        self._broker = broker
        self._brokers = broker.servers if isinstance(broker, NatsServers) else [broker]
        self._database = database
        self._chance = chance
        happen: tuple[Fault, ...] = (
            self.kill_host,
            self.freeze_host,
            self.end_host,
            self.kill_gateway,
            self.freeze_gateway,
            self.kill_broker,
            self.freeze_broker,
            self.kill_database,
            self.fence_zone,
            self.move_zone,
        )
        self.kinds: Mapping[str, Fault] = {
            **dict(zip(KINDS, happen, strict=True)),
            OF_SEVERAL_BROKERS: self.kill_one_broker,
        }

    async def kill_host(self) -> None:
        """An owner of a zone is killed."""
        await self._taken_over(lambda zone: self._cluster.owning(zone).kill())

    async def end_host(self) -> None:
        """An owner is drained."""
        await self._taken_over(self._drain)

    async def fence_zone(self) -> None:
        """A zone is taken from its owner."""
        await self._taken_over(lambda zone: self._cluster.command("fence", zone))

    async def move_zone(self) -> None:
        """A zone goes to a host that stands by."""
        name = await asyncio.to_thread(lambda: self._cluster.standing_by().name)
        await self._taken_over(lambda zone: self._cluster.command("move", zone, name))

    async def freeze_host(self) -> None:
        """An owner stands still until another has its zone, and then goes on."""
        zone = self._chance.choice(ZONES)
        owner = await asyncio.to_thread(self._cluster.owning, zone)
        epoch = self._cluster.owner(zone)[1]
        owner.freeze()
        await self._cluster.taken_over(zone, epoch)
        owner.thaw()
        await asyncio.sleep(1.0)

    async def kill_gateway(self) -> None:
        """A gateway is killed, and another one begins."""
        self._chance.choice(self._cluster.gateways).kill()
        await self._refill()

    async def freeze_gateway(self) -> None:
        """A gateway stands still for some seconds."""
        gateway = self._chance.choice(self._cluster.gateways)
        gateway.freeze()
        await asyncio.sleep(FROZEN_S)
        gateway.thaw()

    async def kill_broker(self) -> None:
        """The broker is killed, and is back after a second."""
        self._broker.kill()
        await asyncio.sleep(BROKER_AWAY_S)
        await asyncio.to_thread(self._broker.start)

    async def kill_one_broker(self) -> None:
        """One of several brokers is killed, and is back after a second."""
        one = self._chance.choice(self._brokers)
        one.kill()
        await asyncio.sleep(BROKER_AWAY_S)
        await asyncio.to_thread(one.start)

    async def freeze_broker(self) -> None:
        """The broker stands still for a second."""
        self._broker.freeze()
        await asyncio.sleep(BROKER_AWAY_S)
        self._broker.thaw()

    async def kill_database(self) -> None:
        """The database is killed, and is back after some seconds."""
        await asyncio.to_thread(self._database.stop)
        await asyncio.sleep(DATABASE_AWAY_S)
        await asyncio.to_thread(self._database.start)

    def _drain(self, zone: str) -> None:
        owner = self._cluster.owning(zone)
        self._cluster.command("drain", owner.name)
        owner.end()

    async def _taken_over(self, take: Callable[[str], object]) -> None:
        zone = self._chance.choice(ZONES)
        epoch = self._cluster.owner(zone)[1]
        await asyncio.to_thread(take, zone)
        await self._cluster.taken_over(zone, epoch)
        await self._refill()

    async def _refill(self) -> None:
        await asyncio.to_thread(self._cluster.refill)
