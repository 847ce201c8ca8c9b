"""Puts the server together and runs it: the one place that knows all of its parts."""

import asyncio
import socket
from collections.abc import AsyncIterator, Iterable, Mapping, Sequence
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass

from esplanade.server.assets import Assets
from esplanade.server.commanding import shipped_presets
from esplanade.server.console.console import Console
from esplanade.server.console.gate import Gate, Operated
from esplanade.server.crowding import warn_of_crowding
from esplanade.server.entrances import make_gate, people_url, private_certificate
from esplanade.server.keeping import keeping
from esplanade.server.kept import Kept
from esplanade.server.live.live import Live
from esplanade.server.loading import LoadingError
from esplanade.server.metrics import Metrics
from esplanade.server.net.descriptors import places_for_people
from esplanade.server.net.entrance import Entrance
from esplanade.server.net.listener import Listener, connections_wanted
from esplanade.server.net.listening import bound_sockets
from esplanade.server.net.private import private_port
from esplanade.server.net.readiness import Readiness
from esplanade.server.net.tls import Tls, renewed
from esplanade.server.served_world import ServedWorld
from esplanade.server.served_zone import Process, ServedZone
from esplanade.server.settings import ServerSettings
from esplanade.server.world.zone import Zone
from esplanade.server.zones import ZoneToServe, zones_to_serve


@dataclass(frozen=True)
class Running:
    """A server that people can reach."""

    port: int
    private_port: int
    settings: ServerSettings
    served: ServedWorld
    metrics: Metrics
    kept: Kept
    gate: Gate

    @property
    def zones(self) -> Mapping[str, ServedZone]:
        """The zones by their names; newcomers enter the first. A zone that is the whole world has
        an empty name."""
        return self.served.zones

    @property
    def ticking(self) -> "asyncio.Future[None]":
        """Is under way as long as all zones tick; done early only by a fault."""
        return self.served.ended

    @property
    def zone(self) -> ServedZone:
        """The zone that newcomers enter."""
        return self.served.first

    async def reload(self) -> list[str]:
        """Read the world's file and its scenes anew; returns the zones whose scenes have changed.

        Raises
        ------
        LoadingError
            They cannot be run, and nothing has changed; or the world has no file.
        """
        if self.settings.world is None:
            raise LoadingError("only a world of a file (--world) can be reloaded")
        to_serve = await asyncio.to_thread(zones_to_serve, self.settings)
        return await self.served.reload(to_serve)

    @property
    def world(self) -> Zone:
        """That zone itself, without all that serves it."""
        return self.zone.world

    @property
    def console(self) -> Console:
        """The console of its operators."""
        return self.zone.console

    @property
    def live(self) -> Live:
        """The world as operators see it, there for as long as it runs."""
        if self.gate.live is None:
            raise RuntimeError("the world has ended")
        return self.gate.live

    def summary(self) -> dict[str, int | float]:
        """The run of the zone that newcomers enter, in figures."""
        return self.zone.summary()


@asynccontextmanager
async def running(settings: ServerSettings, assets: Assets | None = None) -> AsyncIterator[Running]:
    """Run a server; on leaving, everyone is told goodbye. The assets are the built client's.

    Raises
    ------
    LoadingError
        The world, a scene or the crowd cannot be run.
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
    to_serve, presets = zones_to_serve(settings), shipped_presets(settings)
    assets, meshes = _with_meshes(assets or Assets.load(), to_serve)
    metrics = Metrics(zone.name for zone in to_serve if zone.name)
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
        served = ServedWorld(process, metrics, settings.max_clients)
        stack.push_async_callback(served.end)
        await served.build(to_serve, meshes)

        def show_operators() -> None:
            zones = served.zones.items()
            gate.zones = {name: Operated(zone.console, zone.live) for name, zone in zones}

        show_operators()
        served.changed.append(show_operators)
        await stack.enter_async_context(
            Listener(served.front_door, assets, settings, metrics, places).listening(sockets, tls)
        )
        stack.push_async_callback(served.close)
        served.open()
        readiness.open()
        try:
            yield Running(_port_of(sockets), private, settings, served, metrics, kept, gate)
        finally:
            readiness.close()
            gate.zones = {}


def _port_of(sockets: Sequence[socket.socket]) -> int:
    port: int = sockets[0].getsockname()[1]
    return port


def _tls(settings: ServerSettings) -> Tls | None:
    """The certificate of people's port, if it has one."""
    if settings.tls_cert is None or settings.tls_key is None:
        return None
    return Tls(settings.tls_cert, settings.tls_key)


def _with_meshes(
    assets: Assets, zones: Iterable[ZoneToServe]
) -> tuple[Assets, dict[str, dict[str, str]]]:
    """The assets with the triangles of meshes, and what a welcome to each zone says of them."""
    meshes: dict[str, dict[str, str]] = {}
    for zone in zones:
        meshes[zone.name] = {}
        if zone.loaded.triangles is not None:
            assets, address = assets.with_data("mesh", zone.loaded.triangles)
            meshes[zone.name] = {"mesh": address}
    return assets, meshes
