"""The processes of a cluster from their begin to their end: signals, database, broker."""

import asyncio
import gc
import secrets
import signal
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from functools import partial
from typing import Any, Final

import structlog
from nats.aio.client import Client

from esplanade.commandline import interrupts
from esplanade.server.clustering.membership import Membership
from esplanade.server.commanding import shipped_presets
from esplanade.server.entrances import in_url, private_url
from esplanade.server.gateway.gateway import gateway
from esplanade.server.host.host import Host, world_of_cluster
from esplanade.server.host.hosted_zone import HostProcess
from esplanade.server.host.operators import host_operators
from esplanade.server.keeping import kept_in
from esplanade.server.kept import Kept
from esplanade.server.link.broker import broker_for, connected
from esplanade.server.link.process_metrics import process_metrics
from esplanade.server.link.subjects import Subjects
from esplanade.server.loading import LoadingError
from esplanade.server.metrics import Metrics
from esplanade.server.net.health import health_port
from esplanade.server.settings import ServerSettings
from esplanade.server.store.sql_store import SqlStore, open_store

IDLE_MS: Final = 2000
"""The database ends a transaction of a process that has stood still for so long."""

log = structlog.get_logger(__name__)


async def run_host(settings: ServerSettings, membership: Membership, zones: Sequence[str]) -> None:
    """Run a host until a signal, or until it is drained.

    Raises
    ------
    StoreError
        The database does not answer, or has no world yet.
    BrokerError
        No broker answers.
    LoadingError
        The world has no such zone, or one cannot be run.
    """
    interrupts.end_quietly()
    async with (
        _joined(membership, membership.name) as (store, broker),
        world_of_cluster(store, settings) as world,
    ):
        known = [zone.name for zone in world.zones]
        for name in zones:
            if name not in known:
                raise LoadingError(
                    f"the world has no zone {name!r}; it has: {', '.join(sorted(known))}"
                )
        stop, metrics = asyncio.Event(), process_metrics(known, broker)
        presets, subjects = shipped_presets(settings), Subjects(world.kept.subject)
        to_broker = broker_for(membership.servers, f"{membership.name} operators", membership.login)
        async with (
            _shared(membership, settings, metrics) as kept,
            host_operators(settings, kept, metrics, subjects, to_broker) as operators,
        ):
            host = Host(
                membership.name,
                world,
                zones,
                HostProcess(store, kept, presets, broker, subjects),
                operators,
                metrics,
                stop,
            )
            async with _health(membership, metrics, lambda: host.hindrance):
                # Until then there is nothing to put in order, but a thread that cannot be
                # interrupted.
                await asyncio.to_thread(host.warm_up)
                _stop_by_signals(stop)
                await host.run()


async def run_gateway(settings: ServerSettings, membership: Membership) -> None:
    """Run a gateway until a signal, or until it is drained.

    Raises
    ------
    StoreError
        The database does not answer, or has no world yet.
    BrokerError
        No broker answers.
    TlsError
        The certificate and its key cannot be used.
    OSError
        The port cannot be had.
    """
    interrupts.end_quietly()
    # Of two that run under one name, one after the other, each has people of its own.
    name = f"{membership.name[:32]}-{secrets.token_hex(3)}"
    async with (
        _joined(membership, name) as (store, broker),
        gateway(
            name,
            settings,
            store,
            broker,
            partial(_shared, membership, settings),
            broker_for(membership.servers, f"{name} operators", membership.login),
        ) as running,
        _health(membership, running.metrics, lambda: running.reception.hindrance),
    ):
        stop = asyncio.Event()
        _stop_by_signals(stop)
        gc.collect()
        gc.freeze()
        host = "localhost" if settings.host in {"0.0.0.0", "::", ""} else settings.host  # noqa: S104
        scheme = "http" if settings.tls_cert is None else "https"
        root = settings.root_path.rstrip("/")
        url = f"{scheme}://{in_url(host)}:{running.port}{root and f'{root}/'}"
        private = private_url(settings, running.private_port)
        log.info("open", url=url, gateway=name, private=private)
        token = await running.kept.one_time.first_link()
        if token is not None:
            log.info(
                "no operator yet: this link makes the first one, once, within 10 minutes",
                url=f"{private}/console#first={token}",
            )
        waiting = asyncio.create_task(stop.wait())
        either: list[asyncio.Future[Any]] = [waiting, running.ended]
        await asyncio.wait(either, return_when=asyncio.FIRST_COMPLETED)
        waiting.cancel()
        if running.ended.done():
            running.ended.result()


@asynccontextmanager
async def _joined(membership: Membership, name: str) -> AsyncIterator[tuple[SqlStore, Client]]:
    """The database and the broker of a cluster.

    Each process has a turn of its own in the database: one that stands still holds nobody up.
    """
    async with (
        open_store(membership.location, zone=f"process {name}", idle_ms=IDLE_MS) as store,
        connected(membership.servers, name, membership.login) as broker,
    ):
        yield store, broker


@asynccontextmanager
async def _shared(
    membership: Membership, settings: ServerSettings, metrics: Metrics
) -> AsyncIterator[Kept]:
    """The accounts, the audit and all else that the processes of a cluster share."""
    async with (
        open_store(membership.location, idle_ms=IDLE_MS) as store,
        kept_in(store, settings, metrics) as kept,
    ):
        yield kept


@asynccontextmanager
async def _health(
    membership: Membership, metrics: Metrics, hindrance: Callable[[], str | None]
) -> AsyncIterator[None]:
    host = membership.health_host
    async with health_port(host, membership.health_port, metrics, hindrance) as port:
        log.info("health", url=f"http://{in_url(host)}:{port}")
        yield


def _stop_by_signals(stop: asyncio.Event) -> None:
    loop = asyncio.get_running_loop()

    def on_signal(number: int) -> None:
        log.info("stopping", signal=signal.Signals(number).name)
        stop.set()
        # A person who asks a second time does not want to wait.
        for each in (signal.SIGINT, signal.SIGTERM):
            loop.remove_signal_handler(each)

    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, on_signal, number)
