"""Checkpoints of a zone in the database, from which the next host goes on."""

import asyncio
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from functools import partial
from typing import Any, Final

import structlog
from sqlalchemy import Connection

from esplanade.server.checkpoint.errors import CheckpointError
from esplanade.server.checkpoint.format import pack, unpack
from esplanade.server.checkpoint.parts import Parts
from esplanade.server.cluster.tenure import Claim
from esplanade.server.cluster.zone_rows import ZoneCheckpoint, keep_checkpoint
from esplanade.server.host.actor_portals import ActorPortals
from esplanade.server.store.store import Store, StoreError
from esplanade.server.world.zone import Zone

EVERY_S: Final = 2.0
SCENE: Final = "scene"
ZONE: Final = "zone"
NEXT_ID: Final = "next_id"

log = structlog.get_logger(__name__)


class Checkpointing:
    """Writes what a zone is, off the tick: it is copied between two ticks, and packed in a thread.

    `digest` is that of the scene: a checkpoint of another scene tells only where people stand.
    `operated` are the parts of what operators have set. Where actors go from zone to zone, the rows
    of those who are on their way are settled with it.
    """

    def __init__(
        self,
        world: Zone,
        operated: Parts,
        store: Store,
        claim: Claim,
        digest: str,
        thread: Executor,
        actors: ActorPortals | None = None,
    ) -> None:
        self._world = world
        self._operated = operated
        self._store = store
        self._claim = claim
        self._digest = digest
        self._thread = thread
        self._actors = actors
        self.failures = 0
        """Checkpoints that the database has not taken."""

    async def run(self) -> None:
        """Write a checkpoint now and then; one that fails is not tried again, but the next one is
        made.

        Raises
        ------
        NotOwnerError
            The zone is another host's.
        """
        while True:
            await asyncio.sleep(EVERY_S)
            try:
                await self.write()
            except StoreError as error:
                self.failures += 1
                log.warning("no checkpoint is written", why=str(error))

    async def write(self) -> None:
        """Write a checkpoint of this moment. Call it between two ticks.

        Raises
        ------
        StoreError
            It is not written.
        """
        tick = self._world.tick
        parts = {
            SCENE: self._digest,
            ZONE: self._world.save(),
            NEXT_ID: self._world.state.next_id,
            **self._operated.save(),
        }
        settle = None if self._actors is None else self._actors.settled()
        loop = asyncio.get_running_loop()
        packed = await loop.run_in_executor(self._thread, pack, parts)
        await self._store.write(partial(_keep, self._claim, tick, packed, settle))


def _keep(
    claim: Claim,
    tick: int,
    packed: bytes,
    settle: Callable[[Connection], None] | None,
    connection: Connection,
) -> None:
    keep_checkpoint(connection, claim, tick, packed)
    if settle is not None:
        settle(connection)


def unpacked(kept: ZoneCheckpoint | None) -> Mapping[str, Any]:
    """The parts of a checkpoint; none where there is none, or where it cannot be read."""
    if kept is None:
        return {}
    try:
        parts = unpack(kept.saved)
    except CheckpointError as error:
        log.warning("the checkpoint cannot be read, the zone begins anew", why=str(error))
        return {}
    return parts if {SCENE, ZONE, NEXT_ID} <= parts.keys() else {}
