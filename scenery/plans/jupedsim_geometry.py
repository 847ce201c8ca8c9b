"""Geometry of JuPedSim as XML (JPScore): rooms with walls, obstacles, and transitions as doors."""

from __future__ import annotations

from xml.parsers import expat

from esplanade.scenery.plans.storey import Point, Storey

_UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001}


def read_jupedsim(data: bytes, name: str) -> Storey:
    """The storey of a geometry; crossings between parts of a room are open and left out.

    Raises
    ------
    ValueError
        It is no such XML.
    """
    reader = _Reader(name)
    parser = expat.ParserCreate()
    parser.StartElementHandler = reader.start
    parser.EndElementHandler = reader.end
    parser.StartDoctypeDeclHandler = _refuse_doctype
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise ValueError(f"it is no XML: {error}") from None
    if not reader.found:
        raise ValueError("its XML has no <geometry>")
    return reader.storey


class _Reader:
    """The parts of a geometry that have been read up to an element."""

    def __init__(self, name: str) -> None:
        self.storey = Storey(name)
        self.found = False
        self._metres = 1.0
        self._points: list[Point] = []
        self._door = ""

    def start(self, tag: str, has: dict[str, str]) -> None:
        """Take in the beginning of an element."""
        match tag:
            case "geometry":
                self.found = True
                unit = has.get("unit", "m")
                if unit not in _UNITS:
                    raise ValueError(f"its unit {unit!r} is unknown")
                self._metres = _UNITS[unit]
            case "polygon" | "crossing" | "transition":
                self._points = []
                self._door = has.get("caption") or f"door {has.get('id', '')}".strip()
            case "vertex" if "px" in has and "py" in has:
                point = float(has["px"]) * self._metres, float(has["py"]) * self._metres
                self._points.append(point)
            case "stairs" | "up" | "down":
                remark = "stairs of JPScore are read as level rooms"
                if remark not in self.storey.remarks:
                    self.storey.remarks.append(remark)

    def end(self, tag: str) -> None:
        """Take in what an element held."""
        if tag == "polygon":
            self.storey.add_path(self._points)
        elif tag == "transition" and len(self._points) >= 2:
            known = {name for name, _ in self.storey.doors}
            name = self._door if self._door not in known else f"{self._door} {len(known) + 1}"
            self.storey.doors.append((name, (self._points[0], self._points[-1])))


def _refuse_doctype(*_: object) -> None:
    raise ValueError("its XML declares a document type, which is not read")
