"""The world of a cluster in the database: its files, and the zones that can be claimed."""

import re
import secrets
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import Connection, delete, insert, select

from esplanade.server.cluster.ownership import add_zone
from esplanade.server.store.store import ZONE, StoreError
from esplanade.server.store.tables import CLUSTER_FILES, CLUSTER_WORLDS


class NoWorldError(StoreError):
    """The database has no world yet."""


@dataclass(frozen=True)
class ClusterWorld:
    """The world of a cluster."""

    name: str
    subject: str
    """The word by which the subjects of its messages begin: no two clusters have the same."""
    start: str
    """The zone that newcomers enter."""
    file: str
    """The name of the world's file."""


def keep_world(
    connection: Connection,
    name: str,
    start: str,
    file: str,
    files: Mapping[str, bytes],
    zones: Iterable[str],
) -> tuple[ClusterWorld, list[str]]:
    """Write a world in the place of the one before; returns it, and the zones that are new.

    `start` is the zone that newcomers enter, `file` the name of the world's file among `files`.

    Hosts that run go on with what they have read until they are started again.
    """
    row = connection.execute(select(CLUSTER_WORLDS)).one_or_none()
    subject = f"{_slug(name)}-{secrets.token_hex(4)}" if row is None else row.subject
    kept = ClusterWorld(name, subject, start, file)
    connection.execute(delete(CLUSTER_WORLDS))
    connection.execute(delete(CLUSTER_FILES))
    connection.execute(
        insert(CLUSTER_WORLDS).values(
            zone=ZONE, name=kept.name, subject=kept.subject, start=kept.start, file=kept.file
        )
    )
    for place, content in files.items():
        connection.execute(insert(CLUSTER_FILES).values(zone=ZONE, name=place, content=content))
    return kept, [zone for zone in zones if add_zone(connection, zone)]


def world_kept(connection: Connection) -> ClusterWorld:
    """The world of the cluster.

    Raises
    ------
    NoWorldError
        There is none yet.
    """
    row = connection.execute(select(CLUSTER_WORLDS)).one_or_none()
    if row is None:
        raise NoWorldError(
            "the database has no world yet: run `esplanade cluster init WORLD.json --store …`"
        )
    return ClusterWorld(row.name, row.subject, row.start, row.file)


def file_of(connection: Connection, kept: ClusterWorld) -> bytes:
    """The bytes of the world's file."""
    chosen = select(CLUSTER_FILES.c.content).where(CLUSTER_FILES.c.name == kept.file)
    return bytes(connection.execute(chosen).scalar_one())


def write_files(connection: Connection, folder: Path) -> Path:
    """Write the files of the world into a folder, and return the path of the world's file.

    Raises
    ------
    NoWorldError
        There is no world yet.
    """
    kept = world_kept(connection)
    for row in connection.execute(select(CLUSTER_FILES)):
        path = folder / row.name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(row.content)
    return folder / kept.file


def _slug(name: str) -> str:
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")[:24] or "world"
