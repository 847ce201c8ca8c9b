"""Puts the server together and runs it: the one place that knows all of its parts."""

import asyncio
import socket
from collections.abc import AsyncIterator, Iterable, Mapping, Sequence
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass
from functools import partial

from esplanade.server.assets import Assets
from esplanade.server.commanding import shipped_presets
from esplanade.server.console.console import Console
from esplanade.server.console.gate import Gate
from esplanade.server.crowding import warn_of_crowding
from esplanade.server.entrances import make_gate, people_url, private_certificate
from esplanade.server.keeping import keeping
from esplanade.server.kept import Kept
from esplanade.server.live.live import Live
from esplanade.server.metrics import Metrics
from esplanade.server.net.descriptors import places_for_people
from esplanade.server.net.entrance import Entrance
from esplanade.server.net.front_door import FrontDoor
from esplanade.server.net.hops import Destination, Hops
from esplanade.server.net.listener import Listener, connections_wanted
from esplanade.server.net.listening import bound_sockets
from esplanade.server.net.names import Names
from esplanade.server.net.private import private_port
from esplanade.server.net.readiness import Readiness
from esplanade.server.net.surroundings import Surroundings
from esplanade.server.net.tls import Tls, renewed
from esplanade.server.served_zone import Process, ServedZone, served_zone
from esplanade.server.settings import ServerSettings
from esplanade.server.world.zone import Zone
from esplanade.server.zones import ZoneToServe, described_portals, zones_to_serve


@dataclass(frozen=True)
class Running:
    """A server that people can reach."""

    port: int
    private_port: int
    zones: Mapping[str, ServedZone]
    """The zones by their names; newcomers enter the first. A zone that is the whole world has an
    empty name."""
    metrics: Metrics
    kept: Kept
    gate: Gate
    ticking: "asyncio.Task[None]"
    """Runs as long as all zones do; ends early only by a fault."""

    @property
    def zone(self) -> ServedZone:
        """The zone that newcomers enter."""
        return next(iter(self.zones.values()))

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
        zones = await _served(to_serve, process, metrics, meshes, stack)
        first, *_ = zones.values()
        gate.console, gate.live = first.console, first.live
        front_door = FrontDoor(
            [zone.hub for zone in zones.values()], process.entrance, settings.max_clients
        )
        await stack.enter_async_context(
            Listener(front_door, assets, settings, metrics, places).listening(sockets, tls)
        )
        for zone in zones.values():
            zone.open()
            stack.push_async_callback(zone.close)
        ticking = asyncio.create_task(_until_one_ends(zones.values()))
        readiness.open()
        try:
            yield Running(_port_of(sockets), private, zones, metrics, kept, gate, ticking)
        finally:
            readiness.close()
            gate.console = gate.live = None
            for zone in zones.values():
                zone.stop()


async def _served(
    to_serve: Sequence[ZoneToServe],
    process: Process,
    metrics: Metrics,
    meshes: Mapping[str, Mapping[str, str]],
    stack: AsyncExitStack,
) -> dict[str, ServedZone]:
    """Build all zones, one after the other, and join those of a world by their portals."""
    hops, names = Hops(metrics), Names()
    scenes = {zone.name: zone.loaded.scene for zone in to_serve}
    served: dict[str, ServedZone] = {}
    for number, zone in enumerate(to_serve):
        surroundings = None
        if zone.name:
            go = partial(hops.begin, zone.name)
            surroundings = Surroundings(number, names, zone.loaded.scene.portals, go)
        served[zone.name] = await stack.enter_async_context(
            served_zone(
                zone,
                process,
                metrics.of_zone(zone.name) if zone.name else metrics,
                {**described_portals(zone, scenes), **meshes[zone.name]},
                surroundings,
            )
        )
    for zone in to_serve:
        exits = {
            portal: Destination(to, served[to].hub, there)
            for portal, (to, there) in zone.exits.items()
        }
        hops.join(zone.name, served[zone.name].hub, exits)
        ways = {
            portal: (travel, there.arrival_place)
            for portal, (to, there) in zone.exits.items()
            if portal in zone.actor_exits and (travel := served[to].travel) is not None
        }
        if (own := served[zone.name].travel) is not None:
            own.open(zone.loaded.scene.portals, ways)
    return served


async def _until_one_ends(zones: Iterable[ServedZone]) -> None:
    await asyncio.wait([zone.ticking for zone in zones], return_when=asyncio.FIRST_COMPLETED)


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
