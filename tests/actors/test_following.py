"""Actors that walk after somebody keep their distance, and stand while nobody is there."""

import math

import pytest

from esplanade.actors import ActorParameters, Population
from esplanade.actors.behaviour import GoTo
from esplanade.actors.following import Follow
from esplanade.planning import LayeredGrid, Scene

HALL = Scene.open_space((0.0, 0.0, 20.0, 8.0), name="hall")


@pytest.fixture
def population() -> Population:
    return Population(LayeredGrid.from_scene(HALL), HALL, 0.1, 1)


def test_an_actor_follows_another_at_its_distance(population: Population) -> None:
    population.add("main/a", GoTo((18.0, 4.0, 0.0)), ActorParameters(), (6.0, 4.0))
    population.add("main/b", Follow(actor="main/a", distance_m=2.0), ActorParameters(), (2.0, 4.0))
    apart = []
    for _ in range(200):
        states = population.tick({})
        apart.append(math.dist(states["main/a"].position, states["main/b"].position))
    assert states["main/b"].position[0] > 14.0
    assert 1.2 < apart[-1] < 2.6
    assert min(apart) > 1.0
    population.close()


def test_an_actor_that_follows_stands_while_nobody_is_there(population: Population) -> None:
    population.add("main/b", Follow(person=7, distance_m=2.0), ActorParameters(), (2.0, 4.0))
    for _ in range(20):
        states = population.tick({})
    assert math.dist(states["main/b"].position, (2.0, 4.0)) < 0.1
    for _ in range(100):
        states = population.tick({7: (12.0, 4.0, 0.0)})
    assert 1.2 < math.dist(states["main/b"].position, (12.0, 4.0)) < 2.6
    population.close()


@pytest.mark.parametrize("who", [{}, {"actor": "main/a", "person": 1}])
def test_whom_an_actor_follows_is_one(who: dict[str, object]) -> None:
    with pytest.raises(ValueError, match="one of them"):
        Follow(**who)  # type: ignore[arg-type]
