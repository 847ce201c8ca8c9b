"""World files: the zones of a world, and the exits from each of them to the others."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final, Self

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    StringConstraints,
    ValidationError,
    model_validator,
)

from esplanade.files.text import decoded
from esplanade.planning.scene.bounded_reading import read_bounded
from esplanade.planning.scene.faults import faults_of, spots_of
from esplanade.planning.scene.json_places import Path as Loc
from esplanade.planning.scene.json_places import Spot
from esplanade.planning.scene.scene import Name, Portal, Scene
from esplanade.planning.scene.scene_file import SceneError, read_scene

MAX_FILE_BYTES: Final = 2**20
MAX_ZONES: Final = 16
MAX_EXITS: Final = 256

MAX_COPIES: Final = 8
MOST_PEOPLE: Final = 4000
MAX_ZONE_NAME: Final = 32

ZoneName = Annotated[str, StringConstraints(pattern=r"^[a-z0-9][a-z0-9-]{0,31}$")]


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)


class ZoneEntry(_Part):
    """A zone of a world: a name, and the scene that is simulated in it."""

    name: ZoneName
    """The name by which exits speak of it: a-z, 0-9 and -."""
    scene: Path
    """The scene's file, named relative to the world's file."""
    actors: Annotated[int, Field(ge=0, le=1000)] | None = None
    """The number of actors that walk about in it; as many as the server has without it."""
    people: Annotated[int, Field(ge=1, le=MOST_PEOPLE)] | None = None
    """The most people who may be in it; as many as in the whole world without it."""
    copies: Annotated[int, Field(ge=1, le=MAX_COPIES)] = 1
    """The most copies of it that there are at a time; `people` may be in each of them."""

    @property
    def copy_names(self) -> tuple[str, ...]:
        """The names of all its copies: the first has the name of the zone, then come -2, -3."""
        return (self.name, *(f"{self.name}-{k}" for k in range(2, self.copies + 1)))


class PortalOfZone(_Part):
    """A portal of the scene of a zone."""

    zone: str
    portal: str

    def __str__(self) -> str:
        return f"portal {self.portal!r} of zone {self.zone!r}"


class Exit(_Part):
    """A way from one zone to another: who steps into the one portal comes out of the other."""

    start: Annotated[PortalOfZone, Field(alias="from")]
    to: PortalOfZone
    actors: bool = False
    """Whether actors who come to stand in the portal go this way too."""


class WorldFile(_Part):
    """The zones of a world, and the exits from each of them to the others."""

    name: Name = "world"
    start: ZoneName | None = None
    """The zone that newcomers enter; the first without it."""
    zones: Annotated[tuple[ZoneEntry, ...], Field(min_length=1, max_length=MAX_ZONES)]
    exits: Annotated[tuple[Exit, ...], Field(max_length=MAX_EXITS)] = ()

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        faults = (*self._wrong_names(), *self._wrong_exits())
        if faults:
            raise ValueError("\n".join(faults))
        return self

    @property
    def start_zone(self) -> str:
        """The name of the zone that newcomers enter."""
        return self.start or self.zones[0].name

    @property
    def entries(self) -> tuple[ZoneEntry, ...]:
        """All zones, and each copy of one as a zone of its own."""
        return tuple(
            zone.model_copy(update={"name": name, "copies": 1})
            for zone in self.zones
            for name in zone.copy_names
        )

    def original(self, zone: str) -> str:
        """The name of the zone that another is a copy of; that of any other zone itself."""
        return next(each.name for each in self.zones if zone in each.copy_names)

    def _wrong_names(self) -> Iterator[str]:
        known = {zone.name for zone in self.zones}
        seen: set[str] = set()
        for i, zone in enumerate(self.zones):
            if zone.name in seen:
                yield f"zones.{i}.name: the name {zone.name!r} is taken"
            seen.add(zone.name)
            yield from (f"zones.{i}.copies: {fault}" for fault in _wrong_copies(zone, known))
        number = sum(zone.copies for zone in self.zones)
        if number > max(MAX_ZONES, len(self.zones)):
            yield f"zones: {number} with all copies, there may be {MAX_ZONES}"
        if self.start is not None and self.start not in known:
            yield f"start: {_no_zone(self.start, known)}"

    def _wrong_exits(self) -> Iterator[str]:
        names = {zone.name for zone in self.zones}
        led: set[PortalOfZone] = set()
        for i, each in enumerate(self.exits):
            for end, at in (("from", each.start), ("to", each.to)):
                if at.zone not in names:
                    yield f"exits.{i}.{end}.zone: {_no_zone(at.zone, names)}"
            if each.start == each.to:
                yield f"exits.{i}: {each.start} leads to itself"
            if each.start in led:
                yield f"exits.{i}.from: {each.start} leads somewhere already"
            led.add(each.start)


class WorldError(ValueError):
    """A world that cannot be read or does not fit together; `faults` has a line for each fault."""

    def __init__(
        self, path: Path, faults: tuple[str, ...], spots: tuple[Spot | None, ...] = ()
    ) -> None:
        self.faults = faults
        self.spots = spots or (None,) * len(faults)
        lines = []
        for fault, spot in zip(faults, self.spots, strict=True):
            where = f"{path}:{spot[0]}:{spot[1]}" if spot else f"{path}"
            lines.append(f"{where}: {fault}")
        super().__init__("\n".join(lines))


@dataclass(frozen=True)
class World:
    """A world file with the scenes that it names."""

    file: WorldFile
    paths: Mapping[str, Path]
    """The scene's file of each zone, by the zone's name; copies have that of the first."""
    scenes: Mapping[str, Scene]
    """The scene of each zone, likewise."""

    def exits(self, zone: str) -> dict[str, tuple[str, Portal]]:
        """The zone and the portal there that each portal of a zone leads to, by its name."""
        zone = self.file.original(zone)
        return {
            each.start.portal: (each.to.zone, self.scenes[each.to.zone].portal(each.to.portal))
            for each in self.file.exits
            if each.start.zone == zone
        }

    def exits_of_actors(self, zone: str) -> frozenset[str]:
        """The names of the portals of a zone that let actors out."""
        zone = self.file.original(zone)
        return frozenset(
            each.start.portal for each in self.file.exits if each.start.zone == zone and each.actors
        )

    def arrivals(self, zone: str) -> list[tuple[float, float, float]]:
        """The places x, y, z, metres, at which people from other zones come into a zone."""
        zone = self.file.original(zone)
        scene = self.scenes[zone]
        ends = {each.to.portal for each in self.file.exits if each.to.zone == zone}
        return [scene.portal(name).arrival_place for name in sorted(ends)]


def read_world(path: Path) -> World:
    """The world that a file holds, with its scenes; they are looked for beside the file.

    Raises
    ------
    OSError
        The file cannot be read, or has more than `MAX_FILE_BYTES`.
    WorldError
        It holds no world, a scene cannot be read, or a portal leads nowhere.
    """
    data = read_bounded(path, MAX_FILE_BYTES)
    file, text = parse_world(path, data)
    faults: dict[str, Loc] = {}
    paths = {zone.name: path.parent / zone.scene for zone in file.zones}
    scenes = {}
    for i, zone in enumerate(file.zones):
        at: Loc = ("zones", i, "scene")
        try:
            scenes[zone.name] = read_scene(paths[zone.name])
        except OSError as error:
            why = error.strerror or str(error)
            faults[f"zones.{i}.scene: {paths[zone.name]} cannot be read: {why}"] = at
        except SceneError as error:
            faults |= {f"zones.{i}.scene: {line}": at for line in str(error).splitlines()}
    faults |= _wrong_portals(file, scenes)
    if faults:
        raise _error(path, text, faults)
    originals = {zone.name: file.original(zone.name) for zone in file.entries}
    return World(
        file,
        {name: paths[original] for name, original in originals.items()},
        {name: scenes[original] for name, original in originals.items()},
    )


def parse_world(path: Path, data: bytes) -> tuple[WorldFile, str]:
    """The world that the bytes of a file hold, and their text; scenes are not looked for.

    Raises
    ------
    WorldError
        They hold no world; its message begins with `path`.
    """
    try:
        text = decoded(data).text
    except ValueError as error:
        raise WorldError(path, (str(error),)) from None
    try:
        return WorldFile.model_validate_json(text), text
    except ValidationError as error:
        raise _error(path, text, faults_of(error)) from None


def _wrong_copies(zone: ZoneEntry, known: set[str]) -> Iterator[str]:
    """Faults of the copies of a zone, where `known` are the names of all zones of the file."""
    copies = zone.copy_names[1:]
    if copies and zone.people is None:
        yield f"zone {zone.name!r} needs people: the most in each copy"
    for name in copies:
        if name in known:
            yield f"a copy of {zone.name!r} has the name {name!r}, which is that of another zone"
        elif len(name) > MAX_ZONE_NAME:
            yield f"{name!r}, the name of a copy, has more than {MAX_ZONE_NAME} characters"
            return


def _wrong_portals(file: WorldFile, scenes: Mapping[str, Scene]) -> dict[str, Loc]:
    """Faults of exits that name portals which are not there, and of portals without an exit."""
    faults: dict[str, Loc] = {}
    for i, each in enumerate(file.exits):
        for end, at in (("from", each.start), ("to", each.to)):
            try:
                if at.zone in scenes:
                    scenes[at.zone].portal(at.portal)
            except KeyError as error:
                where = f"exits.{i}.{end}.portal"
                faults[f"{where}: zone {at.zone!r}: {error.args[0]}"] = ("exits", i, end, "portal")
    led = {(each.start.zone, each.start.portal) for each in file.exits}
    for i, zone in enumerate(file.zones):
        for portal in scenes[zone.name].portals if zone.name in scenes else ():
            if (zone.name, portal.name) not in led:
                fault = f"zones.{i}: portal {portal.name!r} of {zone.name!r} leads nowhere"
                faults[fault] = ("zones", i)
    return faults


def _error(path: Path, text: str, faults: Mapping[str, Loc]) -> WorldError:
    return WorldError(path, tuple(faults), spots_of(text, faults.values()))


def _no_zone(name: str, known: set[str]) -> str:
    return f"there is no zone {name!r}; the world has: {', '.join(sorted(known))}"
