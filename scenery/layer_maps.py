"""The maps of all layers of a scene as one body finds them, ready to be drawn."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from esplanade.commandline.errors import UsageError
from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.routes.find_path import LayeredPath, PathStatus, find_path
from esplanade.planning.scene.bodies import Body
from esplanade.planning.traversal.traversability import Traversability
from esplanade.planning.traversal.wavefront import metres, spread_wave
from esplanade.scenery.pictures import LayerMap, Marker
from esplanade.scenery.reach import cell_near, centres, reached_cells, spawn_cells
from esplanade.scenery.values import Point, Where

Floats = NDArray[np.float64]

_NEAR_M = 1.0
"""The greatest distance from an end of the path to a cell in which the body can stand."""
_ALONG = np.array([0.05, 0.275, 0.5, 0.725, 0.95])
"""The points along a barrier at which it is tested for standing on a layer, as fractions."""


def layer_maps(
    scene: Scene, cell_m: float, body: Body, start: Where | None, goal: Where | None
) -> list[LayerMap]:
    """Make one map of each layer, with a path from `start` to `goal`.

    By default the path goes from the first spawn to the place that is farthest from it.

    Raises
    ------
    UsageError
        An end of the path is no place, or the body cannot stand there or at any spawn.
    """
    grid = LayeredGrid.from_scene(scene, cell_m)
    traversability = grid.traversability.of(body)
    reached = reached_cells(traversability, spawn_cells(traversability, scene))
    if not reached.any():
        raise UsageError("this body cannot enter the scene: it cannot stand at any spawn")
    first = _end("--from", scene, start) if start else _entrance(scene, traversability, reached)
    lengths = metres(
        traversability, spread_wave(traversability, _cell("--from", traversability, first))
    )
    last = _end("--to", scene, goal) if goal else _farthest(scene, traversability, lengths)
    path = find_path(grid, first, last, body=body)
    distance = metres(
        traversability, spread_wave(traversability, _cell("--to", traversability, last))
    )
    return [
        LayerMap(
            title=scene.name,
            number=number,
            body=_body_summary(body),
            corner=(traversability.arrays.x0, traversability.arrays.y0),
            cell_m=cell_m,
            floors=_dense(traversability, number, traversability.arrays.floors, np.nan),
            reachable=_dense(traversability, number, reached, False),
            classes=_dense(traversability, number, traversability.classes.astype(np.int8), -1),
            distance=_dense(traversability, number, distance, np.nan),
            walls=walls_on(
                _dense(traversability, number, traversability.arrays.floors, np.nan),
                traversability,
                body,
            ),
            markers=_markers(scene, grid, number),
            path_summary=_path_summary(path),
            path=path.points[:, :2],
            path_layers=path.layers,
        )
        for number in range(grid.surfaces.layer_count)
    ]


def _end(option: str, scene: Scene, where: Where) -> Point:
    """The point of an end of the path that is given as a point or the name of a place."""
    if not isinstance(where, str):
        return where
    try:
        place = scene.place(where)
    except KeyError as error:
        raise UsageError(f"{option}: {error.args[0]}") from None
    return *place.position, place.z_m


def _cell(option: str, traversability: Traversability, point: Point) -> int:
    cell = cell_near(traversability, point, _NEAR_M)
    if cell < 0:
        x, y, z = point
        raise UsageError(f"{option}: this body cannot stand near ({x:g}, {y:g}, {z:g})")
    return cell


def _entrance(scene: Scene, traversability: Traversability, reached: NDArray[np.bool_]) -> Point:
    """The first spawn or place that is reached."""
    for part in (*scene.spawns, *scene.places):
        point = (*part.position, part.z_m)
        cell = cell_near(traversability, point, _NEAR_M)
        if cell >= 0 and reached[cell]:
            return point
    return _centre(traversability, int(reached.argmax()))


def _farthest(
    scene: Scene, traversability: Traversability, path_lengths: NDArray[np.float32]
) -> Point:
    """The place with the longest path to it; in a scene without places, the cell."""
    lengths = np.where(np.isfinite(path_lengths), path_lengths, -1.0)
    points: list[Point] = [(*place.position, place.z_m) for place in scene.places]
    cells = {point: cell_near(traversability, point, _NEAR_M) for point in points}
    return max(
        (point for point in points if cells[point] >= 0),
        key=lambda point: float(lengths[cells[point]]),
        default=_centre(traversability, int(lengths.argmax())),
    )


def _centre(traversability: Traversability, cell: int) -> Point:
    x, y, z = (float(value) for value in centres(traversability)[cell])
    return x, y, z


def _dense(
    traversability: Traversability, layer: int, values: NDArray[Any], nothing: float
) -> NDArray[Any]:
    """The values of a layer as (rows, columns), with `nothing` where it has no floor."""
    a = traversability.arrays
    own = (a.places["layer"] == layer) & np.isfinite(a.floors)
    dense = np.full((a.ny, a.nx), nothing, dtype=values.dtype)
    dense[a.places["row"][own], a.places["column"][own]] = values[own]
    return dense


def walls_on(floors: Floats, traversability: Traversability, body: Body) -> Floats:
    """The barriers that stop a body that stands beside them on one layer.

    `floors` is (rows, columns), metres. The result is x0, y0, x1, y1, float64 (S, 4), metres.
    """
    rows, a = traversability.near.barriers, traversability.arrays
    lines = np.stack([rows[name] for name in ("x0", "y0", "x1", "y1")], axis=1)
    ends = lines.reshape(-1, 2, 2)
    along = ends[:, 1] - ends[:, 0]
    normal = np.stack([-along[:, 1], along[:, 0]], axis=1)
    normal *= 0.5 * a.cell_m / np.maximum(np.hypot(*along.T), 1e-9)[:, None]
    stops = np.zeros(len(rows), dtype=np.bool_)
    for share in _ALONG:
        for side in (-1.0, 1.0):
            x, y = (ends[:, 0] + share * along + side * normal).T
            i, j = ((x - a.x0) // a.cell_m).astype(int), ((y - a.y0) // a.cell_m).astype(int)
            inside = (i >= 0) & (i < a.nx) & (j >= 0) & (j < a.ny)
            z = np.full(len(rows), np.nan)
            z[inside] = floors[j[inside], i[inside]]
            stops |= (rows["bottom_m"] < z + body.height_m) & (rows["top_m"] > z + body.step_on_m)
    return lines[stops & (rows["climb_m"] > body.step_on_m)]


def _markers(scene: Scene, grid: LayeredGrid, layer: int) -> tuple[Marker, ...]:
    """The markers of the spawns, the places, and where portals let people out, on a layer."""
    spawns = [
        (f"spawn {i}", spawn.position, spawn.z_m, True) for i, spawn in enumerate(scene.spawns)
    ]
    places = [(place.name, place.position, place.z_m, False) for place in scene.places]
    portals = [
        (f"portal {portal.name}", portal.arrival_place[:2], portal.z_m, False)
        for portal in scene.portals
    ]
    return tuple(
        Marker(name, position, is_spawn)
        for name, position, z_m, is_spawn in (*spawns, *places, *portals)
        if grid.layer_at(position, z_m) == layer
    )


def _path_summary(path: LayeredPath) -> str:
    if path.status is PathStatus.FOUND:
        return f"{path.length_m:.1f} m"
    return path.status.name.lower().replace("_", " ")


def _body_summary(body: Body) -> str:
    return (
        f"{body.height_m:g} m tall, radius {body.radius_m:g} m,\n"
        f"steps {body.step_on_m:g} m, leg {body.leg_length_m:g} m"
    )
