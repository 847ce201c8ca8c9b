"""Puts the server together and runs it: the one place that knows all of its parts."""

import asyncio
import socket
from collections.abc import AsyncIterator, Sequence
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass

from esplanade.server.assets import Assets
from esplanade.server.building import with_roster
from esplanade.server.commanding import shipped_presets
from esplanade.server.console.console import Console
from esplanade.server.console.gate import Gate
from esplanade.server.crowding import warn_of_crowding
from esplanade.server.entrances import make_gate, people_url, private_certificate
from esplanade.server.keeping import keeping
from esplanade.server.kept import Kept
from esplanade.server.live.live import Live
from esplanade.server.loading import LoadedScene, load_scene, tell_crowd
from esplanade.server.metrics import Metrics
from esplanade.server.net.descriptors import places_for_people
from esplanade.server.net.entrance import Entrance
from esplanade.server.net.listener import Listener, connections_wanted
from esplanade.server.net.listening import bound_sockets
from esplanade.server.net.private import private_port
from esplanade.server.net.readiness import Readiness
from esplanade.server.net.tls import Tls, renewed
from esplanade.server.served_zone import Process, ServedZone, served_zone
from esplanade.server.settings import ServerSettings
from esplanade.server.world.zone import Zone


@dataclass(frozen=True)
class Running:
    """A server that people can reach."""

    port: int
    private_port: int
    zone: ServedZone
    metrics: Metrics
    kept: Kept
    gate: Gate

    @property
    def world(self) -> Zone:
        """The zone itself, without all that serves it."""
        return self.zone.world

    @property
    def console(self) -> Console:
        """The console of its operators."""
        return self.zone.console

    @property
    def ticking(self) -> "asyncio.Task[None]":
        """Runs as long as the world does; ends early only by a fault."""
        return self.zone.ticking

    @property
    def live(self) -> Live:
        """The world as operators see it, there for as long as it runs."""
        if self.gate.live is None:
            raise RuntimeError("the world has ended")
        return self.gate.live

    def summary(self) -> dict[str, int | float]:
        """The run in figures."""
        return self.zone.summary()


@asynccontextmanager
async def running(settings: ServerSettings, assets: Assets | None = None) -> AsyncIterator[Running]:
    """Run a server; on leaving, everyone is told goodbye. The assets are the built client's.

    Raises
    ------
    LoadingError
        The scene or crowd cannot be run.
    TlsError
        The certificate and its key cannot be used.
    StoreError
        What is to be kept cannot be.
    OSError
        A port cannot be had, or too few open files are allowed.
    """
    warn_of_crowding(settings)
    # A lack of the machine is told now, not after a minute of building the world.
    places = places_for_people(connections_wanted(settings))
    tls = _tls(settings)
    loaded, presets = _loaded(settings), shipped_presets(settings)
    assets, mesh = _with_mesh(assets or Assets.load(), loaded)
    metrics = Metrics()
    loop = asyncio.get_running_loop()
    readiness = Readiness(metrics)
    async with AsyncExitStack() as stack:
        kept = await stack.enter_async_context(keeping(settings, metrics))
        private_tls = private_certificate(settings, tls)
        stack.enter_context(renewed(tls, private_tls))
        gate = make_gate(settings, kept, loop, encrypted=private_tls is not None)
        private = await stack.enter_async_context(
            private_port(settings, metrics, readiness, gate, assets, private_tls)
        )
        # This finds out now, not after a minute of compiling, whether the port can be had.
        sockets = await bound_sockets(settings.host, settings.port)
        for each in sockets:
            stack.callback(each.close)
        gate.people_url = people_url(settings, sockets[0].getsockname()[1])
        process = Process(kept, Entrance(settings, kept, metrics), presets)
        zone = await stack.enter_async_context(
            served_zone(settings, loaded, process, metrics, mesh)
        )
        gate.console, gate.live = zone.console, zone.live
        await stack.enter_async_context(
            Listener(zone.hub, assets, settings, metrics, places).listening(sockets, tls)
        )
        zone.open()
        readiness.open()
        try:
            yield Running(_port_of(sockets), private, zone, metrics, kept, gate)
        finally:
            readiness.close()
            gate.console = gate.live = None
            await zone.close()


def _port_of(sockets: Sequence[socket.socket]) -> int:
    port: int = sockets[0].getsockname()[1]
    return port


def _loaded(settings: ServerSettings) -> LoadedScene:
    """The scene of the settings, with actors; the log says how a recorded crowd was understood."""
    loaded = load_scene(settings)
    if settings.crowd is not None and loaded.crowd is not None:
        tell_crowd(settings.crowd, loaded.crowd)
    return with_roster(loaded, settings)


def _tls(settings: ServerSettings) -> Tls | None:
    """The certificate of people's port, if it has one."""
    if settings.tls_cert is None or settings.tls_key is None:
        return None
    return Tls(settings.tls_cert, settings.tls_key)


def _with_mesh(assets: Assets, loaded: LoadedScene) -> tuple[Assets, dict[str, str]]:
    """The assets with the triangles of a mesh, and what a welcome says of where they are."""
    if loaded.triangles is None:
        return assets, {}
    assets, mesh = assets.with_data("mesh", loaded.triangles)
    return assets, {"mesh": mesh}
