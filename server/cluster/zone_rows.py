"""The rows that the owner of a zone keeps: its description for newcomers, and checkpoints."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from sqlalchemy import ColumnElement, Connection, insert, select, update

from esplanade.server.cluster.database_time import NOW_US
from esplanade.server.cluster.ownership import assert_owned
from esplanade.server.cluster.tenure import Claim
from esplanade.server.store.tables import CLUSTER_ZONES


@dataclass(frozen=True)
class ZoneCheckpoint:
    """The newest checkpoint of a zone."""

    tick: int
    ago_us: int
    """For how long it has been there, microseconds by the clock of the database."""
    saved: bytes = field(repr=False)


def keep_description(connection: Connection, owner: Claim, described: bytes) -> None:
    """Write what gateways tell newcomers to a zone.

    Raises
    ------
    NotOwnerError
        The zone is another host's.
    """
    _keep(connection, owner, {"described": described})


def keep_checkpoint(connection: Connection, owner: Claim, tick: int, saved: bytes) -> None:
    """Write a checkpoint of a zone in the place of the one before.

    Raises
    ------
    NotOwnerError
        The zone is another host's.
    """
    _keep(connection, owner, {"tick": tick, "saved": saved, "saved_us": NOW_US})


def description_of(connection: Connection, zone: str) -> tuple[int, bytes] | None:
    """The epoch of a zone's last owner, and what that one has written; None if nobody has."""
    table = CLUSTER_ZONES.c
    chosen = select(table.epoch, table.described).where(table.zone == zone)
    row = connection.execute(chosen).one_or_none()
    return None if row is None or row.described is None else (row.epoch, row.described)


def newest_checkpoint(connection: Connection, zone: str) -> ZoneCheckpoint | None:
    """The newest checkpoint of a zone; None if there is none."""
    table = CLUSTER_ZONES.c
    ago_us: ColumnElement[int] = NOW_US - table.saved_us
    chosen = select(table.tick, table.saved, ago_us.label("ago_us")).where(table.zone == zone)
    row = connection.execute(chosen).one_or_none()
    if row is None or row.saved is None:
        return None
    return ZoneCheckpoint(row.tick, max(0, row.ago_us), row.saved)


def checkpoints_ago_us(connection: Connection) -> dict[str, int]:
    """For how long the newest checkpoint of each zone that has any has been there."""
    table = CLUSTER_ZONES.c
    ago_us: ColumnElement[int] = NOW_US - table.saved_us
    rows = connection.execute(select(table.zone, ago_us).where(table.saved_us.is_not(None)))
    return {row[0]: int(row[1]) for row in rows}


def _keep(connection: Connection, owner: Claim, values: Mapping[str, Any]) -> None:
    assert_owned(connection, owner)
    written = {**values, "epoch": owner.epoch}
    chosen = CLUSTER_ZONES.c.zone == owner.zone
    done = connection.execute(update(CLUSTER_ZONES).where(chosen).values(written))
    if done.rowcount == 0:
        connection.execute(insert(CLUSTER_ZONES).values(zone=owner.zone, **written))
