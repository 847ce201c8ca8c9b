"""The cost of paths over several floors, stage by stage.

    python -m benchmarks.layered                 the paper's size and a large one
    python -m benchmarks.layered --runs 50       the best of more runs

Stages are those of Huang & Li, fig. 9: height maps (surfaces, links, barriers), reachability,
the five classes, and search, which here is potential, STABLE_BFP and straightening. The scene is
a building: floors 3 m apart, each with rooms, joined by flights of stairs. Everything is compiled
and has run once before it is measured. Times are processor times, as nothing here waits or runs
on a second thread.
"""

import argparse
import time
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np

from esplanade.planning import Body, Door, LayeredGrid, Polygon, Scene, Stairs, Wall
from esplanade.planning.ground.barriers import Barriers, barriers_of_scene
from esplanade.planning.ground.layered import LayeredArrays
from esplanade.planning.ground.surfaces import surfaces_of_scene
from esplanade.planning.routes.find_path import PathStatus, find_endpoint, find_route
from esplanade.planning.traversal.cache import find_traversability, renew_traversability
from esplanade.planning.traversal.reachability import near_barriers, reachable_steps
from esplanade.planning.traversal.stability import classify
from esplanade.planning.traversal.traversability import Traversability

CELL_M = 0.25
STOREY_M = 3.0
SLAB_M = 0.25
SETBACK_M = 6.0
ROOM_M = 8.0
PAPER_MS = {"height maps": 10.0, "reachability": 40.0, "classes": 170.0, "search": 20.0}

Result = TypeVar("Result")


def main(argv: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.layered", description=__doc__)
    parser.add_argument("--runs", type=int, default=15, help="runs of which the best is told")
    options = parser.parse_args(argv)
    measure(64, 2, 1)
    print("milliseconds; paper: 128x128x2 on an AMD of 1.2 GHz")
    names = [*PAPER_MS, "whole"]
    print(f"{'cells':>14s} {'held':>8s}" + "".join(f"{name:>14s}" for name in names))
    paper = [*PAPER_MS.values(), sum(PAPER_MS.values())]
    print(f"{'paper':>14s} {'':>8s}" + "".join(f"{value:14.1f}" for value in paper))
    for side, layers in ((128, 1), (128, 2), (128, 4), (256, 2), (512, 2), (512, 4)):
        cells, times = measure(side, layers, options.runs)
        row = "".join(f"{value:14.2f}" for value in (*times, sum(times)))
        print(f"{f'{side}x{side}x{layers}':>14s} {cells:8d}{row}", flush=True)
    for side, layers in ((128, 2), (512, 4)):
        print_door(side, layers, options.runs)


def building(side: int, layers: int) -> Scene:
    """A building whose storeys are set back; each has rooms, and stairs lead up the setbacks."""
    width = side * CELL_M
    polygons, walls, stairs = [], [], []
    for floor in range(layers):
        z, west = STOREY_M * floor, SETBACK_M * floor
        if floor:
            ring = ((west, 0.0), (width, 0.0), (width, width), (west, width))
            polygons.append(Polygon(points=ring, offset_m=z - SLAB_M, height_m=SLAB_M))
            foot, head = (west - SETBACK_M + 1.0, 4.0), (west, 4.0)
            stairs.append(
                Stairs(start=foot, end=head, width_m=2.0, bottom_m=z - STOREY_M, top_m=z, steps=17)
            )
        for x in np.arange(west + SETBACK_M + 2.0, width - ROOM_M, ROOM_M).tolist():
            for y in np.arange(1.0, width - ROOM_M, ROOM_M).tolist():
                for start, end in (
                    ((x, y), (x, y + 3.0)),
                    ((x, y + 4.5), (x, y + ROOM_M)),
                    ((x, y), (x + ROOM_M - 1.5, y)),
                ):
                    walls.append(Wall(start=start, end=end, height_m=2.5, offset_m=z))
    middle = 0.5 * width
    return Scene(
        bounds=(0.0, 0.0, width, width),
        polygons=tuple(polygons),
        walls=tuple(walls),
        stairs=tuple(stairs),
        doors=(Door(name="gate", start=(middle, middle), end=(middle + 1.0, middle)),),
    )


def measure(side: int, layers: int, runs: int) -> tuple[int, list[float]]:
    """The number of cells, and the milliseconds of each stage."""
    scene, body = building(side, layers), Body.adult()

    def height_maps() -> tuple[LayeredArrays, Barriers]:
        surfaces = surfaces_of_scene(scene, CELL_M)
        arrays = surfaces.layered()
        return arrays, barriers_of_scene(scene, surfaces, arrays)

    maps_ms, (arrays, barriers) = best_ms(height_maps, runs)
    reach_ms, near = best_ms(lambda: near_barriers(arrays, barriers, body), runs)
    steps_ms, _ = best_ms(lambda: reachable_steps(arrays, near, body), runs)
    _, offsets = reachable_steps(arrays, near, body)
    classes_ms, _ = best_ms(lambda: classify(arrays, near, body, offsets), runs)
    traversability = find_traversability(arrays, barriers, body)
    search_ms, _ = best_ms(lambda: search(traversability, side, layers), runs)
    return len(arrays.floors), [maps_ms, reach_ms + steps_ms, classes_ms, search_ms]


def search(traversability: Traversability, side: int, layers: int) -> float:
    """The length of the path from a corner of the ground to a corner of the highest floor.

    Raises
    ------
    RuntimeError
        There is no such path.
    """
    width = side * CELL_M
    start = (0.5 * width, width - 0.6, 0.0)
    goal = (width - 0.6, 0.5 * width + 0.4, STOREY_M * (layers - 1))
    first, last = find_endpoint(traversability, start), find_endpoint(traversability, goal)
    if first is None or last is None:
        raise RuntimeError(f"a body cannot stand at an end in {side}x{side}x{layers}")
    path = find_route(traversability, first, last)
    if path.status is not PathStatus.FOUND:
        raise RuntimeError(f"there is no path in {side}x{side}x{layers}: {path.status.name}")
    return path.length_m


def print_door(side: int, layers: int, runs: int) -> None:
    """Print the cost of closing a door, beside that of deriving everything again."""
    body = Body.adult()
    grid = LayeredGrid.from_scene(building(side, layers), CELL_M)
    traversability = find_traversability(grid.layered, grid.barriers, body)
    grid.doors.set_open("gate", is_open=False)
    row = grid.doors.rows["gate"]
    door_ms, _ = best_ms(lambda: renew_traversability(traversability, body, row), runs)
    whole_ms, _ = best_ms(lambda: find_traversability(grid.layered, grid.barriers, body), runs)
    print(
        f"one door at {side}x{side}x{layers}: {door_ms:.3f} ms, "
        f"everything for a body: {whole_ms:.2f} ms"
    )
    live_ms, _ = best_ms(lambda: grid.set_door("gate", not grid.doors.is_open("gate")), runs)
    anew_ms, _ = best_ms(lambda: LayeredGrid(grid.floors), min(runs, 3))
    print(f"{'the same in a live grid:':>24s} {live_ms:.3f} ms, all of it: {anew_ms:.2f} ms")


def best_ms(work: Callable[[], Result], runs: int) -> tuple[float, Result]:
    """The least processor time of some runs, after one that does not count, and the result."""
    result = work()
    times = []
    for _ in range(runs):
        begun = time.thread_time()
        result = work()
        times.append(1e3 * (time.thread_time() - begun))
    return min(times), result


if __name__ == "__main__":
    main()
