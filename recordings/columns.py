"""Columns by name: who, when and where, in the words of those who write such files."""

import re
from collections.abc import Sequence
from typing import Final, NamedTuple

from esplanade.recordings.units import DEGREES, length_named, time_named

_NAMES: Final = {
    "time": (
        *("t", "time", "times", "simtime", "simulationtime", "simsec", "timestamp", "seconds"),
        *("sec", "secs", "timesec", "elapsed", "elapsedtime", "elapsedtimes", "datetime", "zeit"),
        "unixtime",
    ),
    "frame": (
        *("frame", "fr", "f", "frameid", "frameno", "framenr", "framenum", "framenumber"),
        *("frameindex", "frames", "framecount", "step", "timestep", "tick"),
    ),
    "id": (
        *("id", "personid", "pedestrianid", "pedid", "agentid", "trackid", "personnr", "pid"),
        *("person", "pedestrian", "ped", "agent", "track", "p", "objectid", "objid", "targetid"),
        *("actorid", "actor", "entityid", "entity", "uid", "no", "nr", "number", "name"),
    ),
    "x": (
        *("x", "posx", "xpos", "positionx", "xposition", "px", "startx", "xcoord", "xcoordinate"),
        *("coordx", "coordinatex", "coordcentx", "worldx", "xworld", "xcenter", "xcentre"),
        *("centerx", "centrex", "centroidx", "xc", "localx", "poslocalx", "xest", "locx", "xloc"),
        *("locationx", "xlocation", "translationx", "east", "easting"),
        *("lon", "long", "lng", "longitude"),
    ),
    "y": (
        *("y", "posy", "ypos", "positiony", "yposition", "py", "starty", "ycoord", "ycoordinate"),
        *("coordy", "coordinatey", "coordcenty", "worldy", "yworld", "ycenter", "ycentre"),
        *("centery", "centrey", "centroidy", "yc", "localy", "poslocaly", "yest", "locy", "yloc"),
        *("locationy", "ylocation", "translationy", "north", "northing"),
        *("lat", "latitude"),
    ),
    "z": (
        *("z", "posz", "zpos", "positionz", "zposition", "pz", "zcoord", "zcoordinate", "coordz"),
        *("worldz", "zworld", "locationz", "translationz", "localz", "height"),
    ),
    "vx": ("vx", "velx", "xvel", "velocityx", "xvelocity", "speedx", "xspeed", "vxest"),
    "vy": ("vy", "vely", "yvel", "velocityy", "yvelocity", "speedy", "yspeed", "vyest"),
    "kind": ("type", "label", "class", "agenttype", "category", "objecttype"),
}
"""Names without anything but letters and digits, the likelier first."""

_DEGREES: Final = frozenset(("lon", "long", "lng", "longitude"))
_BRACKETS: Final = re.compile(r"(.*?)\s*[\[({<]\s*([^\])}>]*?)\s*[\])}>]\s*")
_SLASH: Final = re.compile(r"(.*?)\s*/\s*([^\s/]+)")
_TAIL: Final = re.compile(r"(.*?)[_\s.]+(?:in[_\s.]+)?([a-zµμ]+)")
_MOST_OF_A_NAME: Final = 100
_NO_TAILS: Final = ("min", "h")
"""The end of a name like x_min is no unit."""
_NO_UNITS: Final = frozenset(("", "-", "--", "1", "t", "x", "y"))
"""They stand where others have a unit, and are none."""
_VADERE: Final = re.compile(r"-PID\d+$", re.IGNORECASE)


class Name(NamedTuple):
    """A name of a column: letters and digits of it, and the unit that it gives."""

    key: str
    unit: str


class Columns(NamedTuple):
    """Places of the columns that count, by what they are, with the names of their units."""

    places: dict[str, int]
    units: dict[str, str]

    @property
    def missing(self) -> list[str]:
        """The names of those for which no column was found."""
        found = self.places
        lacking = [] if "time" in found or "frame" in found else ["time or frame"]
        return lacking + [role for role in ("id", "x", "y") if role not in found]

    @property
    def unknown_units(self) -> dict[str, str]:
        """The units of time and places that have no known name, by the column."""
        given = {role: self.units.get(role, "").strip("[]() ") for role in ("time", "x", "y")}
        return {
            role: text
            for role, text in given.items()
            if text not in _NO_UNITS
            and (time_named(text) if role == "time" else length_named(text)) is None
        }


def name_of(cell: str) -> Name:
    """The name in a cell of a header."""
    text = _VADERE.sub(
        "", cell[:_MOST_OF_A_NAME].strip().strip("\"'").strip().lstrip("#$*% ").rpartition(":")[2]
    )
    stem, unit = text, ""
    for form in (_BRACKETS, _SLASH, _TAIL):
        found = form.fullmatch(text.lower() if form is _TAIL else text)
        if found and (form is not _TAIL or _is_unit(found[2])):
            stem, unit = found[1], found[2]
            # As a word of a name, "in" is no inch.
            unit = "inch" if unit.lower() == "in" and form is not _TAIL else unit
            break
    return Name(re.sub(r"[^a-z0-9]", "", stem.lower()), unit)


def find_columns(header: Sequence[str]) -> Columns:
    """Find the columns in a header; of two for the same the likelier name counts."""
    names = [name_of(cell) for cell in header]
    keys = [name.key for name in names]
    places: dict[str, int] = {}
    units: dict[str, str] = {}
    for role, known in _NAMES.items():
        place = next((keys.index(key) for key in known if key in keys), None)
        if place is not None and place not in places.values():
            places[role] = place
            units[role] = names[place].unit
    if "y" not in places and "x" in places and "z" in places:
        # Worlds of games have their ground in x and z.
        places["y"], units["y"] = places.pop("z"), units.pop("z")
    if "x" in places and keys[places["x"]] in _DEGREES:
        units["x"] = units["y"] = DEGREES
    return Columns(places, units)


def named_by_hand(header: Sequence[str], named: Sequence[str]) -> list[str]:
    """The header that a reader of the file gives: a name for each column, or `role=name`.

    Raises
    ------
    ValueError
        A name is not in the header.
    """
    if not any("=" in name for name in named):
        return [*named]
    made = [""] * len(header)
    known = [cell.strip().strip("\"'").lower() for cell in header]
    for pair in named:
        role, _, name = pair.partition("=")
        found, _, unit = (
            name.partition("/") if name.strip().lower() not in known else (name, "", "")
        )
        if found.strip().lower() not in known:
            raise ValueError(f"there is no column {found.strip()!r:.40}")
        place = known.index(found.strip().lower())
        made[place] = f"{role.strip()}/{unit}" if unit else role.strip()
    return made


def _is_unit(text: str) -> bool:
    known = length_named(text) is not None or time_named(text) is not None
    return known and text not in _NO_TAILS
