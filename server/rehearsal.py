"""A small world runs for some ticks, so that all that a tick calls is compiled beforehand."""

import time
from collections.abc import Mapping
from typing import Final

from esplanade.actors import ActorParameters, GoTo, Population
from esplanade.planning import Door, LayeredGrid, Polygon, Scene
from esplanade.server.net.packing import Packing
from esplanade.server.net.sockets.warming import rehearse_sockets
from esplanade.server.world.audience import Audience
from esplanade.server.world.inputs import Detach, Follow, Input, Join, Leave, MoveDoor, Steer
from esplanade.server.world.routes import find_route
from esplanade.server.world.rules import Rules
from esplanade.server.world.state import ACTOR
from esplanade.server.world.zone import Zone

SCENE: Final = Scene.open_space(
    (0.0, 0.0, 6.0, 6.0),
    walls=[((3.0, 0.0), (3.0, 2.0))],
    polygons=[
        Polygon(points=((4.5, 4.5), (5.5, 4.5), (5.5, 5.5), (4.5, 5.5)), height_m=0.3),
        Polygon(points=((0.4, 5.2), (0.8, 4.8), (1.2, 5.2), (0.8, 5.6)), height_m=0.7),
    ],
).model_copy(update={"doors": (Door(name="door", start=(3.0, 2.0), end=(3.0, 3.0)),)})
"""It is not all level: on level ground some kernels are not called."""
START: Final = (1.0, 4.0)
TICKS: Final = 30
PERSON: Final = 2
"""The id of the person: the actor is the first avatar, and the person the second."""
INPUTS: Final[Mapping[int, list[Input]]] = {
    1: [Join(0, "P", None)],
    2: [Steer(PERSON, 1, 0.5, 1.0)],
    TICKS // 3: [MoveDoor("door", is_open=False)],
    TICKS // 2: [Follow(PERSON, 2, ((1.0, 1.0, 0.0), (2.0, 1.0, 0.0)))],
    TICKS - 1: [Detach(PERSON)],
    TICKS: [Leave(PERSON)],
}
WAYS: Final = (
    ((1.0, 1.0, 0.0), (5.0, 1.0, 0.0)),
    ((2.9, 1.0, 0.0), (3.05, 1.0, 0.0)),
    ((1.0, 1.0, 0.0), (0.8, 4.85, 0.0)),
)
"""Starts and goals: one way leads around a wall, the ends of another stand beside one another, and
the goal of the last is inside of something."""


def rehearse(rules: Rules, tick_s: float) -> None:
    """Let an actor and a person of a world of their own walk, stand, find a way, and leave."""
    rehearse_sockets()
    grid = LayeredGrid.from_scene(SCENE)
    world, population = _world(grid, rules, tick_s)
    population.add("a", GoTo((5.0, 3.0, 0.0)), ActorParameters(), position=START)
    audience, packing = Audience(rules, world.origin_m, world.times), Packing()
    for tick in range(1, TICKS + 1):
        world.begin(INPUTS.get(tick, []))
        packing.pack(audience.take(world.finish(world.think())).snapshots)
        if tick == TICKS // 2:
            for start, goal in WAYS:
                find_route(grid, start, goal, rules.person_clearance_m)
    population.close()


def rehearse_walking(rules: Rules, tick_s: float) -> None:
    """Let a person walk beside an actor that stands: nothing is planned, all else is called.

    On a first start this is compiled while another process still compiles what plans.
    """
    rehearse_sockets()
    world, population = _world(LayeredGrid.from_scene(SCENE), rules, tick_s)
    world.state.add(ACTOR, "A", (*START, 0.0), 0, ActorParameters().radius_m)
    audience, packing = Audience(rules, world.origin_m, world.times), Packing()
    for tick in range(1, TICKS // 2):
        world.begin(INPUTS.get(tick, []))
        packing.pack(audience.take(world.finish(actors_moved=False)).snapshots)
    population.close()


def _world(grid: LayeredGrid, rules: Rules, tick_s: float) -> tuple[Zone, Population]:
    population = Population(grid, SCENE, tick_s=tick_s, person_radius_m=rules.person_radius_m)
    world = Zone(
        SCENE,
        grid,
        population,
        {"a": "A"},
        rules,
        tick_s=tick_s,
        max_people=1,
        seed=0,
        clock=time.perf_counter,
    )
    return world, population
