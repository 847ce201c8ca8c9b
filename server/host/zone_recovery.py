"""The state of a zone that its new owner finds in the database, and the world made of it."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Final

import structlog

from esplanade.actors import Population
from esplanade.server.building import build_world
from esplanade.server.checkpoint.errors import CheckpointError
from esplanade.server.checkpoint.ids import Block
from esplanade.server.checkpoint.parts import Parts
from esplanade.server.checkpoint.returning import Left
from esplanade.server.checkpoint.rows import KeptSeat
from esplanade.server.checkpoint.scene import SceneKey
from esplanade.server.cluster.seats import ClusterSeat, seats_in
from esplanade.server.cluster.travellers import TravellerRow, travellers_of
from esplanade.server.cluster.zone_rows import ZoneCheckpoint, newest_checkpoint
from esplanade.server.host import checkpointing
from esplanade.server.loading import LoadedScene
from esplanade.server.recovery import Recovery
from esplanade.server.store.store import Store
from esplanade.server.world.zone import Zone
from esplanade.server.zones import ZoneToServe

PACE: Final = "pace"
FIRST_ACTOR_ID: Final = 2**31
"""Avatars of people have the numbers of their seats, those of actors begin here."""
IDS_OF_A_ZONE: Final = 2**26
SKIPPED_IDS: Final = 10_000
"""Ids that the owner before may have given away since its last checkpoint."""
SKIPPED_TICKS: Final = 10
"""Ticks by which the next owner is ahead of what the clock says, so that none comes again."""

log = structlog.get_logger(__name__)


@dataclass(frozen=True)
class Found:
    """The state of a zone in the database as its new owner finds it."""

    parts: Mapping[str, Any] = field(default_factory=dict)
    tick: int = 0
    seats: list[ClusterSeat] = field(default_factory=list)
    travellers: list[TravellerRow] = field(default_factory=list)


async def found_in(store: Store, zone: str, loaded: LoadedScene, tick_s: float) -> Found:
    """Read what the owner before has left.

    Raises
    ------
    StoreError
        The database does not answer.
    """
    kept, seats, travellers = await store.read(partial(_read, zone))
    parts = checkpointing.unpacked(kept)
    if kept is None:
        return Found(seats=seats, travellers=travellers)
    fastest = max(1.0, float(parts.get(PACE, {}).get("factor", 1.0)))
    tick = kept.tick + round(fastest * kept.ago_us / 1e6 / tick_s) + SKIPPED_TICKS
    if parts and parts[checkpointing.SCENE] != digest_of(loaded):
        log.info("the scene is another one than before, everybody goes to a spawn", zone=zone)
        parts = {}
    return Found(parts, tick, seats, travellers)


def _read(
    zone: str, connection: Any
) -> tuple[ZoneCheckpoint | None, list[ClusterSeat], list[TravellerRow]]:
    return (
        newest_checkpoint(connection, zone),
        seats_in(connection, zone),
        travellers_of(connection, zone),
    )


def digest_of(loaded: LoadedScene) -> str:
    """The digest by which scenes are told apart: of a mesh its triangles count, not its path."""
    scene, triangles = loaded.scene, loaded.triangles
    if triangles is None:
        return hashlib.sha256(scene.model_dump_json().encode()).hexdigest()
    described = scene.model_dump_json(exclude={"mesh"}).encode()
    return hashlib.sha256(described + hashlib.sha256(triangles).digest()).hexdigest()


def build(zone: ZoneToServe, place: int, found: Found) -> tuple[Population, Zone, list[float]]:
    """Build the world of a zone that goes on from what was found; `place` is its place among all.

    It takes a while, and is meant for a thread.

    Raises
    ------
    LoadingError
        The scene cannot be run.
    """
    first = FIRST_ACTOR_ID + place * IDS_OF_A_ZONE
    end = first + IDS_OF_A_ZONE
    key = SceneKey.of(zone.loaded.scene.name, "", None)
    if found.parts:
        known = set(found.parts[checkpointing.ZONE]["people"]["ids"].tolist())
        waiting = [
            (KeptSeat(seat.person, seat.name, "", (), (0.0, 0.0, 0.0)), 0.0)
            for seat in found.seats
            if seat.person in known
        ]
        begin = min(int(found.parts[checkpointing.NEXT_ID]) + SKIPPED_IDS, end - 1)
        recovery = Recovery(
            key,
            Parts(),
            Block(begin, end),
            found.parts[checkpointing.ZONE],
            found.tick,
            left=Left(waiting),
        )
        try:
            return build_world(zone.loaded, zone.settings, recovery)
        except CheckpointError as error:
            log.warning("the checkpoint cannot be used, the zone begins anew", why=str(error))
    recovery = Recovery(key, Parts(), Block(first, end), None, found.tick)
    return build_world(zone.loaded, zone.settings, recovery)
