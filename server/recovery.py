"""The recovery of a world: what a start finds in the store, and the world goes on from."""

from dataclasses import dataclass, field
from functools import partial
from typing import Any

import structlog

from esplanade.server.checkpoint.errors import WHAT_HELPS, CheckpointError
from esplanade.server.checkpoint.ids import Block, reserve
from esplanade.server.checkpoint.parts import Parts, with_faults_told
from esplanade.server.checkpoint.restoring import restored
from esplanade.server.checkpoint.returning import Left, those_left
from esplanade.server.checkpoint.scene import SceneKey
from esplanade.server.console.audit_tail import MOST_ROWS, Tail, not_done, read_tail
from esplanade.server.kept import Kept
from esplanade.server.loading import LoadedScene
from esplanade.server.settings import ServerSettings
from esplanade.server.world.saved_zone import Returning

SKIPPED_S = 5.0
"""The number of the tick goes on this much later, so that none of before comes again."""

log = structlog.get_logger(__name__)


@dataclass(frozen=True)
class Recovery:
    """The state that a world goes on from; empty for a new one."""

    scene: SceneKey
    parts: Parts
    ids: Block | None = None
    """Ids for avatars; None where nothing is kept, and ids begin anew."""
    zone: dict[str, Any] | None = None
    """The saved zone."""
    tick: int = 0
    """The number that ticks go on from."""
    tail: Tail = field(default_factory=Tail)
    left: Left = field(default_factory=Left)
    replaces: bool = False
    """Whether the world takes the place of one that runs, and is kept only once that has ended."""

    @property
    def people(self) -> list[Returning]:
        """The people whose avatars stand and wait."""
        return [Returning(seat.avatar, seat.name, seat.place) for seat, _ in self.left.waiting]


async def read_recovery(
    kept: Kept, settings: ServerSettings, loaded: LoadedScene, *, goes_on: bool = True
) -> Recovery:
    """Read what the store has of the time before this start; nothing but new ids for a zone that
    takes the place of one that runs, and does not go on from before.

    Raises
    ------
    CheckpointError
        It cannot be used; the message says why, and what to do.
    StoreError
        The store cannot be used.
    """
    described = loaded.scene.model_dump_json(exclude={"mesh", "portals"})
    scene = SceneKey.of(loaded.scene.name, described, loaded.triangles)
    if kept.store.location.in_memory:
        return Recovery(scene, Parts())
    if not goes_on:
        world = kept.store.world
        ids = await kept.store.write(lambda connection: reserve(connection, world))
        return Recovery(scene, Parts(), ids, replaces=True)
    found = await restored(kept.store, scene, fresh=settings.fresh)
    parts = found.parts or {}
    if found.parts is not None and not {"zone", "console", "seats"} <= parts.keys():
        raise CheckpointError(f"the checkpoint is not whole: {WHAT_HELPS}")
    tail = Tail()
    if found.parts is not None:
        tail = await tail_after(kept, parts["console"])
    left = with_faults_told(
        "seats",
        partial(
            those_left,
            found.seats,
            sent_out=tail.kicked,
            resume_s=settings.resume_seconds,
            most=settings.max_clients,
        ),
        parts.get("seats"),
    )
    skipped = round(SKIPPED_S * settings.tick_rate)
    tick = 0 if found.parts is None else max(found.tick, tail.tick) + skipped
    return Recovery(scene, Parts(found.parts), found.ids, parts.get("zone"), tick, tail, left)


async def tail_after(kept: Kept, console: Any) -> Tail:
    """The commands that the audit has from before this start, of a world whose console was saved.

    Raises
    ------
    CheckpointError
        It cannot be used.
    StoreError
        The store cannot be used.
    """
    begun, settled = with_faults_told("console", _numbers, console)
    rows = await kept.audit.own_rows(begun, MOST_ROWS)
    rows = [row for row in rows if row.seq < kept.started]
    return with_faults_told("audit", lambda rows: read_tail(rows, settled), rows)


async def tell_the_lost(tail: Tail, kept: Kept) -> None:
    """Write into the audit which commands never happened.

    Raises
    ------
    StoreError
        It could not be written.
    """
    entries = [not_done(row) for row in tail.lost]
    if entries:
        log.warning("commands were under way and are not done", commands=len(entries))
        await kept.store.write(
            lambda connection: [kept.audit.add(connection, entry) for entry in entries]
        )


def _numbers(saved: Any) -> tuple[int, int]:
    return int(saved["begun"]), int(saved["settled"])
