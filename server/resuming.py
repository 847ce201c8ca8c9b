"""Lets a server go on from what it recovered, and sees to it that the next one can."""

import asyncio
from concurrent.futures import Executor

import structlog

from esplanade.server.checkpoint.parts import Parts
from esplanade.server.checkpoint.seat_keeper import SeatKeeper
from esplanade.server.checkpoint.writer import CheckpointWriter
from esplanade.server.console.audit_tail import Tail
from esplanade.server.console.console import Console
from esplanade.server.console.redoing import redo, remember
from esplanade.server.kept import Kept
from esplanade.server.metrics import Metrics
from esplanade.server.net.hub import Hub
from esplanade.server.net.mutes import Mutes
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
    parts = recovery.parts
    console.begun = kept.started
    hub.restore(recovery.left)
    parts.part("zone", console.zone.save)
    if travel is not None:
        parts.part("travel", travel.save, travel.load)
    parts.part("seats", hub.save_seats)
    operated_parts(parts, console, hub.moderation.mutes)
    if parts.restored is not None:
        await make_true(console, recovery.tail, kept, thread)
        log.info("goes on", tick=console.zone.tick, people=len(recovery.left.waiting))
    elif recovery.replaces:
        persistence.hold()
    else:
        await persistence.begin()
    return console


def operated_parts(parts: Parts, console: Console, mutes: Mutes) -> None:
    """Register, and load, the parts of what operators have set in a zone.

    Raises
    ------
    CheckpointError
        A part cannot be read.
    """
    loop = asyncio.get_running_loop()
    parts.part("mutes", mutes.save, mutes.load)
    parts.part("console", console.save, console.load)
    parts.part("pace", console.pace.save, lambda saved: console.pace.load(saved, loop.time()))


async def make_true(console: Console, tail: Tail, kept: Kept, thread: Executor) -> None:
    """Bring a zone to where the audit says that it was, before its first tick.

    Raises
    ------
    StoreError
        The store cannot be used.
    """
    await asyncio.get_running_loop().run_in_executor(thread, redo, console, tail)
    remember(console, tail)
    await console.ongoing.resume(tail.going_on)
    await tell_the_lost(tail, kept)
