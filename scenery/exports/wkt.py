"""The floors and walls of a layer as well-known text, in metres."""

from typing import Any

from esplanade.scenery.exports.layers import LayerCells, Line
from esplanade.scenery.plans.storey import library


def layer_as_wkt(layer: LayerCells) -> str:
    """A geometry in each line: where there is a floor, to the edges of cells; then thin walls.

    Doors stand in comments, since a line would be a wall.
    """
    shapely = library("shapely", "ways out as WKT")
    (x0, y0), cell_m = layer.corner, layer.cell_m
    boxes: list[Any] = [
        shapely.box(
            x0 + begin * cell_m, y0 + row * cell_m, x0 + end * cell_m, y0 + (row + 1) * cell_m
        )
        for row, begin, end, _ in layer.runs()
    ]
    area = shapely.simplify(shapely.union_all(boxes), 0.0)
    lines = [shapely.to_wkt(area, rounding_precision=6, trim=True)]
    if layer.walls:
        walls = shapely.line_merge(shapely.union_all(shapely.linestrings(layer.walls)))
        parts = shapely.get_parts(shapely.simplify(walls, 0.0))
        lines += [shapely.to_wkt(wall, rounding_precision=6, trim=True) for wall in parts]
    lines += [f"# door {name}: {_line(door)}" for name, door in layer.doors]
    return "\n".join([*lines, ""])


def _line(line: Line) -> str:
    (ax, ay), (bx, by) = line
    return f"LINESTRING ({ax:.10g} {ay:.10g}, {bx:.10g} {by:.10g})"
