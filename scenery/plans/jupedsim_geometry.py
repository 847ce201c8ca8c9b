"""Geometry of JuPedSim as XML (JPScore): rooms with walls, obstacles, and transitions as doors.

A part of a room lies in a plane z = A x + B y + C. Where the walls of all parts close, with the
crossings and transitions between them, parts are floors at the heights that the file says, and
those that slope are stairs and ramps. Where some do not close, there are walls on open ground.
"""

from __future__ import annotations

from xml.parsers import expat

from esplanade.files.text import decoded
from esplanade.scenery.plans.jupedsim_rooms import Key, Opening, RoomPart, storeys_of_parts
from esplanade.scenery.plans.storey import Line, Point, Storey

_UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "ft": 0.3048, "in": 0.0254}
MAX_PARTS = 2000
MAX_LINES = 50_000


def read_jupedsim(data: bytes, name: str, unit_m: float | None = None) -> Storey:
    """The lowest storey of a geometry, with those above it; crossings are open.

    `unit_m` is the length of its unit, whatever it says.

    Raises
    ------
    ValueError
        It is no such XML.
    """
    reader = _Reader(unit_m)
    parser = expat.ParserCreate("utf-8")
    parser.StartElementHandler = reader.start
    parser.EndElementHandler = reader.end
    parser.StartDoctypeDeclHandler = _refuse_doctype
    try:
        # The text is decoded already, whatever its declaration says of an encoding.
        parser.Parse(decoded(data, eight_bit=True).text.lstrip().encode(), True)
    except expat.ExpatError as error:
        raise ValueError(f"it is no XML: {error}") from None
    if not reader.found:
        raise ValueError("its XML has no <geometry>")
    storey = storeys_of_parts(name, reader.parts, reader.openings)
    return storey or _walls_on_open_ground(name, reader)


def _walls_on_open_ground(name: str, reader: _Reader) -> Storey:
    """The storey of parts that do not close, all of them on one level."""
    storey = Storey(name)
    for part in reader.parts:
        storey.walls += part.walls + part.obstacles
    storey.doors = [(each.name, each.line) for each in reader.openings if each.is_door]
    if any(part.plane != (0.0, 0.0, part.plane[2]) or part.is_stairs for part in reader.parts):
        storey.remarks.append("its rooms do not close: stairs are read as level rooms")
    elif len({part.plane for part in reader.parts}) > 1:
        storey.remarks.append("its rooms do not close: all are taken for one storey")
    return storey


class _Reader:
    """The parts of a geometry that have been read up to an element."""

    def __init__(self, unit_m: float | None) -> None:
        self._unit_m = unit_m
        self.found = False
        self.parts: list[RoomPart] = []
        self.openings: list[Opening] = []
        self._metres = 1.0
        self._points: list[Point] = []
        self._caption = ""
        self._lines = 0
        self._in_obstacle = False
        self._room = ""
        self._between: frozenset[Key] = frozenset()

    def start(self, tag: str, has: dict[str, str]) -> None:
        """Take in the beginning of an element."""
        match tag:
            case "geometry":
                self.found = True
                unit = has.get("unit", "m")
                if unit not in _UNITS and self._unit_m is None:
                    raise ValueError(f"its unit {unit!r} is unknown: --unit says what it is")
                self._metres = self._unit_m or _UNITS[unit]
            case "room":
                self._room = has.get("id", "")
            case "subroom":
                self._begin_part(has)
            case "obstacle":
                self._in_obstacle = True
            case "polygon" | "crossing" | "transition":
                self._points = []
                self._caption = has.get("caption") or f"door {has.get('id', '')}".strip()
                self._between = frozenset(
                    (has.get(f"room{k}_id", self._room), has[f"subroom{k}_id"])
                    for k in (1, 2)
                    if f"subroom{k}_id" in has
                )
            case "vertex" if "px" in has and "py" in has:
                point = float(has["px"]) * self._metres, float(has["py"]) * self._metres
                self._points.append(point)

    def end(self, tag: str) -> None:
        """Take in what an element held."""
        match tag:
            case "obstacle":
                self._in_obstacle = False
            case "polygon":
                self._add_lines()
            case "crossing" | "transition" if len(self._points) >= 2:
                known = {opening.name for opening in self.openings}
                name = self._caption
                name = name if name not in known else f"{name} {len(known) + 1}"
                line = self._points[0], self._points[-1]
                self.openings.append(Opening(name, line, tag == "transition", self._between))

    def _begin_part(self, has: dict[str, str]) -> None:
        a, b, c = (float(has.get(key, "0") or "0") for key in ("A_x", "B_y", "C_z"))
        stairs = any(word in has.get("class", "").lower() for word in ("stair", "escalator"))
        key = self._room, has.get("id", "")
        self.parts.append(RoomPart((a, b, c * self._metres), stairs, key))
        if len(self.parts) > MAX_PARTS:
            raise ValueError(f"it has more than {MAX_PARTS} parts of rooms")

    def _add_lines(self) -> None:
        if not self.parts:
            self.parts.append(RoomPart((0.0, 0.0, 0.0), False))
        drawn = Storey("")
        drawn.add_path(self._points)
        lines: list[Line] = drawn.walls
        part = self.parts[-1]
        (part.obstacles if self._in_obstacle else part.walls).extend(lines)
        self._lines += len(lines)
        if self._lines > MAX_LINES:
            raise ValueError(f"it draws more than {MAX_LINES} walls")


def _refuse_doctype(*_: object) -> None:
    raise ValueError("its XML declares a document type, which is not read")
