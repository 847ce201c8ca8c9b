"""Buildings in IFC by IfcOpenShell (extra `ifc`): triangles of all that stands, doors left open."""

from __future__ import annotations

import multiprocessing
from collections import Counter
from pathlib import Path
from typing import Any, Final

import numpy as np

from esplanade.files.text import decoded
from esplanade.planning.scene.formats.faces import Triangles
from esplanade.planning.scene.formats.unpacking import extra

MAX_TRIANGLES: Final = 5_000_000
_NOTHING: Final = ("IfcOpeningElement", "IfcSpace", "IfcVirtualElement", "IfcAnnotation", "IfcGrid")
"""They are no matter."""
_DOORS: Final = "IfcDoor"


def read_ifc(path: Path, data: bytes) -> Triangles:
    """The triangles of a building in metres, z up.

    Slabs, stairs, ramps, walls and furniture are taken as they are. Doors are left out, so that
    one walks through; how many is told, and so are the storeys by name.

    Raises
    ------
    ValueError
        It is no IFC, or IfcOpenShell is not installed.
    """
    library = extra("ifcopenshell", "ifc", "a building in IFC")
    geometry = extra("ifcopenshell.geom", "ifc", "a building in IFC")
    if not data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"ISO-10303-21"):
        raise ValueError("it does not begin as IFC does")
    try:
        packed = path.suffix.lower() == ".gz"
        text = decoded(data, eight_bit=True).text if packed else ""
        model = library.file.from_string(text) if packed else library.open(str(path))
    except Exception as error:  # noqa: BLE001  (several classes of the library's own)
        raise ValueError(str(error)) from None
    settings = geometry.settings()
    settings.set("use-world-coords", True)
    passed: Counter[str] = Counter()
    storeys = sorted(model.by_type("IfcBuildingStorey"), key=lambda s: s.Elevation or 0.0)
    names = ", ".join(str(storey.Name or storey.GlobalId) for storey in storeys)
    left_out: list[Any] = [part for kind in _NOTHING for part in _by_type(model, kind)]
    doors = _by_type(model, _DOORS)
    passed["doors, taken as open"] += len(doors)
    iterator = geometry.iterator(
        settings, model, multiprocessing.cpu_count(), exclude=[*left_out, *doors] or None
    )
    parts = [np.empty((0, 3, 3))]
    count = 0
    going = iterator.initialize()
    while going:
        shape = iterator.get().geometry
        vertices = np.array(shape.verts, dtype=np.float64).reshape(-1, 3)
        corners = np.array(shape.faces, dtype=np.int64).reshape(-1, 3)
        parts.append(vertices[corners])
        count += len(corners)
        if count > MAX_TRIANGLES:
            raise ValueError(f"it has more than {MAX_TRIANGLES} triangles")
        going = iterator.next()
    told = (f"storeys: {names}",) if names else ()
    return Triangles(np.concatenate(parts), +passed, told)


def _by_type(model: Any, kind: str) -> list[Any]:
    try:
        return list(model.by_type(kind))
    except RuntimeError:
        return []
