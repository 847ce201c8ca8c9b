"""Actors and doors: ways to goals are found anew when one opens or closes."""

from collections.abc import Mapping

import pytest

from esplanade.actors import ActorParameters, Navigator, Population, Reason
from esplanade.actors.behaviour import Idle, Perception
from esplanade.planning import Door, LayeredGrid, PlanModel, Scene, Wall

BODY = ActorParameters()
GATE = Door(name="gate", start=(6.0, 3.0), end=(6.0, 5.0))
BACK_WAY = (Wall(start=(6.0, 0.0), end=(6.0, 3.0)), Wall(start=(6.0, 5.0), end=(6.0, 10.0)))
"""A wall with a gate in it, and a way around its upper end."""


@pytest.fixture
def navigator():
    scene = Scene(bounds=(0.0, 0.0, 12.0, 12.0), walls=BACK_WAY, doors=(GATE,))
    nav = Navigator(LayeredGrid.from_scene(scene), 0.1, plan=PlanModel(threads=1))
    yield nav
    nav.close()


def walk(nav, seconds):
    track = []
    for _ in range(round(seconds / nav.tick_s)):
        nav.observe({})
        state = nav.tick()["a"]
        track.append((*state.position, state.reason))
        if state.reason is Reason.ARRIVED:
            break
    return track


def test_an_actor_turns_round_when_its_door_closes_and_arrives(navigator) -> None:
    navigator.add_actor("a", (3.0, 4.0), (9.0, 4.0), BODY)
    walk(navigator, 1.0)
    navigator.grid.set_door("gate", is_open=False)
    navigator.ground_changed()
    track = walk(navigator, 25.0)
    assert track[-1][2] is Reason.ARRIVED
    assert max(y for _, y, _ in track) > 10.0, "around the end of the wall"


def test_an_open_door_is_taken_by_who_was_on_a_longer_way(navigator) -> None:
    navigator.grid.set_door("gate", is_open=False)
    navigator.add_actor("a", (3.0, 4.0), (9.0, 4.0), BODY)
    walk(navigator, 1.0)
    navigator.grid.set_door("gate", is_open=True)
    navigator.ground_changed()
    track = walk(navigator, 10.0)
    assert track[-1][2] is Reason.ARRIVED
    assert max(y for _, y, _ in track) < 7.0, "through the gate"


def test_a_goal_known_before_is_derived_anew_for_who_comes_later(navigator) -> None:
    navigator.prepare_goals([((9.0, 4.0), 0.0)], BODY)
    navigator.grid.set_door("gate", is_open=False)
    navigator.ground_changed()
    navigator.add_actor("a", (3.0, 4.0), (9.0, 4.0), BODY)
    track = walk(navigator, 25.0)
    assert track[-1][2] is Reason.ARRIVED
    assert max(y for _, y, _ in track) > 10.0


class Keeper(Idle):
    """Shuts the gate after a second."""

    def __init__(self) -> None:
        self._moves: dict[str, bool] = {}

    def update(self, view: Perception) -> None:
        self._moves = {"gate": False} if view.time_s == 1.0 else {}

    @property
    def moves_doors(self) -> Mapping[str, bool]:
        return self._moves


def test_a_behaviour_says_once_which_doors_are_to_move() -> None:
    scene = Scene(bounds=(0.0, 0.0, 12.0, 12.0), walls=BACK_WAY, doors=(GATE,))
    population = Population(LayeredGrid.from_scene(scene), scene, 0.25)
    population.add("keeper", Keeper(), position=(3.0, 4.0))
    wanted = []
    for _ in range(8):
        population.tick({})
        wanted.append(population.doors_wanted)
    population.close()
    assert wanted == [{}] * 4 + [{"gate": False}] + [{}] * 3
