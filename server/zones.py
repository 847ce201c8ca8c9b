"""The zones that a server is to run: one of a scene or a crowd, or those of a world's file."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from esplanade.planning import LayeredGrid, Portal, Scene
from esplanade.planning.routes.portal_reach import unreached_portals
from esplanade.planning.scene.world_file import World, WorldError, WorldFile, read_world
from esplanade.server.building import with_roster
from esplanade.server.copies import Copies
from esplanade.server.loading import LoadedScene, LoadingError, load_scene, tell_crowd
from esplanade.server.populating import default_roster
from esplanade.server.roster import Roster
from esplanade.server.settings import ServerSettings


@dataclass(frozen=True)
class ZoneToServe:
    """A zone that is to be built: its scene, and where its portals lead."""

    settings: ServerSettings
    """The settings of the server, with those of them that are of this zone."""
    loaded: LoadedScene
    name: str = ""
    """The name of the zone in its world; empty for one that is the whole world."""
    exits: Mapping[str, tuple[str, Portal]] = field(default_factory=dict)
    """The zone and the portal there that each portal leads to, by its name."""
    actor_exits: frozenset[str] = frozenset()
    """The names of the portals by which actors leave too."""
    arrivals: Sequence[tuple[float, float, float]] = ()
    """The places x, y, z, metres, at which people come in from other zones."""
    copies: Copies | None = None
    """The zone with its copies, of which it may be one; None where there are none."""


def zones_to_serve(settings: ServerSettings) -> list[ZoneToServe]:
    """Read what the settings name; newcomers enter the first of the zones.

    Raises
    ------
    LoadingError
        A file cannot be read or does not hold what it should.
    """
    if settings.world is None:
        loaded = load_scene(settings)
        if settings.crowd is not None and loaded.crowd is not None:
            tell_crowd(settings.crowd, loaded.crowd)
        return [ZoneToServe(settings, with_roster(loaded, settings))]
    world = _read(settings.world)
    zones = [_zone(world, place, settings) for place in range(len(world.file.entries))]
    return sorted(zones, key=lambda zone: zone.name != world.file.start_zone)


def copies_in(file: WorldFile, most_people: int) -> dict[str, Copies]:
    """The zones that have copies, by the name of each copy; no more than `most_people` are in any
    zone."""
    return {
        name: Copies(zone.copy_names, min(zone.people or most_people, most_people))
        for zone in file.zones
        if zone.copies > 1
        for name in zone.copy_names
    }


def without_actors(zone: ZoneToServe) -> ZoneToServe:
    """The same zone, into which actors come from the one before it."""
    return replace(zone, loaded=replace(zone.loaded, roster=Roster()))


def described_portals(zone: ZoneToServe, others: Mapping[str, Scene]) -> dict[str, Any]:
    """The facts about a zone of a world that a welcome adds to its scene; none for another."""
    if not zone.name:
        return {}
    portals = [
        {
            **portal.model_dump(mode="json", include={"name", "points", "z_m"}),
            "zone": zone.exits[portal.name][0],
            "title": others[zone.exits[portal.name][0]].name,
        }
        for portal in zone.loaded.scene.portals
    ]
    described: dict[str, Any] = {"zone": zone.name, "portals": portals}
    if zone.copies is not None:
        described["copy"] = zone.copies.names.index(zone.name) + 1
    return described


def check_portals(zone: ZoneToServe, grid: LayeredGrid) -> None:
    """Check that one can walk to all portals of a zone of a world, once its doors are open.

    `grid` is that of the scene as it is.

    Raises
    ------
    LoadingError
        Nobody gets to a portal.
    """
    scene = zone.loaded.scene
    if not zone.exits:
        return
    if not all(door.open for door in scene.doors):
        opened = tuple(door.model_copy(update={"open": True}) for door in scene.doors)
        grid = LayeredGrid.from_scene(scene.model_copy(update={"doors": opened}))
    for name in unreached_portals(grid, scene, zone.arrivals):
        raise LoadingError(f"zone {zone.name!r}: portal {name!r}: nobody gets there")


def _read(path: Path) -> World:
    try:
        return read_world(path)
    except OSError as error:
        raise LoadingError(f"{path}: cannot be read: {error.strerror or error}") from None
    except WorldError as error:
        raise LoadingError(str(error)) from None


def _zone(world: World, place: int, settings: ServerSettings) -> ZoneToServe:
    entry = world.file.entries[place]
    own = settings.model_copy(
        update={
            "scene": world.paths[entry.name],
            "actors": settings.actors if entry.actors is None else entry.actors,
            "max_clients": min(entry.people or settings.max_clients, settings.max_clients),
            "trajectories": _of_zone(settings.trajectories, entry.name),
        }
    )
    loaded = load_scene(own)
    # Those of each zone have ids of it, and are others than those of the other zones.
    roster = default_roster(loaded.scene, own.actors, own.seed + place, entry.name)
    return ZoneToServe(
        own,
        replace(loaded, roster=roster),
        entry.name,
        world.exits(entry.name),
        world.exits_of_actors(entry.name),
        world.arrivals(entry.name),
        copies_in(world.file, settings.max_clients).get(entry.name),
    )


def _of_zone(path: Path | None, zone: str) -> Path | None:
    """The file of one zone, where each writes one of its own."""
    return None if path is None else path.with_stem(f"{path.stem}-{zone}")
