"""Lets a server go on from what it recovered, and sees to it that the next one can."""

import asyncio
from concurrent.futures import Executor

import structlog

from esplanade.server.checkpoint.seat_keeper import SeatKeeper
from esplanade.server.checkpoint.writer import CheckpointWriter
from esplanade.server.console.console import Console
from esplanade.server.console.redoing import redo, remember
from esplanade.server.kept import Kept
from esplanade.server.metrics import Metrics
from esplanade.server.net.hub import Hub
from esplanade.server.net.persistence import Persistence, watch
from esplanade.server.recovery import Recovery, tell_the_lost
from esplanade.server.world.actor_travel import ActorTravel
from esplanade.server.world.zone import Zone

log = structlog.get_logger(__name__)


def persistence_of(world: Zone, recovery: Recovery, kept: Kept, metrics: Metrics) -> Persistence:
    """Make what lets the world outlast its process, if the store does."""
    if kept.store.location.in_memory:
        return Persistence(world, kept.store)
    keeper = SeatKeeper(kept.store)
    writer = CheckpointWriter(recovery.parts, kept.store, recovery.scene)
    watch(keeper, writer, metrics)
    return Persistence(world, kept.store, keeper, writer)


async def resume(
    console: Console,
    recovery: Recovery,
    kept: Kept,
    hub: Hub,
    persistence: Persistence,
    thread: Executor,
    travel: ActorTravel | None = None,
) -> Console:
    """The console, with everything where the audit says that it was when the server ended.

    Here all parts of checkpoints are registered. A new world has its first one written before
    anything can happen in it: what is acknowledged afterwards is found from there.

    Raises
    ------
    StoreError
        A part cannot be read, or the store cannot be used.
    """
    parts, loop = recovery.parts, asyncio.get_running_loop()
    console.begun = kept.started
    hub.restore(recovery.left)
    parts.part("zone", console.zone.save)
    if travel is not None:
        parts.part("travel", travel.save, travel.load)
    parts.part("seats", hub.save_seats)
    parts.part("mutes", hub.moderation.mutes.save, hub.moderation.mutes.load)
    parts.part("console", console.save, console.load)
    parts.part("pace", console.pace.save, lambda saved: console.pace.load(saved, loop.time()))
    if parts.restored is not None:
        await loop.run_in_executor(thread, redo, console, recovery.tail)
        remember(console, recovery.tail)
        await console.ongoing.resume(recovery.tail.going_on)
        await tell_the_lost(recovery, kept)
        log.info("goes on", tick=console.zone.tick, people=len(recovery.left.waiting))
    elif recovery.replaces:
        persistence.hold()
    else:
        await persistence.begin()
    return console
