"""The population: behaviours and navigator together, trips, explanations, sameness."""

import math

import numpy as np
import pytest

from esplanade.actors import ActorParameters, GoTo, Guide, Idle, Patrol, Population, Reason, Wander
from esplanade.planning import LayeredGrid, Polygon, Scene
from esplanade.planning.agents import batch
from tests.actors.worlds import BODY, along, block, plaza

SCENE = plaza()
GRID = LayeredGrid.from_scene(SCENE)
TICK_S = 0.1


@pytest.fixture
def population():
    population = Population(GRID, SCENE, tick_s=TICK_S, seed=3)
    yield population
    population.close()


def play(population, seconds, people=None, first_s=0.0):
    """States of every tick; people are walks, seconds -> (x, y)."""
    states = []
    for k in range(round(seconds / TICK_S)):
        now = first_s + k * TICK_S
        states.append(
            population.tick({name: (*walk(now), 0) for name, walk in (people or {}).items()})
        )
    return states


def test_a_trip_counts_when_the_goal_is_reached(population) -> None:
    population.add("a", GoTo("fountain"), BODY, position=(7.0, 2.0))
    states = play(population, 5.0)
    assert math.dist(states[-1]["a"].position, (10.0, 2.0)) < 0.25
    assert states[-1]["a"].reason is Reason.ARRIVED
    assert population.trips == 1
    population.set_behaviour("a", GoTo("gate"))
    play(population, 9.0)
    assert population.trips == 2


def test_a_patrol_goes_on_by_itself(population) -> None:
    population.add(
        "a", Patrol([(4.0, 4.0, 0), (6.0, 4.0, 0)], pause_s=0.5), BODY, position=(3.0, 4.0)
    )
    play(population, 14.0)
    assert population.trips >= 3


def test_wanderers_keep_making_trips(population) -> None:
    for k in range(3):
        population.add(f"a{k}", Wander(pause_s=(0.2, 0.5)))
    play(population, 20.0)
    assert population.trips >= 3
    assert len(population) == 3


def test_a_guide_waits_for_who_falls_behind_and_goes_on(population) -> None:
    guide = Guide([(10.0, 6.0, 0)], join_m=2.0, lag_m=3.5, join_after_s=1.0, patience_s=60.0)
    population.add("guide", guide, BODY, position=(2.0, 6.0))
    # Follows slower than the guide walks, so that it has to wait now and then.
    person = along((1.0, 6.0), (9.0, 6.0), speed_mps=0.7)
    states = play(population, 16.0, {"ann": person})
    reasons = [state["guide"].reason for state in states]
    assert Reason.WAITING in reasons
    assert states[-1]["guide"].reason is Reason.ARRIVED
    assert guide.followers == {"ann"}
    apart = [math.dist(s["guide"].position, person(k * TICK_S)) for k, s in enumerate(states)]
    assert max(apart) < 5.0
    assert min(apart) > 0.5


def test_a_guide_goes_on_when_its_follower_has_left(population) -> None:
    guide = Guide([(10.0, 6.0, 0)], join_m=2.0, lag_m=3.5, join_after_s=0.5, patience_s=60.0)
    population.add("guide", guide, BODY, position=(2.0, 6.0))
    play(population, 6.0, {"ann": along((1.0, 6.0), (1.0, 6.0))})
    assert guide.waiting
    play(population, 9.0)
    assert not guide.waiting
    assert population.trips == 1


def test_a_guide_turns_to_what_it_points_at() -> None:
    scene = plaza().model_copy(update={"polygons": (block(9.0, 4.0, 11.0, 5.0),)})
    population = Population(LayeredGrid.from_scene(scene), scene, tick_s=TICK_S)
    population.add("guide", Guide(["fountain"], pause_s=5.0), BODY, position=(8.0, 2.0))
    states = [
        state["guide"] for state in play(population, 6.0, {"ann": along((8.0, 1.0), (9.0, 1.0))})
    ]
    population.close()
    shown = [state for state in states if state.points_at is not None]
    assert len(shown) >= 10
    assert {state.points_at for state in shown} == {(10.0, 4.5, 1.5)}
    x, y = shown[-1].position
    assert shown[-1].heading == pytest.approx(math.atan2(4.5 - y, 10.0 - x))
    assert states[0].points_at is None


def test_an_explanation_says_what_is_done_and_why(population) -> None:
    population.add("a", GoTo("fountain"), BODY, position=(3.0, 2.0))
    play(
        population,
        1.0,
        {"near": along((6.0, 5.0), (6.0, 1.0)), "far": along((1.0, 11.5), (2.0, 11.5))},
    )
    told = population.explain("a")
    assert told.behaviour == "go_to"
    assert told.reason in {Reason.MOVING, Reason.REPLANNING, Reason.GIVING_WAY}
    assert told.goal == (10.0, 2.0, 0)
    assert told.path.shape[1] == 4
    assert (np.diff(told.path[:, 3]) > 0.0).all()
    assert len(told.people) == 1
    x, y, z_m, radius = told.people[0][0]
    assert (x, z_m) == (pytest.approx(6.0), 0.0)
    assert y == pytest.approx(5.0 - 1.2 * 0.9, abs=0.01)
    assert radius == pytest.approx(2.0 * 0.05, abs=0.05)


def test_places_are_chosen_with_the_seed_and_free() -> None:
    where = []
    for seed in (3, 3, 4):
        population = Population(GRID, SCENE, tick_s=TICK_S, seed=seed)
        where.append([population.add(f"a{k}", Idle()).position for k in range(10)])
        population.close()
    assert where[0] == where[1] != where[2]
    spots = np.array(where[0])
    away = np.hypot(*(spots[:, None] - spots[None]).transpose(2, 0, 1))
    assert away[~np.eye(10, dtype=bool)].min() > 0.5
    assert GRID.is_free(spots, [0] * 10, 0.25).all()


def wander_for(seed, names, seconds=4.0):
    population = Population(GRID, SCENE, tick_s=TICK_S, seed=seed)
    for name in names:
        population.add(name, Wander(), BODY, position=(2.0 + 1.5 * int(name[1:]), 5.0))
    states = play(population, seconds, {"p": along((1.0, 6.0), (11.0, 6.0))})
    population.close()
    return [{name: state[name].position for name in sorted(state)} for state in states]


def test_the_same_seed_and_people_give_the_same_walks() -> None:
    names = ["a0", "a1", "a2", "a3"]
    assert wander_for(5, names) == wander_for(5, names)
    assert wander_for(5, names) == wander_for(5, names[::-1])
    assert wander_for(5, names) != wander_for(6, names)


def test_unknown_places_are_refused_and_nothing_is_added(population) -> None:
    with pytest.raises(KeyError, match="no place named 'moon'"):
        population.add("a", GoTo("moon"), position=(6.0, 6.0))
    assert len(population) == 0
    assert population.tick({}) == {}
    population.add("a", Idle(), position=(6.0, 6.0))
    with pytest.raises(KeyError, match="no place named 'moon'"):
        population.set_behaviour("a", Patrol(["gate", "moon"]))
    population.tick({})
    assert population.explain("a").behaviour == "idle"


def test_unknown_actors_are_refused(population) -> None:
    for call in (
        lambda: population.remove("x"),
        lambda: population.explain("x"),
        lambda: population.set_behaviour("x", Idle()),
        lambda: population.set_parameters("x", BODY),
    ):
        with pytest.raises(KeyError):
            call()


def test_an_actor_may_leave_and_its_id_come_back(population) -> None:
    population.add("a", Idle(), position=(6.0, 6.0))
    with pytest.raises(ValueError, match="already is an actor 'a'"):
        population.add("a", Idle(), position=(7.0, 6.0))
    population.remove("a")
    assert population.tick({}) == {}
    population.add("a", Idle(), position=(3.0, 6.0))
    assert population.tick({})["a"].position == (3.0, 6.0)


def test_parameters_reach_the_navigator(population) -> None:
    population.add("a", GoTo("fountain"), BODY, position=(3.0, 2.0))
    population.set_parameters("a", ActorParameters(speed_mps=0.4, max_speed_mps=0.5))
    states = play(population, 3.0)
    assert all(math.hypot(*state["a"].velocity) <= 0.5 + 1e-6 for state in states)


def test_where_no_place_is_free_an_actor_is_refused() -> None:
    scene = Scene.open_space((0.0, 0.0, 1.0, 1.0), walls=[((0.0, 0.5), (1.0, 0.5))])
    population = Population(LayeredGrid.from_scene(scene), scene, tick_s=TICK_S)
    for k in range(8):
        try:
            population.add(k, Idle(), ActorParameters(radius_m=0.5))
        except ValueError as error:
            assert "no free place" in str(error)  # noqa: PT017 - one of several must be refused
            break
    population.close()
    assert len(population) < 8


def test_warming_up_changes_nothing(population) -> None:
    population.add("a", GoTo("fountain"), BODY, position=(3.0, 2.0))
    population.warm_up()
    assert population.trips == 0
    assert len(population) == 1
    assert set(population.tick({})) == {"a"}


def test_warming_up_calls_the_kernels_for_few_actors_and_for_many(population, monkeypatch) -> None:
    called = set()

    def watched(name, kernel):
        def call(*arguments):
            called.add(name)
            return kernel(*arguments)

        return call

    names = {"plan_and_step", "index_future", "put_in_order", "decide_some", "take_steps"}
    for name in names:
        monkeypatch.setattr(batch, name, watched(name, getattr(batch, name)))
    population.warm_up()
    assert called == names


def test_who_is_put_where_nobody_can_stand_stands_beside_it() -> None:
    block = Polygon(points=((4.0, 4.0), (8.0, 4.0), (8.0, 8.0), (4.0, 8.0)), height_m=3.0)
    low = Polygon(
        points=((9.0, 0.0), (12.0, 0.0), (12.0, 3.0), (9.0, 3.0)), offset_m=1.4, height_m=1.0
    )
    scene = Scene(bounds=(0.0, 0.0, 12.0, 12.0), polygons=(block, low))
    grid = LayeredGrid.from_scene(scene)
    population = Population(grid, scene, tick_s=TICK_S)
    child = ActorParameters(height_m=1.3, radius_m=0.2, step_on_m=0.3, leg_length_m=0.65)
    states = {
        "inside": population.add("inside", GoTo((2.0, 2.0, 0.0)), BODY, position=(5.0, 6.0)),
        "adult": population.add("adult", GoTo((2.0, 8.0, 0.0)), BODY, position=(11.0, 1.0)),
        "child": population.add("child", GoTo((2.0, 10.0, 0.0)), child, position=(11.0, 1.0)),
    }
    assert states["inside"].position[0] < 4.0
    assert math.dist(states["inside"].position, (4.0, 6.0)) < 0.6
    assert states["adult"].position[0] < 9.0 or states["adult"].position[1] > 3.0
    assert states["child"].position == (11.0, 1.0)
    play(population, 20.0)
    assert population.trips == 3
    with pytest.raises(ValueError, match="outside the bounds"):
        population.add("far", Idle(), BODY, position=(20.0, 1.0))
    population.close()


def test_who_fits_nowhere_is_refused() -> None:
    low = Polygon(
        points=((0, 0), (4, 0), (4, 4), (0, 4)), offset_m=1.4, height_m=1.0, kind="furniture"
    )
    scene = Scene(bounds=(0.0, 0.0, 4.0, 4.0), polygons=(low,))
    with pytest.raises(ValueError, match="can stand anywhere"):
        Population(LayeredGrid.from_scene(scene), scene).add("a", Idle(), BODY, position=(2.0, 2.0))
