"""Doors of a running world: they move when they can, on nobody, and everyone is told."""

import numpy as np
import pytest

from esplanade.planning import Door, LayeredGrid, Scene, Wall
from esplanade.server.world.doors import Doors
from esplanade.server.world.inputs import MoveDoor, Steer
from esplanade.server.world.state import PERSON, State
from tests.server.doubles import ScriptedPopulation
from tests.server.worlds import Trial

GATED = Scene(
    name="gated",
    bounds=(0.0, 0.0, 12.0, 8.0),
    walls=(Wall(start=(6.0, 0.0), end=(6.0, 3.0)), Wall(start=(6.0, 5.0), end=(6.0, 8.0))),
    doors=(Door(name="gate", start=(6.0, 3.0), end=(6.0, 5.0)),),
)


@pytest.fixture
def grid() -> LayeredGrid:
    return LayeredGrid.from_scene(GATED)


def test_a_door_moves_once_and_says_so(grid: LayeredGrid) -> None:
    doors = Doors(State(4), grid)
    assert doors.states() == {"gate": True}
    doors.want("gate", is_open=False)
    assert doors.update() == {"gate": False}
    assert doors.update() == {}
    assert doors.states() == {"gate": False}
    assert not grid.is_free([(6.0, 4.0)], [0.0], 0.2)[0]


def test_what_is_no_door_and_what_is_so_already_moves_nothing(grid: LayeredGrid) -> None:
    doors = Doors(State(4), grid)
    doors.want("no such door", is_open=False)
    doors.want("gate", is_open=True)
    assert doors.update() == {}


@pytest.mark.parametrize(
    ("place", "radius_m", "closes"),
    [
        ((6.1, 4.0, 0.0), 0.25, False),
        ((6.0, 5.2, 0.0), 0.25, False),
        ((6.4, 4.0, 0.0), 0.25, True),
        ((6.1, 4.0, 3.0), 0.25, True),
        ((6.8, 4.0, 0.0), 0.9, False),
        ((7.0, 4.0, 0.0), 0.9, True),
    ],
)
def test_a_door_closes_on_nobody(
    grid: LayeredGrid, place: tuple[float, float, float], radius_m: float, closes: bool
) -> None:
    state = State(4)
    slot = state.add(PERSON, "Ann", place, 0, radius_m)
    doors = Doors(state, grid)
    doors.want("gate", is_open=False)
    assert doors.update() == ({"gate": False} if closes else {})
    state.positions[slot] = (2.0, 2.0)
    assert doors.update() == ({} if closes else {"gate": False}), "it closes once they are gone"


def test_the_world_holds_people_back_at_a_closed_door_and_tells_everyone() -> None:
    trial = Trial(GATED)
    (ann,) = trial.join((4.0, 4.0))
    assert trial.tick(MoveDoor("gate", is_open=False)).doors == {"gate": False}
    assert trial.population.found_anew == 1
    assert trial.tick(Steer(ann, 1, 0.0, 2.0)).doors == {}
    trial.ticks(40)
    assert trial.position(ann)[0] == pytest.approx(5.75, abs=0.01)
    assert trial.tick(MoveDoor("gate", is_open=True)).doors == {"gate": True}
    trial.ticks(40)
    assert trial.position(ann)[0] > 6.5


def test_an_actor_moves_a_door_and_everyone_is_told() -> None:
    population = ScriptedPopulation()
    population.put("keeper", (2.0, 2.0))
    trial = Trial(GATED, population)
    population.doors_wanted = {"gate": False, "no such door": True}
    assert trial.tick().doors == {}
    assert trial.tick().doors == {"gate": False}
    population.doors_wanted = {}
    assert trial.tick(MoveDoor("gate", is_open=True)).doors == {"gate": True}
    assert trial.tick().doors == {}


def test_who_reads_the_grid_meanwhile_is_not_disturbed(grid: LayeredGrid) -> None:
    arrays = grid.arrays
    before = arrays.clearance.copy()
    grid.set_door("gate", is_open=False)
    assert np.array_equal(arrays.clearance, before)
    assert not np.array_equal(grid.arrays.clearance, before)
