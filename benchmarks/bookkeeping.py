"""The cost of Python in a tick of many actors: everything but the compiled part.

python -m benchmarks.bookkeeping --actors 1000 --people 200

Actors wander over open ground among people who walk. The tick is that of the server: people are
observed, behaviours asked, actors planned and their avatars moved. The time within compiled calls
is taken off.
"""

import argparse
import time
from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np

from esplanade.actors import ObservedPeople, Population, Wander
from esplanade.planning import LayeredGrid, Place, Scene
from esplanade.planning.agents import batch
from esplanade.planning.people import _prediction_kernels
from esplanade.server.world.actors import ActorAvatars
from esplanade.server.world.state import State

SIDE_M = 100.0
TICK_S = 0.05
COMPILED: tuple[tuple[ModuleType, str], ...] = (
    (batch, "plan_and_step"),
    (batch, "has_room"),
    (batch, "put_in_order"),
    (batch, "take_steps"),
    (batch, "settle_all"),
    (_prediction_kernels, "note"),
    (_prediction_kernels, "extrapolate"),
)


class Compiled:
    """Seconds that have been spent within compiled calls."""

    def __init__(self) -> None:
        self.seconds = 0.0
        for module, name in COMPILED:
            setattr(module, name, self._timed(getattr(module, name)))
        pooled = batch.Batch._on_threads  # noqa: SLF001 - its time is what is taken off

        def on_threads(owner: batch.Batch, work: Callable[[int], None], threads: int) -> None:
            begun = time.perf_counter()
            pooled(owner, work, threads)
            self.seconds += time.perf_counter() - begun

        batch.Batch._on_threads = on_threads  # type: ignore[method-assign]  # noqa: SLF001

    def _timed(self, function: Callable[..., Any]) -> Callable[..., Any]:
        def timed(*arguments: Any) -> Any:
            begun = time.perf_counter()
            result = function(*arguments)
            self.seconds += time.perf_counter() - begun
            return result

        return timed


def scene() -> Scene:
    places = tuple(
        Place(name=f"place {k}", position=(10.0 + 80.0 * (k % 4) / 3, 10.0 + 80.0 * (k // 4) / 3))
        for k in range(16)
    )
    return Scene(name="open", bounds=(0.0, 0.0, SIDE_M, SIDE_M), places=places)


def measure(actors: int, people: int, ticks: int) -> tuple[float, float]:
    """Milliseconds of Python and of compiled code in a tick, medians over the ticks."""
    ground = scene()
    grid = LayeredGrid.from_scene(ground)
    population = Population(grid, ground, TICK_S, 1)
    rng = np.random.default_rng(2)
    for k, at in enumerate(rng.uniform(2.0, SIDE_M - 2.0, (actors, 2)).tolist()):
        population.add(f"actor-{k}", Wander(), position=(at[0], at[1]))
    population.warm_up()
    state = State(actors)
    avatars = ActorAvatars(state, population, {f"actor-{k}": "A" for k in range(actors)}, TICK_S)
    places = np.column_stack([rng.uniform(2.0, SIDE_M - 2.0, (people, 2)), np.zeros(people)])
    velocities = np.column_stack([rng.normal(0.0, 0.7, (people, 2)), np.zeros(people)])
    ids = np.arange(1, people + 1)
    compiled = Compiled()
    python_s, compiled_s = [], []
    for tick in range(ticks):
        places = np.clip(places + TICK_S * velocities, 0.0, SIDE_M)
        begun, before = time.perf_counter(), compiled.seconds
        avatars.place(avatars.plan(ObservedPeople(ids, places)))
        took, within = time.perf_counter() - begun, compiled.seconds - before
        if tick >= ticks // 5:
            python_s.append(took - within)
            compiled_s.append(within)
    population.close()
    return 1e3 * float(np.median(python_s)), 1e3 * float(np.median(compiled_s))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--actors", type=int, default=1000, help="actors that wander [1000]")
    parser.add_argument("--people", type=int, default=200, help="people who walk [200]")
    parser.add_argument("--ticks", type=int, default=150, help="ticks to run [150]")
    options = parser.parse_args()
    python_ms, compiled_ms = measure(options.actors, options.people, options.ticks)
    print(
        f"{options.actors} actors, {options.people} people: Python {python_ms:.2f} ms a tick, "
        f"compiled {compiled_ms:.1f} ms"
    )


if __name__ == "__main__":
    main()
