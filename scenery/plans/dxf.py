"""Drawings in DXF: lines of all or chosen layers are walls; those of doors and stairs are not."""

from __future__ import annotations

import io
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final, NamedTuple

from esplanade.files.text import decoded
from esplanade.scenery.plans.dxf_doors import Stroke, doorways
from esplanade.scenery.plans.storey import Storey, library

_METRES: Final = {
    1: 0.0254, 2: 0.3048, 3: 1609.344, 4: 0.001, 5: 0.01, 6: 1.0, 7: 1000.0, 9: 2.54e-5,
    10: 0.9144, 13: 1e-6, 14: 0.1, 15: 10.0, 16: 100.0, 21: 1200.0 / 3937.0,
}  # fmt: skip
"""Metres in the unit of the header `$INSUNITS`."""
_DOORS: Final = re.compile(r"door|t(ü|ue)r(en)?\b|porte|puerta|porta", re.IGNORECASE)
_STAIRS: Final = re.compile(r"stair|treppe|escalier|escalera|scal[ae]\b|escada", re.IGNORECASE)
_DRAWN: Final = frozenset(
    ("LINE", "LWPOLYLINE", "POLYLINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE", "HELIX", "3DFACE",
     "SOLID", "TRACE")
)  # fmt: skip
"""Kinds of entities that are drawn as lines; texts, dimensions, hatches and pictures are not."""
_BINARY: Final = b"AutoCAD Binary DXF"
_HAS_HEADER: Final = re.compile(r"\n[ \t]*2[ \t]*\n[ \t]*HEADER[ \t]*\n|[\0\2]HEADER\0")
_HEADER: Final = "  0\nSECTION\n  2\nHEADER\n  9\n$ACADVER\n  1\n{}\n  0\nENDSEC\n"
_FLATTENING: Final = 0.01
_FLAT_M: Final = 1.0
MAX_LINES: Final = 50_000
MAX_ENTITIES: Final = 200_000
MAX_DEPTH: Final = 16


class _Drawn(NamedTuple):
    """An entity, the layer that it is on, and the block that it comes from, by number."""

    entity: Any
    layer: str
    block: int


def read_dxf(
    data: bytes, name: str, layers: Sequence[str] = (), unit_m: float | None = None
) -> Storey:
    """The storey of a drawing; `unit_m` is the length of its unit, whatever its header says.

    Raises
    ------
    ValueError
        It is no DXF, has none of the layers, or draws more than may be.
    """
    drawing, faults = _opened(data)
    path_of = library("ezdxf.path", "drawings in DXF").make_path
    storey = Storey(name)
    if faults:
        storey.remarks.append(f"it is damaged: {faults} faults were mended, or left out")
    _check_drawn(drawing)
    scale = unit_m or _metres(drawing, data, storey)
    wanted = {layer.lower() for layer in layers}
    hidden = {
        layer.dxf.name.lower() for layer in drawing.layers if layer.is_off() or layer.is_frozen()
    } - wanted
    passed: Counter[str] = Counter()
    seen: set[str] = set()
    doors: dict[int, list[Stroke]] = {}
    heights: list[float] = []
    for entity, layer, block in _Drawing().entities(drawing.modelspace()):
        seen.add(layer)
        is_door = bool(_DOORS.search(layer))
        why = _why_passed(layer, wanted, hidden)
        if why:
            passed[why] += 1
        elif (stroke := _stroke(entity, path_of, scale, heights)) is None:
            passed[f"entities of type {entity.dxftype()}"] += 1
        elif is_door:
            doors.setdefault(block, []).append(stroke)
        else:
            storey.add_path(stroke.points)
        if len(storey.walls) > MAX_LINES:
            raise ValueError(f"it draws more than {MAX_LINES} lines; choose layers with --layer")
    _check_layers(wanted, seen)
    for block, strokes in doors.items():
        for doorway in doorways(strokes, is_block=block > 0):
            storey.doors.append((f"door {len(storey.doors) + 1}", doorway))
    storey.remarks += _differing(heights)
    storey.remarks += [f"passed over: {count} {what}" for what, count in passed.items()]
    return storey


def _metres(drawing: Any, data: bytes, storey: Storey) -> float:
    """The metres in a unit of the drawing, as its header says; the library has its own if none."""
    text = data.decode("latin-1") if data.startswith(_BINARY) else _text(data)
    if not _HAS_HEADER.search(text):
        raise ValueError(
            "it has no header, which would say how long its unit is: give --unit, as in --unit mm "
            "(esplanade scene import)"
        )
    said = drawing.header.get("$INSUNITS", 0) if "$INSUNITS" in text else 0
    if said not in _METRES:
        storey.remarks.append("it names no unit: taken as metres (--unit says otherwise)")
    return _METRES.get(said, 1.0)


def _why_passed(layer: str, wanted: set[str], hidden: set[str]) -> str:
    """Why a layer is not drawn; empty where it is."""
    if layer.lower() in hidden:
        return f"entities of layer {layer}, which is off"
    if wanted:
        chosen = layer.lower() in wanted or _DOORS.search(layer)
        return "" if chosen else f"entities of layer {layer}"
    if _STAIRS.search(layer):
        return f"lines of stairs (layer {layer}), taken as level floor"
    return ""


def _differing(heights: list[float]) -> list[str]:
    low, high = min(heights, default=0.0), max(heights, default=0.0)
    if high - low <= _FLAT_M:
        return []
    return [f"its lines lie {low:.1f} to {high:.1f} m high: all are taken for one storey"]


def _opened(data: bytes) -> tuple[Any, int]:
    """The drawing; one that is damaged is read as far as it can be, and its faults are counted."""
    ezdxf = library("ezdxf", "drawings in DXF")
    recover = library("ezdxf.recover", "drawings in DXF")
    if re.match(rb"AC10\d\d", data):
        raise ValueError("it is a drawing in DWG, which is not read: save it as DXF")
    if data.startswith(_BINARY):
        return _of_bytes(data), 0
    try:
        text = _text(data)
        if not _HAS_HEADER.search(text):
            # Without a version, the library would pass over what newer ones mark as theirs.
            text = _HEADER.format("AC1024" if "AcDb" in text else "AC1009") + text
            data = text.encode()
        return ezdxf.read(io.StringIO(text)), 0
    except Exception:  # noqa: BLE001, S110  (the library raises many kinds on damaged files)
        pass
    try:
        drawing, auditor = recover.read(io.BytesIO(data))
    except Exception as error:  # noqa: BLE001
        raise ValueError(f"it is no DXF that can be read: {error}"[:300]) from None
    return drawing, len(auditor.errors) + len(auditor.fixes)


def _of_bytes(data: bytes) -> Any:
    """The drawing of a binary DXF, which the library only reads from a file."""
    ezdxf = library("ezdxf", "drawings in DXF")
    with TemporaryDirectory() as folder:
        path = Path(folder, "drawing.dxf")
        path.write_bytes(data)
        try:
            return ezdxf.readfile(path)
        except Exception as error:  # noqa: BLE001
            raise ValueError(f"it is no binary DXF that can be read: {error}"[:300]) from None


def _text(data: bytes) -> str:
    """The text of a drawing, without spaces behind its values."""
    return re.sub(r"[ \t]+\n", "\n", decoded(data, eight_bit=True).text)


def _check_drawn(drawing: Any) -> None:
    """Check that there is more than definitions of what could be drawn."""
    if not len(drawing.modelspace()):
        defined = sum(1 for block in drawing.blocks if len(block) and not block.is_any_layout)
        told = f": it defines {defined} blocks and places none of them" if defined else ""
        raise ValueError(f"it draws nothing{told}")


class _Drawing:
    """Goes through a drawing and the blocks in it, as far as that is bounded."""

    def __init__(self) -> None:
        self._count = 0
        self._blocks = 0

    def entities(
        self, found: Any, layer: str = "0", block: int = 0, left: int = MAX_DEPTH
    ) -> Iterator[_Drawn]:
        """All that is drawn as a line, each with the layer on which it is seen."""
        if left == 0:
            raise ValueError("its blocks lie too deep within each other")
        for entity in found:
            self._count += 1
            if self._count > MAX_ENTITIES:
                raise ValueError(f"it has more than {MAX_ENTITIES} entities")
            own = entity.dxf.get("layer", "0")
            kind = entity.dxftype()
            # Parts of a block on layer 0 are on the layer of the block's copy.
            own = layer if own == "0" else own
            if kind in ("INSERT", "MLINE"):
                for copy in self._copies(entity, kind):
                    self._blocks += block == 0 and kind == "INSERT"
                    name = entity.dxf.get("name", "") if kind == "INSERT" else ""
                    seen = name if own == "0" and _DOORS.search(name) else own
                    inner = self._blocks if kind == "INSERT" and block == 0 else block
                    yield from self.entities(copy.virtual_entities(), seen, inner, left - 1)
            else:
                yield _Drawn(entity, own, block)

    def _copies(self, entity: Any, kind: str) -> Iterator[Any]:
        if kind == "INSERT" and entity.mcount > 1:
            if entity.mcount > MAX_ENTITIES:
                raise ValueError(f"it has more than {MAX_ENTITIES} entities")
            yield from entity.multi_insert()
        else:
            yield entity


def _stroke(entity: Any, path_of: Any, scale: float, heights: list[float]) -> Stroke | None:
    if entity.dxftype() not in _DRAWN:
        return None
    try:
        path = path_of(entity)
        found = list(path.flattening(_FLATTENING / scale))
    except Exception:  # noqa: BLE001  (of damaged entities the library raises many kinds)
        return None
    if len(found) < 2 or len(found) > MAX_LINES:
        return None
    heights += (scale * min(p.z for p in found), scale * max(p.z for p in found))
    points = [(scale * p.x, scale * p.y) for p in found]
    if entity.dxftype() != "ARC":
        return Stroke(points)
    centre = entity.ocs().to_wcs(entity.dxf.center)
    return Stroke(points, (scale * centre.x, scale * centre.y))


def _check_layers(wanted: set[str], seen: set[str]) -> None:
    missing = wanted - {layer.lower() for layer in seen}
    if missing:
        known = ", ".join(sorted(seen)) or "none"
        raise ValueError(f"it has no layer {', '.join(sorted(missing))}; there are {known}"[:600])
