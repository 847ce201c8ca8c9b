"""Actors on several floors: up and down stairs, past each other, and what others do not matter."""

import math

import numpy as np
import pytest

from esplanade.actors import ActorParameters, GoTo, Idle, Population, Reason
from esplanade.planning import LayeredGrid, Place
from esplanade.planning.routes.potential import Potential
from tests.actors.worlds import BODY, TICK_S, along, navigator, run
from tests.planning.storeys import SLAB_FROM, STAIRS_FROM, box, grid_of, storeyed
from tests.planning.worlds import UPPER_M

CHILD = BODY.model_copy(
    update={"height_m": 1.3, "step_on_m": 0.3, "leg_length_m": 0.65, "radius_m": 0.2}
)
HOUSE = LayeredGrid.from_scene(storeyed())
BELOW, ABOVE = (12.0, 6.0, 0.0), (12.0, 6.0, UPPER_M)


def walk(grid, start, goal, seconds, people=None, parameters=BODY):
    nav = navigator(grid)
    nav.add_actor("a", start[:2], goal[:2], parameters, z_m=start[2], goal_z_m=goal[2])
    record = run(nav, seconds, people)
    nav.close()
    return record


def at(walked, z_m):
    """The same walk at a height."""
    return lambda seconds: (*walked(seconds), z_m)


def same(one, other) -> bool:
    return (
        np.array_equal(one.positions["a"], other.positions["a"])
        and np.array_equal(one.heights["a"], other.heights["a"])
        and one.reasons == other.reasons
    )


@pytest.fixture(scope="module")
def ups():
    return walk(HOUSE, BELOW, ABOVE, 30.0)


def check_walk(record, start, goal, step_on_m) -> None:
    """It arrived, by the stairs, and its height never leapt."""
    places, heights = record.positions["a"], record.heights["a"]
    assert record.reasons["a"][-1] is Reason.ARRIVED
    assert places[-1] == pytest.approx(goal[:2], abs=0.25)
    assert heights[-1] == pytest.approx(goal[2], abs=1e-4)
    assert Reason.NO_PATH not in record.reasons["a"]
    before = np.concatenate([[start[2]], heights[:-1]])
    assert np.abs(heights - before).max() <= step_on_m
    halfway = (heights > 0.5) & (heights < UPPER_M - 0.3)
    assert halfway.any()
    assert (np.abs(places[halfway, 1] - 6.0) <= 1.0).all()
    assert (places[halfway, 0] > STAIRS_FROM).all()
    assert (places[halfway, 0] < SLAB_FROM + 0.1).all()
    # Cells know ledges to within half their diagonal.
    assert places[heights > UPPER_M - 0.01, 0].min() >= SLAB_FROM - 0.6
    assert np.hypot(*np.diff(places, axis=0).T).max() <= BODY.max_speed_mps * TICK_S + 1e-6


def test_up_to_a_goal_straight_above_by_the_stairs(ups) -> None:
    check_walk(ups, BELOW, ABOVE, BODY.step_on_m)
    way = Potential(HOUSE, ABOVE[:2], ABOVE[2], 0.25).distance([BELOW[:2]], [0.0])[0]
    assert ups.arrival_s("a") < way / 1.3 + 4.0


def test_and_down_to_a_goal_straight_below() -> None:
    check_walk(walk(HOUSE, ABOVE, BELOW, 30.0), ABOVE, BELOW, BODY.step_on_m)


def test_a_child_climbs_too() -> None:
    record = walk(HOUSE, BELOW, ABOVE, 30.0, parameters=CHILD)
    check_walk(record, BELOW, ABOVE, CHILD.step_on_m)


def test_the_plan_shown_has_the_heights_of_the_way() -> None:
    nav = navigator(HOUSE)
    nav.add_actor("a", (1.0, 6.0), ABOVE[:2], BODY, goal_z_m=UPPER_M)
    state = nav.state("a")
    assert (state.layer, state.z_m) == (0, 0.0)
    layers = set()
    for _ in range(90):
        nav.observe({})
        state = nav.tick()["a"]
        layers.add(state.layer)
        assert state.path.shape[1] == 4
        assert HOUSE.floor_at(state.position, state.z_m) == pytest.approx(state.z_m, abs=1e-5)
        assert HOUSE.layer_at(state.position, state.z_m) == state.layer
        assert np.abs(np.diff(state.path[:, 2])).max() <= BODY.step_on_m + 1e-4
        assert abs(state.path[0, 2] - state.z_m) <= BODY.step_on_m
        for x, y, z, _ in state.path:
            assert HOUSE.floor_at((x, y), z) == pytest.approx(z, abs=1e-5)
    nav.close()
    assert state.z_m == pytest.approx(UPPER_M, abs=1e-4)
    assert layers == {0, 1}


def test_who_stands_on_the_other_floor_does_not_matter(ups) -> None:
    """Straight above the way below, and straight below the way above."""
    above = {"p": at(along((10.0, 7.5), (10.0, 7.5)), UPPER_M)}
    first = walk(HOUSE, BELOW, (9.0, 11.0, 0.0), 6.0)
    assert same(first, walk(HOUSE, BELOW, (9.0, 11.0, 0.0), 6.0, above))
    below = {"p": at(along((10.0, 6.0), (10.0, 6.0)), 0.0)}
    second = walk(HOUSE, (9.0, 6.0, UPPER_M), ABOVE, 6.0)
    assert same(second, walk(HOUSE, (9.0, 6.0, UPPER_M), ABOVE, 6.0, below))
    there = {"p": at(along((10.0, 6.0), (10.0, 6.0)), UPPER_M)}
    assert not same(second, walk(HOUSE, (9.0, 6.0, UPPER_M), ABOVE, 6.0, there))


def test_who_stands_right_above_its_way_to_the_stairs_does_not_matter() -> None:
    start, goal = (15.0, 1.5, 0.0), (12.0, 9.0, UPPER_M)
    alone = walk(HOUSE, start, goal, 26.0)
    check_walk(alone, start, goal, BODY.step_on_m)
    below = alone.positions["a"][15]
    assert math.dist(below, (SLAB_FROM, 6.0)) > 5.0
    above = {"p": lambda _: (*below, UPPER_M)}
    assert same(alone, walk(HOUSE, start, goal, 26.0, above))


def test_who_walks_overhead_all_the_way_does_not_matter() -> None:
    start, goal = (15.0, 3.0, 0.0), (9.0, 3.0, 0.0)
    alone = walk(HOUSE, start, goal, 7.0)
    towards = at(along((9.0, 3.0), (15.0, 3.0)), UPPER_M)
    over = at(along((15.0, 3.0), (9.0, 3.0), speed_mps=1.3), UPPER_M)
    assert same(alone, walk(HOUSE, start, goal, 7.0, {"p": towards, "q": over}))


def test_actors_on_the_other_floor_do_not_matter() -> None:
    ways = {"a": ((9.0, 3.0), (15.0, 3.0), 0.0), "b": ((15.0, 3.0), (9.0, 3.0), UPPER_M)}
    alone = {}
    for name, (start, goal, z_m) in ways.items():
        nav = navigator(HOUSE)
        nav.add_actor(name, start, goal, BODY, z_m=z_m)
        alone[name] = run(nav, 7.0)
        nav.close()
    nav = navigator(HOUSE)
    for name, (start, goal, z_m) in ways.items():
        nav.add_actor(name, start, goal, BODY, z_m=z_m)
    both = run(nav, 7.0)
    nav.close()
    for name in ways:
        assert np.array_equal(both.positions[name], alone[name].positions[name])
        assert both.reasons[name] == alone[name].reasons[name]
    assert both.nearest_actors() < 0.3, "they passed right above each other"


@pytest.mark.parametrize("offset", [0.0, 0.3])
def test_two_who_meet_on_the_stairs_pass_each_other_and_arrive(offset) -> None:
    nav = navigator(HOUSE)
    nav.add_actor("up", (1.5, 6.0), (11.0, 6.0), BODY, goal_z_m=UPPER_M)
    nav.add_actor("down", (9.5, 6.0 + offset), (1.5, 6.0 + offset), BODY, z_m=UPPER_M, goal_z_m=0.0)
    record = run(nav, 22.0)
    nav.close()
    for name, start, end in (("up", 0.0, UPPER_M), ("down", UPPER_M, 0.0)):
        assert record.arrival_s(name) < 9.5 / 1.3 + 7.0
        heights = record.heights[name]
        assert heights[-1] == pytest.approx(end, abs=1e-4)
        assert np.abs(np.diff(np.concatenate([[start], heights]))).max() <= BODY.step_on_m
    assert record.nearest_actors() >= 0.5


def test_a_person_who_comes_down_is_given_room() -> None:
    nav = navigator(HOUSE)
    nav.add_actor("a", (1.5, 6.0), (11.0, 6.0), BODY, goal_z_m=UPPER_M)
    nearest, z_m = math.inf, UPPER_M
    for k in range(200):
        x = 10.0 - 0.1 * min(k, 85)
        z_m = HOUSE.floor_at((x, 6.1), z_m)
        nav.observe({"p": (x, 6.1, z_m)})
        state = nav.tick()["a"]
        nearest = min(nearest, math.dist(state.position, (x, 6.1)))
    nav.close()
    assert state.reason is Reason.ARRIVED
    assert nearest > 0.5


def test_a_child_passes_where_an_adult_goes_around() -> None:
    grid = grid_of(12.0, [box(4.0, 2.0, 5.0, 12.0, 0.3, offset_m=1.5)])
    start, goal = (2.0, 8.0, 0.0), (8.0, 8.0, 0.0)
    child = walk(grid, start, goal, 12.0, parameters=CHILD)
    adult = walk(grid, start, goal, 16.0)
    assert child.arrival_s("a") < 6.0 / 1.3 + 1.5
    assert child.sideways("a", 8.0) < 0.3
    assert adult.reasons["a"][-1] is Reason.ARRIVED
    tracks = adult.positions["a"]
    under = (tracks[:, 0] > 4.0) & (tracks[:, 0] < 5.0)
    assert under.any()
    assert tracks[under, 1].max() < 2.0
    assert not adult.heights["a"].any()


def test_growing_up_on_the_way_changes_the_way() -> None:
    grid = grid_of(12.0, [box(4.0, 2.0, 5.0, 12.0, 0.3, offset_m=1.5)])
    nav = navigator(grid)
    nav.add_actor("a", (2.0, 8.0), (8.0, 8.0), CHILD)
    run(nav, 0.5)
    nav.set_parameters("a", BODY)
    record = run(nav, 16.0)
    nav.close()
    assert record.reasons["a"][-1] is Reason.ARRIVED
    tracks = record.positions["a"]
    under = (tracks[:, 0] > 4.0) & (tracks[:, 0] < 5.0)
    assert tracks[under, 1].max() < 2.0


def test_without_stairs_what_is_above_cannot_be_reached() -> None:
    grid = LayeredGrid.from_scene(storeyed().model_copy(update={"stairs": ()}))
    record = walk(grid, BELOW, ABOVE, 2.0)
    assert set(record.reasons["a"]) == {Reason.NO_PATH}
    assert np.ptp(record.positions["a"], axis=0).max() < 0.05


def test_a_cast_plays_on_all_floors() -> None:
    places = (
        Place(name="cellar", position=(11.0, 6.0)),
        Place(name="gallery", position=(11.0, 6.0), z_m=UPPER_M),
    )
    scene = storeyed().model_copy(update={"places": places})
    population = Population(LayeredGrid.from_scene(scene), scene, tick_s=TICK_S, seed=1)
    population.add("climber", GoTo("gallery"), BODY, position=(2.0, 6.0))
    population.add("stays", GoTo("cellar"), BODY, position=(11.0, 5.0))
    placed = population.add("idle", Idle(), BODY, z_m=UPPER_M)
    assert placed.z_m == pytest.approx(UPPER_M, abs=1e-4)
    assert population.grid.is_free([placed.position], [UPPER_M], 0.25)[0]
    for _ in range(140):
        states = population.tick({"p": (11.0, 6.0, 0.0)})
    told = population.explain("climber")
    population.close()
    assert states["climber"].reason is Reason.ARRIVED
    assert states["climber"].z_m == pytest.approx(UPPER_M, abs=1e-4)
    assert states["climber"].goal == (11.0, 6.0, UPPER_M)
    assert told.people == [], "people on the floor below are of no concern"
    assert states["stays"].z_m == 0.0
    assert population.trips >= 1


def test_bodies_are_checked() -> None:
    with pytest.raises(ValueError, match="leg_length_m"):
        ActorParameters(step_on_m=0.6, leg_length_m=0.5)
    assert CHILD.body.height_m == 1.3
