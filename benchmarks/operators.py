"""Measures what commands on actors cost a tick: `python -m benchmarks.operators`.

It prints what a command takes inside its tick, and the ticks of two worlds that run side by side,
of which in one an actor gets another body every second. A table of figures and their goals is the
end; the rows of its audit take some minutes to make.
"""

import argparse
import asyncio
import os
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from itertools import count
from pathlib import Path
from typing import Any, Final

import numpy as np
from benchmarks._goals import Goals
from benchmarks.audit import fill, filters

from esplanade.actors import ActorParameters, Overrides
from esplanade.actors.behaviour_spec import WanderSpec
from esplanade.actors.warming import tables_ahead
from esplanade.planning import LayeredGrid
from esplanade.protocol.commands import AddActors as AddActors_
from esplanade.protocol.commands import Command
from esplanade.protocol.commands import SetParameters as SetParameters_
from esplanade.server.audit.log import AuditLog
from esplanade.server.console.inputs import inputs_for
from esplanade.server.console.intents import intended
from esplanade.server.console.state import OperatedState
from esplanade.server.loading import LoadedScene, load_scene
from esplanade.server.net.ground_work import GroundWork
from esplanade.server.populating import default_roster, names_of, populate_from
from esplanade.server.settings import ServerSettings
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import open_store
from esplanade.server.world.inputs import ActorCommand, AddActors, Input, SetParameters
from esplanade.server.world.outcomes import FaultCode
from esplanade.server.world.zone import Zone

TICK_S: Final = 0.05
RADII_M: Final = (0.3, 0.35, 0.4, 0.45, 0.5, 0.25)
NUMBERS = count(1)


class World:
    """A gallery with so many actors, whose ticks are timed."""

    def __init__(self, loaded: LoadedScene, actors: int, thread: ThreadPoolExecutor) -> None:
        grid = LayeredGrid.from_scene(loaded.scene)
        roster = default_roster(loaded.scene, actors, 1)
        self.population = populate_from(roster, grid, loaded.scene, TICK_S, 1)
        self.zone = Zone(
            loaded.scene,
            grid,
            self.population,
            names_of(roster),
            loaded.rules,
            tick_s=TICK_S,
            max_people=10,
            seed=1,
            clock=time.perf_counter,
            roster=roster.actors,
        )
        self.population.warm_up()
        self.work = GroundWork(self.zone, thread, tables_ahead(self.population.navigator))
        self.ids = tuple(spec.id for spec in roster.actors)
        self.outcomes: dict[int, int] = {}
        """Ticks in which commands were carried out."""

    def tick(self, *inputs: Input) -> tuple[float, float]:
        """Run one tick; returns its milliseconds, and those of processor time of its thread."""
        given = [*inputs, *self.work.drain()]
        start, own = time.perf_counter(), time.thread_time()
        self.zone.begin(given)
        frame = self.zone.finish(self.zone.think())
        took, own = time.perf_counter() - start, time.thread_time() - own
        for outcome in frame.outcomes:
            if outcome.fault is None:
                self.outcomes[outcome.command] = outcome.tick
            elif outcome.fault.code is not FaultCode.SUPERSEDED:
                raise SystemExit(outcome.fault.text)
        return 1e3 * took, 1e3 * own

    def begin(self, command: ActorCommand) -> float:
        """Run one tick with a command; returns the milliseconds of processor time of its begin."""
        start = time.thread_time()
        self.zone.begin([command])
        took = time.thread_time() - start
        self.zone.finish(self.zone.think())
        return 1e3 * took


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.operators", description=__doc__)
    parser.add_argument("--actors", type=int, default=10, help="actors side by side")
    parser.add_argument("--ticks", type=int, default=600, help="ticks side by side")
    parser.add_argument(
        "--audit-rows", type=int, default=1_000_000, help="rows of an audit; 0 leaves it out"
    )
    options = parser.parse_args()
    loaded, goals = load_scene(ServerSettings()), Goals()
    with ThreadPoolExecutor(1) as thread:
        tempers(loaded, thread, goals)
        side_by_side(loaded, options.actors, options.ticks, goals)
    if options.audit_rows:
        goals.add(
            f"a filtered page of {options.audit_rows} rows of the audit, slowest p99",
            asyncio.run(audit(options.audit_rows)),
            50.0,
        )
    goals.print()
    load = ", ".join(f"{value:.1f}" for value in os.getloadavg())
    print(f"load of this machine lately: {load}, with {os.cpu_count()} cores")
    return 0


def tempers(loaded: LoadedScene, thread: ThreadPoolExecutor, goals: Goals) -> None:
    """Print what a change of temper takes inside its tick."""
    world = World(loaded, 500, thread)
    for _ in range(10):
        world.tick()
    for number in (1, 10, 500):
        ids = world.ids[:number]
        times = {"empty": [], "one field": [], "six fields": []}  # type: dict[str, list[float]]
        for k in range(60):
            one: dict[str, Any] = {"risk_weight": 9.0 + 0.01 * k}
            names = ("foresight_s", "turn_weight", "wall_weight", "hurry_weight", "catch_up")
            six = one | dict.fromkeys(names, 0.3 + 0.001 * k)
            times["empty"].append(world.begin(SetParameters(next(NUMBERS), (), {})))
            times["one field"].append(world.begin(SetParameters(next(NUMBERS), ids, one)))
            times["six fields"].append(world.begin(SetParameters(next(NUMBERS), ids, six)))
        for name, found in times.items():
            p50, p99 = np.percentile(found, [50, 99])
            print(f"{name:10} of {number:3} actors: p50 {p50:6.3f} ms, p99 {p99:6.3f} ms")
            if number == 500 and name != "empty":
                empty = float(np.median(times["empty"]))
                what = f"temper of {number} actors inside its tick, {name}"
                goals.add(f"{what}, p50", p50 - empty, 2.0)
                goals.add(f"{what}, p99", p99 - empty, 2.0)
    planned(world, goals)
    world.population.close()


def planned(world: World, goals: Goals) -> None:
    """Measure the processor time of planning a change on the event loop, before its tick."""
    state, numbers = OperatedState(world.zone, Overrides()), count(1)
    commands: dict[str, Command] = {
        "of the world": SetParameters_(
            op="set_parameters", scope="world", values={"risk_weight": 9.5, "foresight_s": 3.0}
        ),
        "that adds 200 actors": AddActors_(op="add_actors", count=200),
    }
    for name, command in commands.items():
        taken = []
        for _ in range(20):
            start = time.thread_time()
            facts = intended(command, state, {})
            inputs, _ = inputs_for(facts, state, lambda: next(numbers))
            for one in inputs:
                fault = world.zone.check(one)
                if fault is not None:
                    raise SystemExit(fault.text)
            taken.append(1e3 * (time.thread_time() - start))
        p50, p99 = np.percentile(taken, [50, 99])
        goals.add(f"planning a change {name} (500 actors) on the loop, p50", p50)
        goals.add(f"planning a change {name} (500 actors) on the loop, p99", p99)


def side_by_side(loaded: LoadedScene, actors: int, ticks: int, goals: Goals) -> None:
    """Print the ticks of a world whose actors get other bodies beside one where they do not."""
    with ThreadPoolExecutor(1) as one, ThreadPoolExecutor(1) as other:
        calm, changed = World(loaded, actors, one), World(loaded, actors, other)
        for _ in range(40):
            calm.tick()
            changed.tick()
        times: dict[str, list[tuple[float, float]]] = {"without": [], "with": []}
        waits: dict[int, float] = {}
        for tick in range(ticks):
            inputs: list[Input] = []
            if tick % 20 == 0:
                command, turn = next(NUMBERS), tick // 20
                values = {"radius_m": RADII_M[turn % len(RADII_M)]}
                inputs.append(
                    SetParameters(command, changed.ids[turn % actors : turn % actors + 1], values)
                )
                waits[command] = float(changed.zone.tick + 1)
            start = time.perf_counter()
            times["without"].append(calm.tick())
            times["with"].append(changed.tick(*inputs))
            # Both threads get the time that ticks leave them, as in a server.
            time.sleep(max(0.0, TICK_S - (time.perf_counter() - start)))
        for name, found in times.items():
            for what, taken in zip(("wall", "own"), np.transpose(found), strict=True):
                p50, p90, p99 = np.percentile(taken, [50, 90, 99])
                figures = f"p50 {p50:6.3f} ms, p90 {p90:6.3f} ms, p99 {p99:6.3f} ms"
                print(f"bodies {name:7} {what}: {figures}, most {taken.max():6.3f} ms")
        without, with_them = (np.array(times[name])[:, 1] for name in ("without", "with"))
        rise = float(np.percentile(with_them, 99) - np.percentile(without, 99))
        goals.add("rise of a tick's own time, p99, while bodies change", rise, 1.0)
        done = [
            TICK_S * (changed.outcomes[c] - t) for c, t in waits.items() if c in changed.outcomes
        ]
        print(f"a body is ready after p50 {np.median(done):.2f} s, at most {max(done):.2f} s")
        goals.add("one body is ready, p50", float(np.median(done)), 0.5, "s")
        fifty(loaded, other, goals)
        for world in (calm, changed):
            world.population.close()


def fifty(loaded: LoadedScene, thread: ThreadPoolExecutor, goals: Goals) -> None:
    """Print how long fifty bodies take that change at once, and fifty actors that come in."""
    world = World(loaded, 50, thread)
    for _ in range(40):
        world.tick()
    specs = default_roster(loaded.scene, 100, 2).actors[50:]
    wave = tuple(spec.model_copy(update={"behaviour": WanderSpec()}) for spec in specs)
    commands = {
        "fifty bodies": SetParameters(next(NUMBERS), world.ids, {"radius_m": 0.4}),
        "fifty actors": AddActors(next(NUMBERS), wave, (ActorParameters(radius_m=0.35),) * 50),
    }  # type: dict[str, ActorCommand]
    for name, command in commands.items():
        begun, most = world.zone.tick + 1, world.tick(command)
        while command.command not in world.outcomes:
            most = max(most, world.tick())
            time.sleep(0.03)
        ready_s = TICK_S * (world.outcomes[command.command] - begun)
        print(f"{name} are ready after {ready_s:.2f} s, the longest tick {most[0]:.2f} ms")
        goals.add(f"{name} are ready", ready_s, 3.0, "s")
    world.population.close()


async def audit(rows: int) -> float:
    """The slowest p99 of pages of a long audit, milliseconds, over all kinds of filters."""
    with tempfile.TemporaryDirectory(prefix="esplanade-audit-") as folder:
        async with open_store(
            Location.of(Path(folder), ""), durable=False, upgrading=True
        ) as store:
            await fill(store, rows)
            log, slowest = AuditLog(store, "server"), 0.0
            for wanted in filters(rows).values():
                taken = []
                for _ in range(40):
                    begun = time.perf_counter()
                    await log.page(wanted)
                    taken.append(1e3 * (time.perf_counter() - begun))
                slowest = max(slowest, float(np.percentile(taken, 99)))
            return slowest


if __name__ == "__main__":
    sys.exit(main())
