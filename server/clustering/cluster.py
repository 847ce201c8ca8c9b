"""`esplanade cluster`: makes a world on several machines, tells of it, and says who does what."""

import asyncio
import json
import sys
from argparse import Namespace
from collections.abc import Awaitable, Callable
from functools import partial
from pathlib import Path
from typing import TypeVar

from sqlalchemy import Connection

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import CommandError, UsageError
from esplanade.planning.scene.world_file import World, WorldError, read_world
from esplanade.server.cluster import ownership, processes
from esplanade.server.cluster.world_rows import ClusterWorld, keep_world
from esplanade.server.clustering.cluster_status import Status, read_status
from esplanade.server.clustering.world_files import WorldFilesError, files_of
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import SqlStore, open_store
from esplanade.server.store.store import StoreError

Result = TypeVar("Result")


def init(options: Namespace) -> int:
    """Put a world into the database."""
    path: Path = options.world
    try:
        world = read_world(path)
        files = files_of(path, world)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror or error}") from None
    except (WorldError, WorldFilesError) as error:
        raise UsageError(str(error)) from None
    kept, new = _write(options, partial(_keep_world, path, world, files), upgrading=True)
    told = f"new: {', '.join(new)}" if new else "no zone is new"
    print(f"{kept.name}: {len(world.file.entries)} zones, newcomers enter {kept.start}; {told}")
    return exit_codes.OK


def status(options: Namespace) -> int:
    """Say how the cluster is; returns 1 where something does not fit together."""
    found = _read(options, read_status)
    if options.json:
        print(json.dumps(found.as_data(), indent=2))
    else:
        sys.stdout.write(found.as_text())
    return exit_codes.FAILED if found.disagreements else exit_codes.OK


def drain(options: Namespace) -> int:
    """Let a process end in order."""
    names = _write(options, partial(_drain, options.name))
    print(f"{', '.join(names)}: to end in order")
    return exit_codes.OK


def move(options: Namespace) -> int:
    """Let a zone be run by another host."""
    _write(options, partial(_move, options.zone, options.host))
    print(f"{options.zone}: to be run by {options.host}")
    return exit_codes.OK


def fence(options: Namespace) -> int:
    """Take a zone away from its owner."""
    if not _write(options, partial(_fence, options.zone)):
        raise CommandError(f"there is no zone {options.zone!r}")
    print(f"{options.zone}: has no owner, and nothing counts of the one that it had")
    return exit_codes.OK


def _keep_world(
    path: Path, world: World, files: dict[str, bytes], connection: Connection
) -> tuple[ClusterWorld, list[str]]:
    zones = [zone.name for zone in world.file.entries]
    file = world.file
    return keep_world(connection, file.name, file.start_zone, path.name, files, zones)


def _drain(name: str, connection: Connection) -> list[str]:
    known = [each.name for each in processes.processes(connection)]
    # A gateway has a few letters after the name that it was given.
    found = [each for each in known if each == name or each.rpartition("-")[0] == name]
    if not found:
        there = f"; there are {', '.join(known)}" if known else ""
        raise CommandError(f"there is no process {name!r}{there}")
    for each in found:
        processes.drain(connection, each)
    return found


def _move(zone: str, host: str, connection: Connection) -> None:
    hosts = [each for each in processes.processes(connection) if each.kind == processes.HOST]
    there = [each.name for each in hosts if each.is_there and not each.drained]
    owners = {each.host: each.zone for each in ownership.ownerships(connection)}
    if host not in there:
        raise CommandError(f"no host {host!r} is there; there are: {', '.join(there) or 'none'}")
    if owners.get(host) not in {None, zone}:
        raise CommandError(f"{host} runs {owners[host]}: a host runs one zone at a time")
    if not ownership.want(connection, zone, host):
        raise CommandError(f"there is no zone {zone!r}")


def _fence(zone: str, connection: Connection) -> bool:
    return ownership.fence(connection, zone)


def _write(
    options: Namespace, change: Callable[[Connection], Result], *, upgrading: bool = False
) -> Result:
    return _in_store(options, lambda store: store.write(change), upgrading=upgrading)


def _read(options: Namespace, query: Callable[[Connection], Status]) -> Status:
    return _in_store(options, lambda store: store.read(query))


def _in_store(
    options: Namespace,
    work: Callable[[SqlStore], Awaitable[Result]],
    *,
    upgrading: bool = False,
) -> Result:
    async def run() -> Result:
        location = Location.of(None, options.store)
        async with open_store(location, upgrading=upgrading, zone="cluster") as store:
            return await work(store)

    try:
        return asyncio.run(run())
    except StoreError as error:
        raise CommandError(str(error)) from None
