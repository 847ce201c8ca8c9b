"""Drawings in DXF: lines of all or chosen layers are walls, those of door layers are doors."""

from __future__ import annotations

import io
import re
from collections import Counter
from collections.abc import Sequence
from typing import Any, Final

from esplanade.files.text import decoded
from esplanade.scenery.plans.storey import Storey, library

_METRES: Final = {1: 0.0254, 2: 0.3048, 4: 0.001, 5: 0.01, 6: 1.0, 10: 0.9144, 14: 0.1}
"""Metres in the unit of the header `$INSUNITS`."""
_DOORS: Final = re.compile(r"door|t(ü|ue)r(en)?\b|porte|puerta|porta", re.IGNORECASE)
_FLATTENING: Final = 0.01
MAX_LINES: Final = 50_000


def read_dxf(data: bytes, name: str, layers: Sequence[str] = ()) -> Storey:
    """The storey of a drawing.

    Raises
    ------
    ValueError
        It is no DXF, has none of the layers, or draws more than may be.
    """
    ezdxf = library("ezdxf", "drawings in DXF")
    path_of = library("ezdxf.path", "drawings in DXF").make_path
    disassemble = library("ezdxf.disassemble", "drawings in DXF").recursive_decompose
    try:
        drawing = ezdxf.read(io.StringIO(decoded(data, eight_bit=True).text))
    except (ezdxf.DXFError, ValueError) as error:
        raise ValueError(f"it is no DXF that can be read: {error}") from None
    storey = Storey(name)
    unit = drawing.header.get("$INSUNITS", 0)
    if unit not in _METRES:
        storey.remarks.append("it names no unit: taken as metres (--scale says otherwise)")
    scale = _METRES.get(unit, 1.0)
    wanted = {layer.lower() for layer in layers}
    passed: Counter[str] = Counter()
    seen: set[str] = set()
    for entity in disassemble(drawing.modelspace()):
        layer = entity.dxf.get("layer", "0")
        seen.add(layer)
        is_door = bool(_DOORS.search(layer))
        if wanted and layer.lower() not in wanted and not is_door:
            passed[f"entities of layer {layer}"] += 1
            continue
        points = _points(entity, path_of, scale)
        if points is None:
            passed[f"entities of type {entity.dxftype()}"] += 1
        elif is_door:
            storey.doors.append((f"door {len(storey.doors) + 1}", (points[0], points[-1])))
        else:
            storey.add_path(points)
        if len(storey.walls) > MAX_LINES:
            raise ValueError(f"it draws more than {MAX_LINES} lines; choose layers with --layer")
    missing = wanted - {layer.lower() for layer in seen}
    if missing:
        known = ", ".join(sorted(seen)) or "none"
        raise ValueError(f"it has no layer {', '.join(sorted(missing))}; there are {known}")
    storey.remarks += [f"passed over: {count} {what}" for what, count in passed.items()]
    return storey


def _points(entity: Any, path_of: Any, scale: float) -> list[tuple[float, float]] | None:
    try:
        path = path_of(entity)
    except TypeError:
        return None
    points = [(scale * p.x, scale * p.y) for p in path.flattening(_FLATTENING / scale)]
    return points if len(points) >= 2 else None
