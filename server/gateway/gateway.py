"""Puts a gateway together and runs it."""

import asyncio
import socket
from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager, AsyncExitStack, asynccontextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from nats.aio.client import Client

from esplanade.planning.scene.world_file import parse_world
from esplanade.server.assets import Assets
from esplanade.server.cluster.ownership import ownerships
from esplanade.server.cluster.processes import GATEWAY
from esplanade.server.cluster.world_rows import ClusterWorld, file_of, world_kept
from esplanade.server.copies import Copies
from esplanade.server.gateway.meshes import Meshes
from esplanade.server.gateway.operators_port import ClusterZones, operators_port
from esplanade.server.gateway.reception import Reception
from esplanade.server.heartbeat import Heartbeat
from esplanade.server.kept import Kept
from esplanade.server.link.broker import Connecting
from esplanade.server.link.process_metrics import process_metrics
from esplanade.server.link.subjects import Subjects
from esplanade.server.metrics import Metrics
from esplanade.server.net.descriptors import places_for_people
from esplanade.server.net.entrance import Entrance
from esplanade.server.net.listener import Listener, connections_wanted
from esplanade.server.net.listening import bound_sockets
from esplanade.server.net.tls import Tls
from esplanade.server.settings import ServerSettings
from esplanade.server.store.store import Store
from esplanade.server.zones import copies_in


@dataclass(frozen=True)
class RunningGateway:
    """A gateway that people can reach."""

    port: int
    private_port: int
    """The port for operators."""
    kept: Kept
    reception: Reception
    metrics: Metrics
    ended: "asyncio.Future[None]"
    """Is done when the gateway is to end, or a part of it has failed."""


@asynccontextmanager
async def gateway(
    name: str,
    settings: ServerSettings,
    store: Store,
    broker: Client,
    shared: Callable[[Metrics], AbstractAsyncContextManager[Kept]],
    broker_of: Callable[[], Connecting],
    assets: Assets | None = None,
) -> AsyncIterator[RunningGateway]:
    """Run a gateway; on leaving, everyone is told goodbye and may come back at another one.

    `name` is one that no other process has or gets. `store` is that of this process alone, `shared`
    opens what all processes share; `broker_of` connects to the broker, for operators.

    Raises
    ------
    StoreError
        The database does not answer, or has no world yet.
    TlsError
        The certificate and its key cannot be used.
    OSError
        The port cannot be had, or too few open files are allowed.
    """
    places = places_for_people(connections_wanted(settings))
    tls = _tls(settings)
    world = await store.read(world_kept)
    zones, file = await store.read(_zones), await store.read(partial(_file_of, world))
    copied = copies_in(parse_world(Path(world.file), file)[0], settings.max_clients)
    metrics = process_metrics(zones, broker)
    async with AsyncExitStack() as stack:
        sockets = await bound_sockets(settings.host, settings.port)
        for each in sockets:
            stack.callback(each.close)
        port, subjects = _port_of(sockets), Subjects(world.subject)
        kept = await stack.enter_async_context(shared(metrics))
        assets = assets or Assets.load()
        reception = Reception(
            name,
            copied.get(world.start) or Copies((world.start,), settings.max_clients),
            store,
            broker,
            subjects,
            settings,
            metrics,
            kept,
            Entrance(settings, kept, metrics),
            Meshes(store, assets),
        )
        zones_of = ClusterZones(name, world.start, kept.store, subjects, broker_of)
        private = await stack.enter_async_context(
            operators_port(settings, kept, metrics, assets, _Ready(reception), zones_of, port, tls)
        )
        address = settings.public_url or f"port {port}"
        heartbeat = Heartbeat(store, name, GATEWAY, address, lambda: reception.people)
        await heartbeat.begin()
        stack.push_async_callback(heartbeat.end)
        listener = Listener(reception, assets, settings, metrics, places)
        await stack.enter_async_context(listener.listening(sockets, tls))
        ended: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        for work in (reception.run(), heartbeat.run()):
            task = asyncio.create_task(work)
            task.add_done_callback(partial(_end, ended))
            stack.push_async_callback(_cancelled, task)
        stack.push_async_callback(reception.close)
        yield RunningGateway(port, private, kept, reception, metrics, ended)


class _Ready:
    """Tells operators' port whether people may come in."""

    def __init__(self, reception: Reception) -> None:
        self._reception = reception

    def hindrance(self) -> str | None:
        return self._reception.hindrance


def _end(ended: "asyncio.Future[None]", task: "asyncio.Task[None]") -> None:
    if task.cancelled() or ended.done():
        return
    error = task.exception()
    if error is None:
        ended.set_result(None)
    else:
        ended.set_exception(error)


async def _cancelled(task: "asyncio.Task[None]") -> None:
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)


def _zones(connection: Any) -> list[str]:
    return [each.zone for each in ownerships(connection)]


def _file_of(world: ClusterWorld, connection: Any) -> bytes:
    return file_of(connection, world)


def _port_of(sockets: list[socket.socket]) -> int:
    port: int = sockets[0].getsockname()[1]
    return port


def _tls(settings: ServerSettings) -> Tls | None:
    if settings.tls_cert is None or settings.tls_key is None:
        return None
    return Tls(Path(settings.tls_cert), Path(settings.tls_key))
