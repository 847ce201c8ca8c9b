"""A house in IFC, an office in DXF and a hall as a ROS map, made for trials and for the docs."""

from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

Box = tuple[tuple[float, float, float], tuple[float, float, float]]
_FACES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
STOREY_M = 3.0
WIDTH_M, DEPTH_M = 16.0, 10.0
WALL_M = 0.25


def _parts() -> list[tuple[str, str, int, list[Box]]]:
    """Class, name, storey and boxes of every part of the house, metres."""
    w, d, t = WIDTH_M, DEPTH_M, WALL_M
    parts: list[tuple[str, str, int, list[Box]]] = [
        ("IfcSlab", "Ground", 0, [((-4, -4, -0.2), (w + 4, d + 4, 0.0))]),
        (
            "IfcSlab",
            "First floor",
            1,
            [((0, 0, 2.8), (9, d, 3.0)), ((9, 4, 2.8), (w, d, 3.0)), ((14, 0, 2.8), (w, 4, 3.0))],
        ),
        ("IfcStair", "Flight", 0, [
            ((9.0 + 0.3 * k, 1.0, 0.0), (9.3 + 0.3 * k, 2.6, (k + 1) * STOREY_M / 17))
            for k in range(17)
        ]),
    ]  # fmt: skip
    for storey, z in ((0, 0.0), (1, STOREY_M)):
        top = z + (2.8 if storey == 0 else 2.6)
        south = [(0.0, 5.0), (6.2, w)] if storey == 0 else [(0.0, w)]
        walls: list[Box] = [((a, 0, z), (b, t, top)) for a, b in south]
        walls += [((0, d - t, z), (w, d, top)), ((0, t, z), (t, d - t, top))]
        walls += [((w - t, t, z), (w, d - t, top))]
        walls += [((6.5, 6, z), (6.5 + t, d - t, top)), ((t, 6, z), (3, 6 + t, top))]
        walls += [((4.2, 6, z), (11, 6 + t, top)), ((12.2, 6, z), (w - t, 6 + t, top))]
        parts.append(("IfcWall", f"Walls {storey}", storey, walls))
    parts.append(("IfcRailing", "Rail", 1, [((9, 0.25, 3.0), (9.05, 0.95, 4.0)),
                                            ((9, 2.65, 3.0), (9.05, 4, 4.0)),
                                            ((9.05, 3.95, 3.0), (14, 4, 4.0))]))  # fmt: skip
    for k, (x, y) in enumerate([(1.5, 7.5), (9.0, 8.0), (13.0, 7.8)]):
        table = [((x, y, 0.0), (x + 1.6, y + 0.8, 0.75))]
        parts.append(("IfcFurniture", f"Table {k + 1}", 0, table))
    parts.append(("IfcDoor", "Front door", 0, [((5.0, 0.08, 0.0), (6.2, 0.16, 2.1))]))
    return parts


def house(path: Path) -> Path:
    """A house of two storeys with a flight of stairs, rooms, tables and a front door."""
    ifc, api = import_module("ifcopenshell"), import_module("ifcopenshell.api")
    call: Any = api.run
    model = ifc.file(schema="IFC4")
    project = call("root.create_entity", model, ifc_class="IfcProject", name="House")
    call("unit.assign_unit", model, length={"is_metric": True, "raw": "METERS"})
    above = call("context.add_context", model, context_type="Model")
    body = call(
        "context.add_context",
        model,
        context_type="Model",
        context_identifier="Body",
        target_view="MODEL_VIEW",
        parent=above,
    )
    storeys = []
    for number, name in enumerate(("Ground floor", "First floor")):
        storey = call("root.create_entity", model, ifc_class="IfcBuildingStorey", name=name)
        storey.Elevation = number * STOREY_M
        storeys.append(storey)
    call("aggregate.assign_object", model, products=storeys, relating_object=project)
    for kind, name, number, boxes in _parts():
        part = call("root.create_entity", model, ifc_class=kind, name=name)
        shape = call(
            "geometry.add_mesh_representation",
            model,
            context=body,
            vertices=[_corners(box) for box in boxes],
            faces=[_FACES for _ in boxes],
        )
        call("geometry.assign_representation", model, product=part, representation=shape)
        call("spatial.assign_container", model, products=[part], relating_structure=storeys[number])
        call("geometry.edit_object_placement", model, product=part)
    model.write(str(path))
    return path


def _corners(box: Box) -> list[tuple[float, float, float]]:
    (x0, y0, z0), (x1, y1, z1) = box
    ring = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    return [(float(x), float(y), float(z)) for z in (z0, z1) for x, y in ring]


def office(path: Path) -> Path:
    """An office of 24 m x 14 m in millimetres: walls, doors on a layer of their own, and words."""
    drawing = import_module("ezdxf").new()
    drawing.header["$INSUNITS"] = 4
    for layer in ("A-WALL", "A-DOOR", "A-FURN", "A-TEXT"):
        drawing.layers.add(layer)
    space = drawing.modelspace()

    def wall(*points: tuple[float, float], layer: str = "A-WALL", close: bool = False) -> None:
        ring = [(1000 * x, 1000 * y) for x, y in points]
        space.add_lwpolyline(ring, close=close, dxfattribs={"layer": layer})

    wall((11, 0), (0, 0), (0, 14), (24, 14), (24, 0), (13, 0))
    space.add_line((11000, 0), (13000, 0), dxfattribs={"layer": "A-DOOR"})
    for y in (5.5, 8.5):
        doors: Sequence[float] = (2.5, 8.5, 14.5, 20.5)
        edges = [0.0, *(edge for door in doors for edge in (door, door + 1.2)), 24.0]
        for a, b in zip(edges[::2], edges[1::2], strict=True):
            if not (y < 6.0 and a < 12.0 < b):
                wall((a, y), (b, y))
        if y < 6.0:
            wall((9.7, y), (11, y))
            wall((13, y), (14.5, y))
        for door in doors:
            ends = (1000 * door, 1000 * y), (1000 * (door + 1.2), 1000 * y)
            space.add_line(*ends, dxfattribs={"layer": "A-DOOR"})
    for x in (6, 12, 18):
        wall((x, 8.5), (x, 14))
    for x in (6, 18):
        wall((x, 0), (x, 5.5))
    for x, y in ((1, 11), (7, 11), (13, 11), (19, 11), (1, 1.5), (19, 1.5)):
        wall((x, y), (x + 1.8, y), (x + 1.8, y + 0.9), (x, y + 0.9), layer="A-FURN", close=True)
    space.add_circle((12000, 7000), 350, dxfattribs={"layer": "A-WALL"})
    space.add_text("office", dxfattribs={"layer": "A-TEXT"})
    drawing.saveas(path)
    return path


def hall(path: Path) -> Path:
    """A hall of 20 m x 12 m with pillars as a ROS map of 5 cm, and its image beside it."""
    rows, columns = 240, 400
    image = np.full((rows, columns), 254, np.uint8)
    image[:6], image[-6:], image[:, :6], image[:, -6:] = 0, 0, 0, 0
    for x in (80, 160, 240, 320):
        for y in (80, 160):
            image[y - 6 : y + 6, x - 6 : x + 6] = 0
    image[6:150, 200:204] = 0
    pgm = path.with_suffix(".pgm")
    pgm.write_bytes(b"P5\n%d %d\n255\n" % (columns, rows) + image.tobytes())
    path.write_text(
        f"image: {pgm.name}\nresolution: 0.05\norigin: [0.0, 0.0, 0.0]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    return path
