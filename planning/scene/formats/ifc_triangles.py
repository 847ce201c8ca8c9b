"""Triangles of a building by IfcOpenShell, in a process that a damaged file may end.

It runs by itself, as `python ifc_triangles.py BUILDING.ifc TRIANGLES.npy`: it writes float64
(T, 3, 3), metres, z up, and prints what else is to be told as JSON: `passed`, `told`, or `fault`.
"""

import json
import multiprocessing
import sys
from typing import Any

import numpy as np

MAX_TRIANGLES = 5_000_000
_NOTHING = ("IfcOpeningElement", "IfcSpace", "IfcVirtualElement", "IfcAnnotation", "IfcGrid")
"""They are no matter."""
_DOORS = "IfcDoor"


def convert(building: str, triangles: str) -> dict[str, Any]:
    """Write the triangles of a building; returns what is to be told of it."""
    import ifcopenshell  # noqa: PLC0415 - of the extra `ifc`
    import ifcopenshell.geom  # noqa: PLC0415

    try:
        model: Any = ifcopenshell.open(building)
    except Exception as error:  # noqa: BLE001  (several classes of the library's own)
        return {"fault": str(error)}
    geometry: Any = ifcopenshell.geom
    settings = geometry.settings()
    settings.set("use-world-coords", True)
    left_out = [part for kind in _NOTHING for part in _by_type(model, kind)]
    doors = _by_type(model, _DOORS)
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
            return {"fault": f"it has more than {MAX_TRIANGLES} triangles"}
        going = iterator.next()
    np.save(triangles, np.concatenate(parts))
    return {"passed": {"doors, taken as open": len(doors)}, "told": _told(model)}


def _told(model: Any) -> list[str]:
    storeys = sorted(_by_type(model, "IfcBuildingStorey"), key=lambda s: s.Elevation or 0.0)
    names = ", ".join(str(storey.Name or storey.GlobalId) for storey in storeys)
    told = [f"storeys: {names}"] if names else []
    units = [unit for each in _by_type(model, "IfcUnitAssignment") for unit in each.Units or ()]
    if not any(str(getattr(unit, "UnitType", "")) == "LENGTHUNIT" for unit in units):
        told.append("it names no unit: taken for metres (--scale says otherwise)")
    return told


def _by_type(model: Any, kind: str) -> list[Any]:
    try:
        return list(model.by_type(kind))
    except RuntimeError:
        return []


if __name__ == "__main__":
    try:
        found = convert(*sys.argv[1:])
    except Exception as error:  # noqa: BLE001  (damaged files take the library anywhere)
        found = {"fault": f"{type(error).__name__}: {error}"}
    sys.stdout.write(json.dumps(found))
