"""The cost of planning: a tick of many actors among many people, by stage.

    python -m benchmarks.planning                        100 actors among 0 and 100 people
    python -m benchmarks.planning --actors 100 300 1000 --people 0 100 500 --cell-m 0.25 0.5

The world is 64 m x 64 m, and buildings cover a tenth of it. People walk from place to place at
1.2 m/s. Actors do the same, and each goes to another place when it has arrived. There are four
stages: `order` updates the followed paths and assigns priorities, `decide` indexes people and
decides for every actor (perturbation and search), `resolve` takes the steps in order of priority,
and `rest` is all else: observation, prediction, and making states. On one thread the first three
are one call, `decide`. At the end it prints how medians grow with actors, people and cells, while
the other two have their greatest values.
"""

import argparse
import gc
import resource
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import Any, NamedTuple
from unittest import mock

import numpy as np
from numpy.typing import NDArray

from esplanade.actors import Navigator, Reason
from esplanade.planning import Batch, LayeredGrid, PlanModel, Polygon, Potential, Scene, Spawn, Wave
from esplanade.planning.agents import batch

SIDE_M = 64.0
BUILT_PART = 0.1
CELL_M = 0.25
TICK_S = 0.05
PLACES = 40
WALK_MPS = 1.2
WARM_UP_TICKS = 30


def main(argv: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.planning", description=__doc__)
    parser.add_argument("--actors", type=int, nargs="+", default=[100])
    parser.add_argument("--people", type=int, nargs="+", default=[0, 100])
    parser.add_argument("--cell-m", type=float, nargs="+", default=[CELL_M], help="sizes of cells")
    parser.add_argument("--ticks", type=int, default=60, help="measured ticks of each case")
    parser.add_argument("--threads", type=int, default=2)
    options = parser.parse_args(argv)

    scene = make_scene(np.random.default_rng(0))
    medians: dict[Case, float] = {}
    for cell_m in options.cell_m:
        begun = time.perf_counter()
        grid = LayeredGrid.from_scene(scene, cell_m)
        took = 1e3 * (time.perf_counter() - begun)
        full = built_part(grid)
        size = f"{SIDE_M:g} m x {SIDE_M:g} m in cells of {cell_m:g} m"
        print(f"{size}, {full:.0%} built: made in {took:.0f} ms")
        print_goals(grid)
        for actors in options.actors:
            for people in options.people:
                case = Case(actors, people, len(grid.surfaces))
                medians[case] = print_case(grid, case, options.ticks, options.threads)
    print_growth(medians)


class Case(NamedTuple):
    """The numbers of actors, people and cells of one measurement."""

    actors: int
    people: int
    cells: int


def make_scene(random: np.random.Generator) -> Scene:
    """A scene with random buildings that cover their part of the ground."""
    buildings: list[Polygon] = []
    scene = Scene.open_space((0.0, 0.0, SIDE_M, SIDE_M))
    grid = LayeredGrid.from_scene(scene, CELL_M)
    while built_part(grid) < BUILT_PART:
        x, y = random.uniform(2.0, SIDE_M - 8.0, 2).tolist()
        w, d = random.uniform(2.0, 6.0, 2).tolist()
        ring = ((x, y), (x + w, y), (x + w, y + d), (x, y + d))
        buildings.append(Polygon(points=ring, height_m=6.0))
        scene = Scene(
            bounds=(0.0, 0.0, SIDE_M, SIDE_M),
            polygons=tuple(buildings),
            spawns=(Spawn(position=(1.0, 1.0)),),
        )
        grid = LayeredGrid.from_scene(scene, CELL_M)
    return scene


def built_part(grid: LayeredGrid) -> float:
    """The part of the ground that buildings cover."""
    return 1.0 - len(grid.surfaces) / (grid.layered.nx * grid.layered.ny)


def free_points(grid: LayeredGrid, count: int, random: np.random.Generator) -> NDArray[np.float64]:
    """Random points (count, 2), metres, at which a disc of 0.5 m is free, with some spacing."""
    found: list[NDArray[np.float64]] = []
    apart = min(3.0, 0.5 * SIDE_M / np.sqrt(count + 1))
    while len(found) < count:
        point = random.uniform(1.0, SIDE_M - 1.0, 2)
        near = found and np.hypot(*(np.array(found) - point).T).min() < apart
        if not near and grid.is_free([point], [0], 0.5)[0]:
            found.append(point)
    return np.array(found)


def print_goals(grid: LayeredGrid) -> None:
    """Print the time of a wave front for a new goal."""
    goals = free_points(grid, 6, np.random.default_rng(3))
    for wave in Wave:
        times = []
        for goal in goals:
            begun = time.perf_counter()
            potential = Potential(grid, (goal[0], goal[1]), 0, 0.25, wave)
            times.append(1e3 * (time.perf_counter() - begun))
        size = potential.values.nbytes / 1e6
        name, took = wave.name.lower(), np.median(times[1:])
        print(f"new goal, {name:5s}: {took:6.1f} ms, {size:.1f} MB kept")


class SimulatedPeople:
    """People who walk to random places, change them about every ten seconds, and slide along
    walls."""

    def __init__(self, grid: LayeredGrid, count: int, random: np.random.Generator) -> None:
        self._grid = grid
        self._random = random
        self.positions = free_points(grid, count, random) if count else np.zeros((0, 2))
        self._targets = random.uniform(1.0, SIDE_M - 1.0, (count, 2))
        self._layers = np.zeros(count, dtype=np.int64)

    def walk(self) -> dict[str, tuple[float, float]]:
        turning = self._random.random(len(self.positions)) < TICK_S / 10.0
        fresh = self._random.uniform(1.0, SIDE_M - 1.0, self.positions.shape)
        self._targets[turning] = fresh[turning]
        way = self._targets - self.positions
        length = np.maximum(1.0, np.hypot(way[:, 0], way[:, 1]))[:, None]
        steps = WALK_MPS * TICK_S * way / length
        self.positions, _ = self._grid.walk(self.positions, self._layers, steps, 0.25)
        return {f"p{k}": (x, y) for k, (x, y) in enumerate(self.positions.tolist())}


class Stopwatch:
    """The seconds of calls by stage; functions are wrapped from outside."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        begun = time.perf_counter()
        yield
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - begun

    def around(self, name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def timed(*arguments: Any, **named: Any) -> Any:
            with self.stage(name):
                return function(*arguments, **named)

        return timed


def print_case(grid: LayeredGrid, case: Case, ticks: int, threads: int) -> float:
    """Measure one case, print its times, and return the median of a tick in milliseconds."""
    random = np.random.default_rng(1)
    places = free_points(grid, PLACES, random)
    people = SimulatedPeople(grid, case.people, random)
    nav = Navigator(grid, TICK_S, seed=0, plan=PlanModel(threads=threads))

    def another_place() -> tuple[float, float]:
        x, y = places[random.integers(PLACES)]
        return float(x), float(y)

    for k, (x, y) in enumerate(free_points(grid, case.actors, random).tolist()):
        nav.add_actor(f"a{k}", (x, y), another_place())

    gc.collect()
    gc.freeze()  # the server does the same
    watch = Stopwatch()
    rows: list[dict[str, float]] = []
    with ExitStack() as patches:
        for target, attribute, stage in (
            (Batch, "tick", "batch"),
            (batch, "put_in_order", "order"),
            (batch, "take_steps", "resolve"),
        ):
            timed = watch.around(stage, getattr(target, attribute))
            patches.enter_context(mock.patch.object(target, attribute, timed))
        for _ in range(WARM_UP_TICKS + ticks):
            seen = people.walk()
            watch.seconds = {}
            with watch.stage("all"):
                nav.observe(seen)
                states = nav.tick()
            rows.append(watch.seconds)
            for actor, state in states.items():
                if state.reason is Reason.ARRIVED:
                    nav.set_goal(actor, another_place())
    nav.close()
    return print_rows(case, rows[WARM_UP_TICKS:])


def print_rows(case: Case, rows: list[dict[str, float]]) -> float:
    """Print one line for a case; returns the median of the whole tick in milliseconds."""
    names = ("all", "batch", "order", "resolve")
    spent = {name: 1e3 * np.array([row.get(name, 0.0) for row in rows]) for name in names}
    spent["decide"] = spent["batch"] - spent["order"] - spent["resolve"]
    spent["rest"] = spent["all"] - spent["batch"]
    parts = "  ".join(
        f"{name} {np.median(spent[name]):.2f}" for name in ("order", "decide", "resolve", "rest")
    )
    median = float(np.median(spent["all"]))
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(
        f"{case.actors:5d} actors {case.people:4d} people: p50 {median:7.2f} ms  "
        f"p99 {np.percentile(spent['all'], 99):7.2f} ms  ({parts})  at most {memory:.0f} MB"
    )
    return median


def print_growth(medians: dict[Case, float]) -> None:
    """Print how the median grows with each number while the others have their greatest values."""
    most = Case(*(max(column) for column in zip(*medians, strict=True)))
    for name in Case._fields:
        line = sorted(c for c in medians if c == most._replace(**{name: getattr(c, name)}))
        if len(line) > 1:
            steps = ", ".join(f"{getattr(case, name)}: {medians[case]:.1f}" for case in line)
            rest = ", ".join(f"{n} {v}" for n, v in most._asdict().items() if n != name)
            print(f"ms by {name} ({rest}): {steps}")


if __name__ == "__main__":
    main()
