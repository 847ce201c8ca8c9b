"""Small worlds of several floors, and a walker that tries whether a way can be walked."""

from __future__ import annotations

import math
from itertools import pairwise

from hypothesis import strategies as st

from esplanade.planning import Body, LayeredGrid, LayeredPath, Polygon, Scene, Stairs, Wall
from esplanade.planning.traversal.cache import find_traversability
from tests.naive.floors import SLACK_M, Floors, line_of
from tests.naive.geometry import segment_distance
from tests.planning.worlds import UPPER_M

CELL_M = 0.25
SLAB_FROM = 8.0
STAIRS_FROM = 2.96
"""The upper floor of `storeyed`, and the flight that leads up to it, begin here along x."""


def box(x0: float, y0: float, x1: float, y1: float, height_m: float, offset_m: float = 0.0):
    """A prism over a rectangle, whose top carries."""
    ring = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
    return Polygon(points=ring, height_m=height_m, offset_m=offset_m)


def scene_of(side_m, polygons=(), walls=(), stairs=(), doors=()) -> Scene:
    """A square of ground with things on it."""
    return Scene(
        bounds=(0.0, 0.0, side_m, side_m),
        polygons=tuple(polygons),
        walls=tuple(walls),
        stairs=tuple(stairs),
        doors=tuple(doors),
    )


def grid_of(side_m, polygons=(), walls=(), stairs=(), doors=()) -> LayeredGrid:
    """The same scene as a grid."""
    return LayeredGrid.from_scene(scene_of(side_m, polygons, walls, stairs, doors), CELL_M)


def traversability(grid: LayeredGrid, body: Body):
    """The traversability of a grid for a body, derived afresh."""
    return find_traversability(grid.layered, grid.barriers, body)


def _on(low: int, high: int) -> st.SearchStrategy[float]:
    """Sixteenths of a metre, which binary fractions hold exactly."""
    return st.integers(low * 16, high * 16).map(lambda v: v / 16)


@st.composite
def cluttered(draw, side_m: int = 4) -> LayeredGrid:
    """Platforms, slabs and walls, anyhow."""
    polygons = []
    for _ in range(draw(st.integers(0, 4))):
        x, y = draw(_on(0, side_m - 1)), draw(_on(0, side_m - 1))
        width, depth = draw(_on(1, 2)), draw(_on(1, 2))
        offset = draw(st.sampled_from([0.0, 0.0, 0.0, 1.5, 2.0, 2.25]))
        height = 0.25 if offset else draw(st.sampled_from([0.125, 0.25, 0.5, 0.75, 1.0, 2.5]))
        polygons.append(box(x, y, x + width, y + depth, height, offset))
    walls = []
    for _ in range(draw(st.integers(0, 2))):
        start, end = (draw(st.tuples(_on(0, side_m), _on(0, side_m))) for _ in range(2))
        if start != end:
            height = draw(st.sampled_from([0.5, 0.7, 0.8, 2.0]))
            walls.append(Wall(start=start, end=end, height_m=height))
    return grid_of(float(side_m), polygons, walls)


BODIES = (
    Body.adult(),
    Body.child(),
    Body(radius_m=0.4, edge_cells=3),
    Body(radius_m=0.1, height_m=1.0, step_on_m=0.2, leg_length_m=0.5, edge_cells=1),
)
bodies = st.sampled_from(BODIES)


def walk_through(path: LayeredPath, grid: LayeredGrid, body: Body) -> None:
    """Follow a path with the whole body; fails where a body could not go."""
    floors = Floors(grid.layered, grid.barriers, body)
    classes = grid.traversability.of(body).classes
    a = grid.layered
    assert len(path.points) == len(path.layers) == len(path.headings)
    count, last = 0, None
    for k, ((x, y, z), layer) in enumerate(zip(path.points, path.layers, strict=True)):
        j, i = int((y - a.y0) / a.cell_m - 1e-9), int((x - a.x0) / a.cell_m - 1e-9)
        near = [
            cell
            for jj in (j, j + 1)
            for ii in (i, i + 1)
            if (cell := floors.cells.get((int(layer), jj, ii))) is not None
            and abs(floors.floor(cell) - z) < 1e-6
            and max(abs(v - c) for v, c in zip((x, y), floors.centre(cell), strict=True))
            <= 0.5 * a.cell_m + 1e-9
        ]
        if not near and last is not None:
            # The bend of a step may lie beside its two cells.
            away = max(abs(v - c) for v, c in zip((x, y), floors.centre(last), strict=True))
            assert away <= a.cell_m, f"point {k} lies on no floor"
            continue
        assert all(floors.ceiling(cell) - z >= body.height_m - 1e-3 for cell in near)
        cell = last if last in near else near[0]
        if cell != last:
            count = 0 if last is None or classes[cell] == 1 else count + 1
        assert count < body.edge_cells, f"point {k} stays on edges for too long"
        last = cell
    for (px, py, pz), (qx, qy, qz) in pairwise(path.points):
        assert abs(pz - qz) <= body.step_on_m + 1e-3
        assert math.hypot(qx - px, qy - py) <= 2.2 * a.cell_m
        for barrier in grid.barriers:
            line = line_of(barrier)
            if floors.height_to_climb(barrier, pz, qz) > body.step_on_m + 1e-3:
                assert not _meet((px, py), (qx, qy), *line), f"{barrier} is crossed"
    leg = body.leg_length_m + 1e-3
    for (px, py, pz), (qx, qy, qz) in pairwise(path.points):
        for barrier in grid.barriers:
            if min(floors.height_to_climb(barrier, pz), floors.height_to_climb(barrier, qz)) > leg:
                line = line_of(barrier)
                away = segment_distance((px, py), (qx, qy), *line)
                enough = body.radius_m - SLACK_M - 1e-3
                assert away >= enough, f"{barrier} is only {away} m away"


def _meet(a, b, c, d) -> bool:
    """Whether ab and cd cross, touching not included."""

    def side(p, q, r):
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    return side(a, b, c) * side(a, b, d) < -1e-9 and side(c, d, a) * side(c, d, b) < -1e-9


def flight(start, end, width_m, top_m, steps, bottom_m=0.0) -> Stairs:
    """A flight of stairs."""
    return Stairs(
        start=start, end=end, width_m=width_m, bottom_m=bottom_m, top_m=top_m, steps=steps
    )


def storeyed(polygons=(), walls=(), doors=()) -> Scene:
    """16 m x 12 m of ground, an upper floor over its eastern half, and a flight up to it.

    The flight is 2 m wide about y = 6 and rises eastward.
    """
    upper = box(SLAB_FROM, 0.0, 16.0, 12.0, 0.3, offset_m=3.0).model_copy(update={"kind": "floor"})
    return Scene(
        bounds=(0.0, 0.0, 16.0, 12.0),
        polygons=(upper, *polygons),
        walls=tuple(walls),
        stairs=(flight((STAIRS_FROM, 6.0), (SLAB_FROM, 6.0), 2.0, UPPER_M, 18),),
        doors=tuple(doors),
    )
