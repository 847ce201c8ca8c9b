"""The zones of a server, joined by portals; a zone gives way to another when its scene changes."""

import asyncio
import itertools
from collections.abc import Callable, Mapping, Sequence
from contextlib import AsyncExitStack
from functools import partial
from typing import Any, Final

import structlog

from esplanade.planning import Scene
from esplanade.server.copies import Copies
from esplanade.server.loading import LoadingError
from esplanade.server.metrics import Metrics
from esplanade.server.net.front_door import FrontDoor
from esplanade.server.net.hops import Destination, Doorway, Hops
from esplanade.server.net.names import Names
from esplanade.server.net.surroundings import MOST_NUMBERS, Surroundings
from esplanade.server.served_zone import Process, ServedZone, served_zone
from esplanade.server.world.actor_travel import bring_together
from esplanade.server.world.zone import ROOM_FOR_ACTORS
from esplanade.server.zones import ZoneToServe, described_portals, without_actors

MOVING_S: Final = 60.0
"""Whoever has not come into the new zone by then has to come in anew."""

log = structlog.get_logger(__name__)


class ServedWorld:
    """The zones of a server by their names; newcomers enter the first, or one of its copies.

    A zone that is the whole world has an empty name.
    """

    def __init__(self, process: Process, metrics: Metrics, most_people: int) -> None:
        self.zones: dict[str, ServedZone] = {}
        self.ended: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        """Is done when a zone has ended, be it by a fault."""
        self.changed: list[Callable[[], None]] = []
        """Called when another zone has taken the place of one."""
        self.front_door = FrontDoor(process.entrance, most_people)
        self._process = process
        self._metrics = metrics
        self._hops, self._names = Hops(metrics), Names()
        self._numbers = itertools.count()
        self._to_serve: dict[str, ZoneToServe] = {}
        self._stacks: dict[ServedZone, AsyncExitStack] = {}
        self._reloading = asyncio.Lock()

    @property
    def first(self) -> ServedZone:
        """The zone that newcomers enter."""
        return next(iter(self.zones.values()))

    async def build(
        self, to_serve: Sequence[ZoneToServe], meshes: Mapping[str, Mapping[str, str]]
    ) -> None:
        """Build all zones, one after the other, and join those of a world by their portals.

        Raises
        ------
        LoadingError
            A scene has no room for its actors, or nobody gets to one of its portals.
        StoreError
            What is to be kept cannot be.
        """
        self._to_serve = {zone.name: zone for zone in to_serve}
        scenes = {zone.name: zone.loaded.scene for zone in to_serve}
        for zone in to_serve:
            self.zones[zone.name] = await self._build(zone, scenes, meshes[zone.name])
        self._join()
        bring_together([zone.travel for zone in self.zones.values() if zone.travel is not None])

    def open(self) -> None:
        """Let all zones tick."""
        for zone in self.zones.values():
            self._open(zone)

    async def close(self) -> None:
        """Stop all zones, say goodbye to everyone, and raise the fault of a zone that had one."""
        for zone in self._stacks:
            zone.stop()
        async with AsyncExitStack() as closing:
            for zone in self._stacks:
                closing.push_async_callback(zone.close)

    async def end(self) -> None:
        """Let go of all that the zones were built of."""
        async with AsyncExitStack() as ending:
            for stack in self._stacks.values():
                ending.push_async_exit(stack)

    async def reload(self, to_serve: Sequence[ZoneToServe]) -> list[str]:
        """Put zones in the places of those whose scenes have changed; returns their names.

        People and actors go over, each to the nearest place where they can stand.

        Raises
        ------
        LoadingError
            The zones are other ones than before, or cannot be run. Nothing has changed then.
        """
        async with self._reloading:
            self._check(to_serve)
            changed = [zone for zone in to_serve if self._differs(zone)]
            names = [zone.name for zone in changed]
            scenes = {zone.name: zone.loaded.scene for zone in to_serve}
            made = await self._build_anew(changed, scenes)
            before = {name: self.zones[name] for name in names}
            self._to_serve |= {zone.name: zone for zone in to_serve}
            self.zones |= made
            for old in before.values():
                old.close_exits()
            self._join()
            for new in made.values():
                self._open(new)
            for call in self.changed:
                call()
            for name, old in before.items():
                await self._move(name, old, made[name])
            return names

    async def _build_anew(
        self, changed: Sequence[ZoneToServe], scenes: Mapping[str, Scene]
    ) -> dict[str, ServedZone]:
        """Build zones beside those of the same names; none of them if one cannot be."""
        readings = {zone.name: self._metrics.readings(zone.name) for zone in changed}
        made: dict[str, ServedZone] = {}
        try:
            for zone in changed:
                made[zone.name] = await self._build(without_actors(zone), scenes, {}, replaces=True)
        except BaseException:
            for name, before in readings.items():
                self._metrics.read_again(name, before)
            for new in made.values():
                await self._stacks.pop(new).aclose()
            raise
        return made

    def _check(self, to_serve: Sequence[ZoneToServe]) -> None:
        if [zone.name for zone in to_serve] != list(self._to_serve) or "" in self._to_serve:
            raise LoadingError("a reload cannot add, take away or reorder zones; start anew")
        for zone in to_serve:
            if not self._differs(zone):
                continue
            if zone.loaded.triangles is not None:
                raise LoadingError(f"zone {zone.name!r}: a scene of a mesh cannot be reloaded")
            if len(self.zones[zone.name].world.actors) > ROOM_FOR_ACTORS:
                text = f"at most {ROOM_FOR_ACTORS} actors can go over to a changed scene"
                raise LoadingError(f"zone {zone.name!r}: {text}")

    def _differs(self, zone: ZoneToServe) -> bool:
        before = self._to_serve[zone.name]
        return (zone.loaded.scene, zone.exits, zone.actor_exits) != (
            before.loaded.scene,
            before.exits,
            before.actor_exits,
        )

    async def _build(
        self,
        zone: ZoneToServe,
        scenes: Mapping[str, Scene],
        mesh: Mapping[str, str],
        *,
        replaces: bool = False,
    ) -> ServedZone:
        metrics, surroundings = self._metrics, None
        if zone.name:
            number = next(self._numbers)
            if number >= MOST_NUMBERS:
                raise LoadingError("scenes were changed too often; start anew")
            metrics = self._metrics.of_zone(zone.name)
            go = partial(self._hops.begin, zone.name)
            portals = zone.loaded.scene.portals
            surroundings = Surroundings(number, self._names, portals, go)
        described: dict[str, Any] = {**described_portals(zone, scenes), **mesh}
        stack = AsyncExitStack()
        served = await stack.enter_async_context(
            served_zone(zone, self._process, metrics, described, surroundings, replaces=replaces)
        )
        self._stacks[served] = stack
        return served

    def _join(self) -> None:
        """Let the portals lead to the zones that there are now."""
        self._open_front_door()
        for name, zone in self._to_serve.items():
            exits = {
                portal: Destination(self._doorway(to), there)
                for portal, (to, there) in zone.exits.items()
            }
            self._hops.join(name, self.zones[name].hub, exits)
            ways = {
                portal: (travel, there.arrival_place)
                for portal, (to, there) in zone.exits.items()
                if portal in zone.actor_exits and (travel := self.zones[to].travel) is not None
            }
            if (own := self.zones[name].travel) is not None:
                own.open(zone.loaded.scene.portals, ways)

    def _doorway(self, zone: str) -> Doorway:
        """The way into a zone, or into one of its copies."""
        served = self._to_serve[zone]
        copies = served.copies or Copies((zone,), served.settings.max_clients)
        return Doorway(copies, {name: self.zones[name].hub for name in copies.names})

    def _open_front_door(self, *, and_no_more: bool = False) -> None:
        """Let newcomers into the zones that there are now."""
        hubs = [zone.hub for zone in self.zones.values()]
        first = self._doorway(next(iter(self.zones)))
        self.front_door.lead_to(first, hubs, and_no_more=and_no_more)

    def _open(self, zone: ServedZone) -> None:
        zone.open(lambda: self._has_ended(zone))

    def _has_ended(self, zone: ServedZone) -> None:
        if zone in self.zones.values() and not self.ended.done():
            self.ended.set_result(None)

    async def _move(self, name: str, old: ServedZone, new: ServedZone) -> None:
        """Let everybody go over from one zone to the other, and end the one."""
        try:
            async with asyncio.timeout(MOVING_S):
                while old.hub.people or old.world.actors:
                    self._hops.move(name, old.hub, new.hub, new.world.scene.bounds)
                    if old.travel is not None and new.travel is not None:
                        old.travel.move(new.travel, new.world.scene.bounds)
                    await asyncio.sleep(old.world.tick_s)
        except TimeoutError:
            log.warning("not everybody has come into the changed scene", zone=name)
        self._open_front_door(and_no_more=True)
        await old.close(replaced=True)
        await self._stacks.pop(old).aclose()
        new.keep_from_now()
        log.info("scene changed", zone=name, people=new.hub.people)
