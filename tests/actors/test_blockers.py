"""Tests that the person, door or missing route that holds an actor is named."""

import pytest

from esplanade.actors import ActorParameters, GoTo, Idle, Population, Reason
from esplanade.actors.blockers import Blocker
from esplanade.planning import Door, LayeredGrid, Place, Scene, Wall

SCENE = Scene(
    bounds=(0.0, 0.0, 12.0, 4.0),
    walls=(Wall(start=(6.0, 0.0), end=(6.0, 1.4)), Wall(start=(6.0, 2.6), end=(6.0, 4.0))),
    doors=(Door(name="gate", start=(6.0, 1.4), end=(6.0, 2.6)),),
    places=(Place(name="east", position=(10.0, 2.0)),),
)


@pytest.fixture
def population():
    population = Population(LayeredGrid.from_scene(SCENE), SCENE, tick_s=0.05)
    yield population
    population.close()


def until(population, reasons, people) -> None:
    for _ in range(400):
        population.tick(people)
        if population.explain("a").reason in reasons:
            return
    raise AssertionError(f"it was never {reasons}")


def test_a_person_in_the_gap_holds_the_actor_and_is_named(population) -> None:
    population.add("a", GoTo("east"), position=(2.0, 2.0))
    population.add("b", Idle(), position=(1.0, 3.5))
    people = {7: (6.0, 2.0, 0.0), 8: (6.0, 1.2, 3.5), 9: (2.0, 0.5, 0.0)}
    until(population, {Reason.WAITING, Reason.GIVING_WAY}, people)
    named = []
    for _ in range(120):
        population.tick(people)
        told = population.explain("a")
        if told.reason is Reason.MOVING:
            assert told.blocker is None
        else:
            assert told.reason in {Reason.WAITING, Reason.GIVING_WAY, Reason.REPLANNING}
        named += [(told.blocker.kind, told.blocker.id)] if told.blocker else []
    assert set(named) == {("person", 7)}
    assert len(named) > 60, "while it passes to and fro, its way may lead past everyone"


def test_an_actor_that_walks_is_held_by_nobody_and_says_for_how_long(population) -> None:
    population.add("a", GoTo("east"), position=(2.0, 2.0))
    until(population, {Reason.MOVING}, {})
    before, same_ticks, changed = population.explain("a").reason, 0, False
    for _ in range(30):
        population.tick({})
        told = population.explain("a")
        same_ticks = same_ticks + 1 if told.reason == before else 0
        before = told.reason
        if told.reason is Reason.MOVING:
            assert told.blocker is None
        if changed := changed or same_ticks == 0:
            assert told.since_s == pytest.approx(0.05 * same_ticks)
    assert changed


def test_a_closed_door_is_named(population) -> None:
    population.grid.set_door("gate", is_open=False)
    population.add("a", GoTo("east"), position=(2.0, 2.0))
    until(population, {Reason.NO_PATH}, {})
    told = population.explain("a").blocker
    assert told is not None
    assert (told.kind, told.id, told.away_m) == ("door", "gate", pytest.approx(4.0, abs=0.3))


def test_a_way_that_is_still_being_found_is_no_reason_to_give_up(population) -> None:
    population.derive_outside()
    population.add("a", GoTo((3.0, 3.0, 0.0)), ActorParameters(), position=(2.0, 2.0))
    for _ in range(100):
        population.tick({})
    told = population.explain("a")
    assert (told.reason, told.blocker) == (Reason.WAITING, Blocker("route"))
    assert population.table.trips.no_path_s[0] == 0.0
    derive = population.outdated_potential()
    assert derive is not None
    population.renew_potential(derive())
    until(population, {Reason.ARRIVED}, {})
