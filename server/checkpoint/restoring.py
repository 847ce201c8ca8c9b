"""Reads what a world is to go on from, and refuses what does not fit it."""

from dataclasses import dataclass, field
from typing import Any

from sqlalchemy import Connection

from esplanade.server.checkpoint.errors import WHAT_HELPS, CheckpointError
from esplanade.server.checkpoint.format import FORMAT, digest, unpack
from esplanade.server.checkpoint.ids import Block, reserve
from esplanade.server.checkpoint.rows import (
    KeptCheckpoint,
    KeptSeat,
    begin_anew,
    read_checkpoint,
    read_seats,
)
from esplanade.server.checkpoint.scene import SceneKey
from esplanade.server.store.store import Store


@dataclass(frozen=True)
class Restored:
    """The state that outlived the process, empty where the world is new."""

    ids: Block
    """Numbers for avatars that no avatar ever had."""
    tick: int = 0
    parts: dict[str, Any] | None = None
    seats: list[KeptSeat] = field(default_factory=list)


async def restored(store: Store, scene: SceneKey, *, fresh: bool) -> Restored:
    """Read what a world is to go on from; with `fresh`, take it away.

    Raises
    ------
    CheckpointError
        The checkpoint is of another scene, of another program, or damaged.
    StoreError
        The store cannot be used.
    """
    zone = store.zone

    def work(connection: Connection) -> tuple[Block, KeptCheckpoint | None, list[KeptSeat]]:
        if fresh:
            begin_anew(connection, zone)
        kept = read_checkpoint(connection, zone)
        try:
            seats = read_seats(connection, zone)
        except ValueError as error:
            raise CheckpointError(
                f"{store.location}: a seat cannot be read ({error}): {WHAT_HELPS}"
            ) from error
        return reserve(connection, store.world), kept, seats

    ids, kept, seats = await store.write(work)
    if kept is None:
        # A world that ended before its first checkpoint: people come back to where they came in.
        return Restored(ids, seats=seats)
    _check(kept, scene, store)
    try:
        parts = unpack(kept.payload)
    except CheckpointError as error:
        raise CheckpointError(
            f"{store.location}: the checkpoint cannot be read: {error}; {WHAT_HELPS}"
        ) from error
    return Restored(ids, kept.tick, parts, seats)


def _check(kept: KeptCheckpoint, scene: SceneKey, store: Store) -> None:
    where = f"{store.location}: the checkpoint"
    if kept.format != FORMAT:
        raise CheckpointError(
            f"{where} is of the format {kept.format!r}, and this program reads {FORMAT!r}: run the "
            f"program that has written it, or {WHAT_HELPS}"
        )
    if kept.scene != scene.digest:
        other = (
            f"another state of the scene {scene.name!r}"
            if kept.scene_name == scene.name
            else f"the scene {kept.scene_name!r}, and this is {scene.name!r}"
        )
        raise CheckpointError(
            f"{where} is of {other}: give that scene, or another --data, or start with --fresh to "
            "begin the world anew (accounts and the audit stay)"
        )
    if digest(kept.payload) != kept.digest:
        raise CheckpointError(f"{where} is damaged, its digest is another: {WHAT_HELPS}")
