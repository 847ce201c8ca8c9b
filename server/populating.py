"""Populates a scene: with wanderers, and where there are places with a patrol and a guide."""

from collections.abc import Hashable
from typing import Final

import numpy as np

from esplanade.actors import ActorParameters, Behaviour, Guide, Patrol, Population, Wander
from esplanade.planning import LayeredGrid, Scene
from esplanade.server.world.actors import Body

NAMES: Final = (
    "Alder", "Aspen", "Bay", "Birch", "Cedar", "Clover", "Cove", "Dale", "Drift", "Dune", "Elm",
    "Ember", "Fern", "Fjord", "Flint", "Frost", "Grove", "Harbour", "Hazel", "Heath", "Ivy",
    "Juniper", "Lake", "Larch", "Lark", "Linden", "Maple", "Marsh", "Meadow", "Moss", "Oak",
    "Pebble", "Pine", "Rain", "Reed", "Ridge", "River", "Rowan", "Sage", "Sky", "Slate", "Sparrow",
    "Spruce", "Storm", "Summit", "Thistle", "Vale", "Willow", "Wren", "Yarrow",
)  # fmt: skip

SPEEDS_MPS: Final = (1.1, 1.5)
PATROL_STOPS: Final = 3
GUIDE_STOPS: Final = 4


def populate(
    grid: LayeredGrid, scene: Scene, count: int, tick_s: float, seed: int
) -> tuple[Population, dict[Hashable, Body]]:
    """Make a population of `count` actors, and the bodies that others see.

    Raises
    ------
    ValueError
        The scene has no room for them.
    """
    random = np.random.default_rng([seed, count])
    population = Population(grid, scene, tick_s=tick_s, seed=seed)
    bodies: dict[Hashable, Body] = {}
    order = random.permutation(len(NAMES)).tolist()
    for number in range(count):
        actor_id = f"actor-{number + 1}"
        name, again = NAMES[order[number % len(NAMES)]], number // len(NAMES)
        parameters = ActorParameters(speed_mps=round(float(random.uniform(*SPEEDS_MPS)), 2))
        population.add(actor_id, _behaviour(number, scene, random), parameters)
        bodies[actor_id] = Body(f"{name} {again + 1}" if again else name, parameters.radius_m)
    return population, bodies


def _behaviour(number: int, scene: Scene, random: np.random.Generator) -> Behaviour:
    """The second actor patrols, the third guides, all others wander."""
    places = [place.name for place in scene.places]
    if number == 1 and len(places) >= PATROL_STOPS:
        return Patrol(random.permutation(places).tolist()[:PATROL_STOPS])
    if number == 2 and len(places) >= GUIDE_STOPS:
        return Guide(places)
    return Wander()
