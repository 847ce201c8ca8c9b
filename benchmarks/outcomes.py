"""Judges how trips end, in seeded worlds, by geometry alone.

    python -m benchmarks.outcomes                       300 worlds
    python -m benchmarks.outcomes --worlds 2000 --seed 5 --json outcomes.json

In each world actors of several widths have goals, in two rooms or one, with a wall at any angle and
a doorway in it. People stand about, in the doorway and at goals; some of them go away later. Each
trip must have an outcome, and shapely says whether it is true: whether there is room at the goal,
and whether a way leads there between walls and bodies. At each tick the reason that an actor tells
is held against its speed and against who is near. The exit code is 1 if an outcome or a reason is
wrong or a trip has none, or if fewer than 95 % arrive of those that a way leads to.
"""

import argparse
import json
import math
import sys
from collections import Counter
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

import numpy as np
from benchmarks._outcome_judge import PLACE_M, Judge
from rich import box
from rich.console import Console
from rich.table import Table

from esplanade.actors import ActorParameters, ActorState, Navigator, Outcome, Reason
from esplanade.planning import PlanModel, Scene, Wall

TICK_S: Final = 0.1
LONGEST_S: Final = 90.0
PATIENCE_S: Final = 12.0
PERSON_M: Final = 0.25
SIDE_M: Final = 12.0
RADII_M: Final = (0.2, 0.25, 0.25, 0.25, 0.3, 0.6)
SPARE_M: Final = 0.1
"""A way counts as one where there is so much more room beside people than an actor keeps."""
DOOR_M: Final = 0.03 + PLACE_M
"""A way leads through doorways that leave this to either side, for walls are looked up in cells."""
QUEUE_M: Final = 3.0
"""Whoever is near a goal that is taken is no further away."""
LATELY_S: Final = 3.0
"""A way that was shut so lately may still be told to be."""
ARRIVING: Final = 0.95

Point = tuple[float, float]


@dataclass(frozen=True)
class World:
    """A place with people and actors, who are named by what they are called in both."""

    scene: Scene
    people: Mapping[str, Point]
    starts: Mapping[str, Point]
    goals: Mapping[str, Point]
    bodies: Mapping[str, ActorParameters]
    leaves_s: Mapping[str, float]
    """When a person is there no more; those who are not in it stay."""

    def people_at(self, seconds: float) -> dict[str, Point]:
        """Those who are there."""
        leaves_s = self.leaves_s
        return {k: at for k, at in self.people.items() if seconds < leaves_s.get(k, math.inf)}


@dataclass(frozen=True)
class Verdict:
    """How a trip ended; `fault` says what is wrong with that."""

    actor: str
    outcome: str
    seconds: float
    way: bool
    """Whether a way leads from its start to its goal, between those who are there at its end."""
    fault: str = ""


def main(argv: Sequence[str] | None = None) -> int:
    options = parser().parse_args(argv)
    found = {k: judged(random_world([options.seed, k])) for k in range(options.worlds)}
    verdicts = [verdict for some in found.values() for verdict in some]
    show(verdicts, options.worlds)
    for k, some in found.items():
        for verdict in some:
            if verdict.fault:
                print(f"world {k}: {verdict.actor}, {verdict.outcome}: {verdict.fault}")
    if options.json is not None:
        rows = [asdict(each) | {"world": k} for k, some in found.items() for each in some]
        options.json.write_text(json.dumps(rows, indent=1) + "\n")
    return int(any(each.fault for each in verdicts) or arriving(verdicts) < ARRIVING)


def parser() -> argparse.ArgumentParser:
    """The options."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.outcomes", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--worlds", type=int, default=300)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=Path, metavar="F")
    return parser


def random_world(seed: int | Sequence[int]) -> World:
    """A world with a wall at any angle, and people some of whom go away."""
    chance = np.random.default_rng(seed)
    middle = np.array([SIDE_M / 2, SIDE_M / 2]) + chance.uniform(-1.5, 1.5, 2)
    angle, half_m = float(chance.uniform(0.0, math.pi)), float(chance.uniform(0.35, 1.3))
    along = np.array([math.cos(angle), math.sin(angle)])
    kind = chance.uniform()
    walls = [_wall(middle, sign * along, half_m) for sign in ((1.0, -1.0), (1.0,), ())[kind > 0.6]]
    walls = [] if kind > 0.9 else walls
    places: list[Point] = []
    while len(places) < 14:
        place = chance.uniform(1.0, SIDE_M - 1.0, 2)
        across = abs(float((place - middle) @ (-along[1], along[0])))
        apart = all(math.dist(place, other) > 1.0 for other in places)
        if apart and (across > 0.8 or not walls):
            places.append((float(place[0]), float(place[1])))
    people = {f"p{k}": places[k] for k in range(int(chance.integers(0, 5)))}
    if walls and chance.uniform() < 0.5:
        x, y = (middle + chance.uniform(-0.6, 0.6) * half_m * along).tolist()
        people["door"] = (x, y)
    count = int(chance.integers(1, 5))
    names = [f"a{k}" for k in range(count)]
    starts = {name: places[5 + k] for k, name in enumerate(names)}
    goals = {name: places[9 + k] for k, name in enumerate(names)}
    if people and chance.uniform() < 0.3:
        goals["a0"] = next(iter(people.values()))
    if count > 1 and chance.uniform() < 0.3:
        goals["a1"] = goals["a0"]
    bodies = {
        name: ActorParameters(patience_s=PATIENCE_S, radius_m=float(chance.choice(RADII_M)))
        for name in names
    }
    leaves_s = {who: float(chance.uniform(3.0, 25.0)) for who in people if chance.uniform() < 0.25}
    scene = Scene(bounds=(0.0, 0.0, SIDE_M, SIDE_M), walls=tuple(walls))
    return World(scene, people, starts, goals, bodies, leaves_s)


def _wall(middle: np.ndarray, along: np.ndarray, half_m: float) -> Wall:
    """From a side of the doorway to the edge of the world."""
    start = middle + half_m * along
    with np.errstate(divide="ignore"):
        room = np.where(along > 0.0, SIDE_M - start, -start) / along
    end = start + float(np.nanmin(np.abs(room))) * along
    (x0, y0), (x1, y1) = start.tolist(), np.clip(end, 0.0, SIDE_M).tolist()
    return Wall(start=(x0, y0), end=(x1, y1))


def judged(world: World) -> list[Verdict]:
    """Let all trips of a world end, and judge them."""
    nav = Navigator(world.scene, TICK_S, plan=PlanModel(threads=1))
    for who, start in world.starts.items():
        nav.add_actor(who, start, world.goals[who], world.bodies[who])
    found: dict[str, Verdict] = {}
    faults: dict[str, str] = {}
    for tick in range(round(LONGEST_S / TICK_S)):
        seconds = tick * TICK_S
        people = world.people_at(seconds)
        nav.observe(people)
        states = nav.tick()
        for who, state in states.items():
            name = str(who)
            if fault := false_reason(who, states, people.values(), world.bodies[name].radius_m):
                faults.setdefault(name, f"{fault} at {seconds:.1f} s")
            if state.outcome is not None and name not in found:
                found[name] = verdict_on(world, name, states, seconds)
        if len(found) == len(world.starts):
            break
    nav.close()
    for who in world.starts:
        if who not in found:
            found[who] = Verdict(who, "none", LONGEST_S, way=False, fault="it has no outcome")
        elif who in faults and not found[who].fault:
            found[who] = Verdict(**asdict(found[who]) | {"fault": faults[who]})
    return list(found.values())


def false_reason(
    who: Hashable,
    states: Mapping[Hashable, ActorState],
    people: Sequence[Point],
    radius_m: float,
) -> str:
    """Return what is wrong with the reason that an actor tells; nothing if it may be true."""
    state = states[who]
    speed = math.hypot(*state.velocity)
    others = [other.position for name, other in states.items() if name != who]
    away_m = min((math.dist(state.position, other) for other in (*others, *people)), default=99.0)
    moves = state.reason in (Reason.MOVING, Reason.REPLANNING, Reason.GIVING_WAY)
    if moves and speed < 0.05:
        return f"{state.reason.name} at {speed:.2f} m/s"
    if state.reason is Reason.GIVING_WAY and away_m > 2.75 + radius_m + max(RADII_M):
        return f"GIVING_WAY, and nobody is nearer than {away_m:.1f} m"
    if state.reason is Reason.WAITING and speed >= 0.3:
        return f"WAITING at {speed:.2f} m/s"
    return ""


def verdict_on(
    world: World, who: str, states: Mapping[Hashable, ActorState], seconds: float
) -> Verdict:
    """Judge a trip that has just ended."""
    state, body, goal = states[who], world.bodies[who], world.goals[who]
    near_m, room_m = body.goal_tolerance_m, body.person_room_m
    judge = Judge(world.scene, body.radius_m)
    people = [(*place, PERSON_M) for place in world.people_at(seconds).values()]
    before = [(*place, PERSON_M) for place in world.people_at(seconds - LATELY_S).values()]
    still = [
        (*other.position, world.bodies[str(name)].radius_m)
        for name, other in states.items()
        if name != who and math.hypot(*other.velocity) < 0.3
    ]
    fault, away_m = "", math.dist(state.position, goal)
    match state.outcome:
        case Outcome.ARRIVED:
            fault = "" if away_m < near_m + 0.2 else f"{away_m:.2f} m away"
        case Outcome.NEAR:
            room = [(x, y, r + 0.05) for x, y, r in before] + still
            if judge.fits(goal, 0.8 * near_m, room, room_m):
                fault = "there is a place at the goal"
            elif away_m >= QUEUE_M:
                fault = f"it is {away_m:.2f} m away"
        case Outcome.BLOCKED:
            spare_m = room_m + SPARE_M
            if judge.leads(state.position, goal, 0.1, [*before, *still], spare_m):
                fault = "a way leads there"
        case Outcome.NO_WAY:
            wider = Judge(world.scene, body.radius_m + DOOR_M)
            if wider.leads(world.starts[who], goal, near_m):
                fault = "a way leads there"
    if state.outcome in (Outcome.NEAR, Outcome.BLOCKED) and state.in_the_way is None:
        fault = fault or "it does not tell who is in the way"
    way = state.outcome is not Outcome.NEAR
    way &= judge.leads(world.starts[who], goal, near_m, people, room_m + SPARE_M)
    name = "none" if state.outcome is None else state.outcome.name.lower()
    return Verdict(who, name, round(seconds, 1), way, fault)


def arriving(verdicts: Sequence[Verdict]) -> float:
    """The part that arrives of the trips to whose goals a way leads."""
    ways = [each.outcome == "arrived" for each in verdicts if each.way]
    return float(np.mean(ways)) if ways else 1.0


def show(verdicts: Sequence[Verdict], worlds: int) -> None:
    """Print how many trips end in which way, and how many of these are wrong."""
    table = Table(box=box.SIMPLE)
    for title in ("outcome", "trips", "wrong", "seconds, median"):
        table.add_column(title, justify="right")
    for outcome in ("arrived", "near", "blocked", "no_way", "none"):
        some = [each for each in verdicts if each.outcome == outcome]
        wrong = Counter(bool(each.fault) for each in some)[True]
        took_s = f"{np.median([each.seconds for each in some]):.1f}" if some else "-"
        table.add_row(outcome, str(len(some)), str(wrong), took_s)
    console = Console()
    console.print(table)
    part = f"{100.0 * arriving(verdicts):.1f} %"
    console.print(f"{worlds} worlds; of trips that a way leads to {part} arrive")


if __name__ == "__main__":
    sys.exit(main())
