"""One crowd among walking people, moved by our planner, by DetourCrowd and by ORCA, side by side.

    python -m benchmarks.crowds                         1000 actors among 500 people
    python -m benchmarks.crowds --actors 100 300 --people 100 --intervals 1

The ground is that of `benchmarks.planning`. Everybody has the same actors, trips and people, who
look at nobody. In each tick all movers move their actors one after the other, each first in turn,
so that whatever else the machine does disturbs all of them alike. Times are processor time on one
thread. DetourCrowd runs in WebAssembly, as on npm; its update is timed, with its routes, and the
part of people in it. Of ORCA only the step is timed, since it finds no routes: it is given ours.
`met people` and `met actors` are overlaps of discs that begin, `trips` those that end, within half
a metre of the goal: all by actor and minute. Movers that are not installed are left out, and told.
"""

import argparse
import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

import numpy as np
from benchmarks._crowd_movers import RADIUS_M, Floats, Mover, movers_of
from benchmarks.planning import CELL_M, PLACES, TICK_S, SimulatedPeople, free_points, make_scene
from numpy.typing import NDArray
from rich import box
from rich.console import Console
from rich.table import Table
from scipy.spatial import cKDTree

from esplanade.planning import LayeredGrid, Scene

WARM_UP_TICKS: Final = 40
TRIPS: Final = 64
"""More trips than anybody makes."""
ARRIVED_M: Final = 0.5


@dataclass(frozen=True)
class Start:
    """The crowd as it begins; see `benchmarks._crowd_movers.Crowd`."""

    scene: Scene
    grid: LayeredGrid
    tick_s: float
    places: Floats
    starts: Floats
    trips: NDArray[np.int64]
    """Rows of `places` that each actor goes to, one after the other, (A, TRIPS)."""
    people: Floats

    @property
    def goals(self) -> NDArray[np.int64]:
        """The first goals."""
        return self.trips[:, 0]


@dataclass(frozen=True)
class Figures:
    """Time that one mover took, and the figures of its walk."""

    mover: str
    actors: int
    people: int
    ms: float
    """Processor time of a tick, median."""
    p99_ms: float
    us_an_actor: float
    with_people: float
    """Contacts of an actor with people in a minute."""
    with_actors: float
    trips: float
    """Trips of an actor in a minute."""


class Watched:
    """One mover and what was seen of it."""

    def __init__(self, mover: Mover, start: Start) -> None:
        self.mover = mover
        self._start = start
        self._done = np.zeros(len(start.starts), dtype=np.int64)
        self._changed: NDArray[np.int64] = np.zeros(0, dtype=np.int64)
        self._touching: tuple[NDArray[np.int64], ...] = (self._changed, self._changed)
        self.took_s: list[float] = []
        self.contacts = np.zeros(2)
        self.trips = 0

    def tick(self, people: Floats, speeds: Floats, *, counts: bool) -> None:
        """Move the actors by a tick, and count it unless everybody is still getting going."""
        actors = np.arange(len(self._done))
        goals = self._start.trips[actors, self._done % TRIPS]
        places, took = self.mover.tick(goals, self._changed, people, speeds)
        away = np.hypot(*(places - self._start.places[goals]).T)
        self._changed = np.flatnonzero(away <= ARRIVED_M)
        self._done[self._changed] += 1
        touching = _touching(places, people), _touching(places, None)
        if counts:
            self.took_s.append(took)
            self.trips += len(self._changed)
            for k, (now, before) in enumerate(zip(touching, self._touching, strict=True)):
                self.contacts[k] += len(np.setdiff1d(now, before, assume_unique=True))
        self._touching = touching

    def figures(self) -> Figures:
        """Time that it took, and the figures of its walk."""
        took_ms = 1e3 * np.array(self.took_s)
        actors = len(self._done)
        minutes = actors * len(took_ms) * self._start.tick_s / 60.0
        return Figures(
            self.mover.name,
            actors,
            len(self._start.people),
            float(np.median(took_ms)),
            float(np.percentile(took_ms, 99)),
            float(1e3 * np.median(took_ms) / actors),
            float(self.contacts[0] / minutes),
            float(2.0 * self.contacts[1] / minutes),
            self.trips / minutes,
        )


def main(argv: Sequence[str] | None = None) -> None:
    options = parser().parse_args(argv)
    console = Console()
    scene = make_scene(np.random.default_rng(0))
    grid = LayeredGrid.from_scene(scene, CELL_M)
    found: list[Figures] = []
    for people in options.people:
        for actors in options.actors:
            figures, absent = measure(scene, grid, actors, people, options.ticks, options.intervals)
            found += figures
            for why in absent:
                console.print(f"skipped: {why}")
    console.print(table_of(found))
    if options.json is not None:
        rows = [asdict(each) for each in found]
        options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


def parser() -> argparse.ArgumentParser:
    """The options."""
    made = argparse.ArgumentParser(prog="python -m benchmarks.crowds", description=__doc__)
    made.formatter_class = argparse.RawDescriptionHelpFormatter
    made.add_argument("--actors", type=int, nargs="+", default=[1000])
    made.add_argument("--people", type=int, nargs="+", default=[500])
    made.add_argument("--ticks", type=int, default=200, help="measured ticks of each case [200]")
    made.add_argument(
        "--intervals", type=int, nargs="+", default=[1, 2, 4], help="of our planning, ticks [1 2 4]"
    )
    made.add_argument("--json", type=Path, metavar="F", help="also write the figures here")
    return made


def start_of(scene: Scene, grid: LayeredGrid, actors: int, people: Floats) -> Start:
    """A crowd on a level ground: where everybody starts, and where actors go."""
    random = np.random.default_rng(1)
    places = free_points(grid, PLACES, random)
    starts = free_points(grid, actors, random)
    trips = random.integers(PLACES, size=(actors, TRIPS))
    return Start(scene, grid, TICK_S, places, starts, trips, people)


def measure(
    scene: Scene, grid: LayeredGrid, actors: int, people: int, ticks: int, intervals: Sequence[int]
) -> tuple[list[Figures], list[str]]:
    """The figures of every mover that is there, and why others are not."""
    walking = SimulatedPeople(grid, people, np.random.default_rng(2))
    start = start_of(scene, grid, actors, walking.positions.copy())
    movers, absent = movers_of(start, intervals)
    watched = [Watched(mover, start) for mover in movers]
    try:
        for tick in range(WARM_UP_TICKS + ticks):
            before = walking.positions.copy()
            walking.walk()
            speeds = (walking.positions - before) / TICK_S
            first = tick % len(watched)
            for each in watched[first:] + watched[:first]:
                each.tick(walking.positions, speeds, counts=tick >= WARM_UP_TICKS)
    finally:
        for each in watched:
            each.mover.close()
    return [each.figures() for each in watched], absent


def table_of(found: Sequence[Figures]) -> Table:
    """A table with a row for every mover and crowd."""
    table = Table(box=box.SIMPLE)
    table.add_column("", no_wrap=True)
    titles = ("actors", "people", "ms a tick", "p99", "µs an actor")
    for title in (*titles, "met people", "met actors", "trips"):
        table.add_column(title, justify="right")
    for each in found:
        table.add_row(
            each.mover,
            f"{each.actors}",
            f"{each.people}",
            f"{each.ms:.1f}",
            f"{each.p99_ms:.1f}",
            f"{each.us_an_actor:.1f}",
            f"{each.with_people:.2f}",
            f"{each.with_actors:.2f}",
            f"{each.trips:.2f}",
        )
    return table


def _touching(places: Floats, people: Floats | None) -> NDArray[np.int64]:
    """Pairs of discs that overlap, of actors with people or among actors, as one number each."""
    near = cKDTree(places)
    if people is None:
        pairs = near.query_pairs(2.0 * RADIUS_M, output_type="ndarray").astype(np.int64)
    elif len(people):
        found = near.sparse_distance_matrix(cKDTree(people), 2.0 * RADIUS_M, output_type="ndarray")
        pairs = np.column_stack([found["i"], found["j"]]).astype(np.int64)
    else:
        pairs = np.zeros((0, 2), dtype=np.int64)
    return np.sort(pairs[:, 0] * 1_000_000 + pairs[:, 1])


if __name__ == "__main__":
    main()
