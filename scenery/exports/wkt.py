"""The floors of a layer as well-known text, a polygon or several, in metres."""

from typing import Any

from esplanade.scenery.exports.layers import LayerCells
from esplanade.scenery.plans.storey import library


def layer_as_wkt(layer: LayerCells) -> str:
    """One geometry in a line: where there is a floor, to the edges of cells."""
    shapely = library("shapely", "ways out as WKT")
    (x0, y0), cell_m = layer.corner, layer.cell_m
    boxes: list[Any] = [
        shapely.box(
            x0 + begin * cell_m, y0 + row * cell_m, x0 + end * cell_m, y0 + (row + 1) * cell_m
        )
        for row, begin, end, _ in layer.runs()
    ]
    area = shapely.simplify(shapely.union_all(boxes), 0.0)
    return f"{shapely.to_wkt(area, rounding_precision=6, trim=True)}\n"
