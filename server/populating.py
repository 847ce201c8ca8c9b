"""Populates a scene by a roster, or with wanderers, a patrol and a guide where there are places."""

from collections.abc import Hashable, Mapping
from typing import Final

import numpy as np

from esplanade.actors import ActorSpec, BehaviourSpec, Newcomer, Population
from esplanade.actors.actor_spec import ZONE, actor_id
from esplanade.actors.behaviour_spec import GuideSpec, PatrolSpec, WanderSpec
from esplanade.planning import LayeredGrid, Scene
from esplanade.server.driving.settings import DRIVEN_TAG
from esplanade.server.roster import Roster

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
    grid: LayeredGrid,
    scene: Scene,
    count: int,
    tick_s: float,
    seed: int,
    *,
    person_radius_m: float = 0.25,
) -> tuple[Population, Mapping[Hashable, str]]:
    """Make a population of `count` actors among people of that radius, and name each.

    Raises
    ------
    ValueError
        The scene has no room for them.
    """
    roster = default_roster(scene, count, seed)
    population = populate_from(roster, grid, scene, tick_s, seed, person_radius_m=person_radius_m)
    return population, names_of(roster)


def populate_from(
    roster: Roster,
    grid: LayeredGrid,
    scene: Scene,
    tick_s: float,
    seed: int,
    *,
    person_radius_m: float = 0.25,
) -> Population:
    """Make a population of the actors of a roster, among people of that radius.

    Raises
    ------
    ValueError
        The scene has no room for them, or lacks a place that one of them is to go to.
    """
    population = Population(grid, scene, tick_s=tick_s, seed=seed, person_radius_m=person_radius_m)
    for spec, parameters in zip(roster.actors, roster.parameters(), strict=True):
        behaviour = spec.behaviour.make()
        try:
            population.check_targets(behaviour)
            population.add_many([Newcomer(spec.id, behaviour, parameters, spec.place)])
        except KeyError as error:
            raise ValueError(f"{spec.id}: {error.args[0]}") from None
        except ValueError as error:
            raise ValueError(f"{spec.id}: {error}") from None
    return population


def names_of(roster: Roster) -> Mapping[Hashable, str]:
    """Return the name of each actor that others see, by its id."""
    return {spec.id: spec.name for spec in roster.actors}


def default_roster(scene: Scene, count: int, seed: int, zone: str = ZONE) -> Roster:
    """The roster of `count` actors of a scene without one of its own."""
    random = np.random.default_rng([seed, count])
    order = random.permutation(len(NAMES)).tolist()
    actors = []
    for number in range(count):
        name, again = NAMES[order[number % len(NAMES)]], number // len(NAMES)
        speed_mps = round(float(random.uniform(*SPEEDS_MPS)), 2)
        actors.append(
            ActorSpec(
                id=actor_id(f"actor-{number + 1}", zone),
                name=f"{name} {again + 1}" if again else name,
                behaviour=_behaviour(number, scene, random),
                overrides={"speed_mps": speed_mps},
            )
        )
    return Roster(actors=tuple(actors))


def with_driven(roster: Roster, policy: str, count: int, zone: str = ZONE) -> Roster:
    """A roster with so many wanderers more, which a policy of that label drives."""
    driven = tuple(
        ActorSpec(
            id=actor_id(f"policy-{number}", zone),
            name=f"{policy[:28]} {number}" if count > 1 else policy[:32],
            behaviour=WanderSpec(),
            tags=(DRIVEN_TAG,),
        )
        for number in range(1, count + 1)
    )
    return roster.model_copy(update={"actors": (*roster.actors, *driven)})


def _behaviour(number: int, scene: Scene, random: np.random.Generator) -> BehaviourSpec:
    """The second actor patrols, the third guides, all others wander."""
    places = [place.name for place in scene.places]
    if number == 1 and len(places) >= PATROL_STOPS:
        return PatrolSpec(stops=random.permutation(places).tolist()[:PATROL_STOPS])
    if number == 2 and len(places) >= GUIDE_STOPS:
        return GuideSpec(tour=places)
    return WanderSpec()
