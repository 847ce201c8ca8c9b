"""The navigator's API: what may be asked, what is refused, and what never matters."""

import inspect
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.actors import ActorParameters, Navigator, ObservedPeople, Reason
from esplanade.planning import (
    LayeredGrid,
    PlanModel,
    RiskModel,
    SavedAgentsError,
    Scene,
    Spawn,
)
from tests.actors.worlds import BODY, TICK_S, along, block, holds, navigator, run

OPEN = Scene.open_space((0.0, 0.0, 12.0, 12.0))
GRID = LayeredGrid.from_scene(OPEN)


def test_others_measure_through_these_names() -> None:
    text = OPEN.model_dump_json()
    scene = Scene.model_validate_json(text)
    nav = Navigator(scene, tick_s=0.1, seed=0)
    nav.add_actor(
        "a",
        position=(2.0, 2.0),
        goal=(4.0, 2.0),
        parameters=ActorParameters(
            radius_m=0.25, speed_mps=1.3, max_speed_mps=1.7, max_acceleration_mps2=2.0
        ),
    )
    nav.observe({"p1": (8.0, 8.0), "p2": (9.0, 9.0)})
    state = nav.tick()["a"]
    nav.close()
    assert state.position == pytest.approx((2.01, 2.0), abs=0.02)
    assert state.velocity == pytest.approx((0.2, 0.0), abs=0.15)
    assert abs(state.heading) < 1.0
    assert (state.layer, state.z_m, state.goal) == (0, 0.0, (4.0, 2.0, 0.0))
    assert state.reason is Reason.MOVING
    assert state.path.shape == (nav.plan.slices + 1, 4)
    assert state.path[0] == pytest.approx([2.0, 2.0, 0.0, 0.0])
    assert list(inspect.signature(Navigator).parameters)[:3] == ["scene", "tick_s", "seed"]


def test_an_actor_walks_to_its_goal_at_its_speed_and_stays() -> None:
    nav = navigator(GRID)
    nav.add_actor("a", (2.0, 6.0), (10.0, 6.0), BODY)
    record = run(nav, 12.0)
    nav.close()
    speeds = np.hypot(*np.diff(record.positions["a"], axis=0).T) / TICK_S
    assert speeds.max() <= 1.7 + 1e-6
    assert np.median(speeds[10:50]) == pytest.approx(1.3, abs=0.1)
    assert record.arrival_s("a") < 8.0 / 1.3 + 2.0
    assert record.sideways("a", 6.0) < 0.3
    assert record.reasons["a"][-1] is Reason.ARRIVED
    assert record.positions["a"][-1] == pytest.approx([10.0, 6.0], abs=BODY.goal_tolerance_m)
    assert np.ptp(record.positions["a"][-20:], axis=0).max() < 0.02


def test_a_zone_without_actors_ticks() -> None:
    nav = navigator(GRID)
    nav.observe({"p": (3.0, 3.0)})
    assert nav.tick() == {}
    assert len(nav.predicted_near((3.0, 3.0), 0.0, 1.0)) == 1
    nav.close()


def test_people_may_be_given_as_arrays() -> None:
    states = []
    for kind in (tuple, list, np.array):
        nav = navigator(GRID)
        nav.add_actor("a", (2.0, 6.0), (10.0, 6.0), BODY)
        nav.observe({"p": kind((4.0, 6.0)), "q": kind((5.0, 6.5))})
        states.append(nav.tick()["a"])
        nav.close()
    assert states[0].position == states[1].position == states[2].position


def test_an_actor_shows_itself_before_its_first_tick() -> None:
    nav = navigator(GRID)
    nav.add_actor("a", (2.0, 6.0), (10.0, 6.0), BODY, heading=0.5)
    before = nav.state("a")
    nav.close()
    assert (before.position, before.layer, before.z_m) == ((2.0, 6.0), 0, 0.0)
    assert (before.heading, before.velocity) == (0.5, (0.0, 0.0))
    assert before.reason is Reason.WAITING
    assert (before.path[:, :3] == (2.0, 6.0, 0.0)).all()


def test_without_a_goal_it_stands() -> None:
    nav = navigator(GRID)
    nav.add_actor("a", (2.0, 6.0))
    record = run(nav, 1.0)
    nav.close()
    assert np.ptp(record.positions["a"], axis=0).max() < 1e-9
    assert record.reasons["a"][-1] is Reason.WAITING


def test_a_goal_may_change_and_be_taken_away() -> None:
    nav = navigator(GRID)
    nav.add_actor("a", (6.0, 6.0), (10.0, 6.0), BODY)
    run(nav, 1.5)
    nav.set_goal("a", (2.0, 6.0))
    back = run(nav, 6.0)
    assert back.positions["a"][-1] == pytest.approx([2.0, 6.0], abs=0.25)
    nav.set_goal("a", None)
    assert run(nav, 0.5).reasons["a"][-1] is Reason.WAITING
    nav.close()


@pytest.mark.parametrize("spawns", [(), (Spawn(position=(1.0, 1.0)),)], ids=["roof", "no roof"])
def test_a_goal_inside_a_building_is_moved_beside_it(spawns) -> None:
    scene = Scene.open_space((0.0, 0.0, 12.0, 12.0), polygons=[block(7.0, 4.0, 9.0, 8.0)])
    nav = navigator(scene.model_copy(update={"spawns": spawns}))
    nav.add_actor("a", (2.0, 6.0), (7.4, 6.0), BODY)
    record = run(nav, 6.0)
    nav.close()
    assert record.reasons["a"][-1] is Reason.ARRIVED
    assert 6.2 < record.positions["a"][-1, 0] < 6.8


@pytest.mark.parametrize("start", [(2.0, 2.0), (6.0, 2.0), (2.0, 6.0)])
def test_where_no_way_leads_it_says_so_and_stands(start) -> None:
    room = [
        ((4.0, 4.0), (8.0, 4.0)),
        ((8.0, 4.0), (8.0, 8.0)),
        ((8.0, 8.0), (4.0, 8.0)),
        ((4.0, 8.0), (4.0, 4.0)),
    ]
    nav = navigator(Scene.open_space((0.0, 0.0, 12.0, 12.0), walls=room))
    nav.add_actor("a", start, (6.0, 6.0), BODY)
    record = run(nav, 2.0)
    nav.close()
    assert set(record.reasons["a"]) == {Reason.NO_PATH}
    assert np.ptp(record.positions["a"], axis=0).max() < 0.05


def test_parameters_may_change_while_it_walks() -> None:
    nav = navigator(GRID)
    nav.add_actor("a", (1.0, 6.0), (11.0, 6.0), BODY)
    run(nav, 2.0)
    slow = ActorParameters(radius_m=0.3, speed_mps=0.5, max_speed_mps=0.6)
    nav.set_parameters("a", slow)
    assert nav.parameters("a") == slow
    record = run(nav, 4.0)
    nav.close()
    speeds = np.hypot(*np.diff(record.positions["a"][20:], axis=0).T) / TICK_S
    assert speeds.max() <= 0.6 + 1e-6
    assert np.median(speeds) == pytest.approx(0.5, abs=0.1)


def test_another_simulation_may_put_it_elsewhere() -> None:
    nav = navigator(GRID)
    nav.add_actor("a", (2.0, 6.0), (10.0, 6.0), BODY)
    run(nav, 1.0)
    nav.place_actor("a", (5.0, 7.0), velocity=(1.0, 0.0))
    nav.observe({})
    state = nav.tick()["a"]
    nav.close()
    assert state.position == pytest.approx((5.1, 7.0), abs=0.06)


def test_predicted_people_are_those_near_and_their_circles_grow() -> None:
    nav = navigator(GRID)
    for k in range(10):
        nav.observe({"near": (5.0 + 0.1 * k, 6.0), "far": (11.0, 11.0)})
        nav.tick()
    circles = nav.predicted_near((6.0, 6.0), 0.0, 3.0)
    assert nav.predicted_near((6.0, 6.0), 3.3, 3.0) == []
    nav.close()
    assert len(circles) == 1
    assert circles[0].shape == (nav.plan.slices + 1, 4)
    assert circles[0][0, :3] == pytest.approx([5.9, 6.0, 0.0], abs=1e-6)
    assert circles[0][10, 0] == pytest.approx(5.9 + 2.0, abs=0.05)
    assert (np.diff(circles[0][:, 3]) > 0.0).all()


def snapshot(nav):
    columns = [np.copy(array) for array in (*nav.table.agents, *nav.table.trips)]
    return columns, nav.table.ids, nav._history.ids


@pytest.mark.parametrize(
    ("error", "call"),
    [
        (ValueError, lambda nav: nav.add_actor("a", (3.0, 3.0))),
        (ValueError, lambda nav: nav.add_actor("b", (math.nan, 3.0))),
        (ValueError, lambda nav: nav.add_actor("b", (13.0, 3.0))),
        (ValueError, lambda nav: nav.add_actor("b", (3.0, 3.0), (3.0, math.inf))),
        (ValueError, lambda nav: nav.add_actor("b", (3.0, 3.0), (3.0, -1.0))),
        (ValueError, lambda nav: nav.add_actor("b", (3.0, 3.0), z_m=math.nan)),
        (ValueError, lambda nav: nav.add_actor("b", (3.0, 3.0), (4.0, 4.0), goal_z_m=math.inf)),
        (ValueError, lambda nav: nav.set_goal("a", (math.nan, 0.0))),
        (ValueError, lambda nav: nav.set_goal("a", (-1.0, 0.0))),
        (ValueError, lambda nav: nav.set_goal("a", (1.0, 1.0), z_m=math.nan)),
        (ValueError, lambda nav: nav.place_actor("a", (99.0, 1.0))),
        (ValueError, lambda nav: nav.place_actor("a", (1.0, 1.0), velocity=(math.nan, 0.0))),
        (ValueError, lambda nav: nav.observe({"p": (math.nan, 1.0)})),
        (ValueError, lambda nav: nav.observe({"q": (1.0, 1.0), "p": (1.0,)})),
        (ValueError, lambda nav: nav.observe({"p": (1.0, 1.0, math.nan)})),
        (ValueError, lambda nav: nav.observe({"p": (1.0, 1.0, -math.inf)})),
        (KeyError, lambda nav: nav.set_goal("x", (1.0, 1.0))),
        (KeyError, lambda nav: nav.set_parameters("x", BODY)),
        (KeyError, lambda nav: nav.remove_actor("x")),
        (KeyError, lambda nav: nav.place_actor("x", (1.0, 1.0))),
        (KeyError, lambda nav: nav.parameters("x")),
    ],
)
def test_bad_input_is_refused_and_changes_nothing(error, call) -> None:
    nav = navigator(GRID)
    nav.add_actor("a", (2.0, 2.0), (9.0, 9.0), BODY)
    nav.observe({"p": (6.0, 6.0)})
    nav.tick()
    before = snapshot(nav)
    with pytest.raises(error):
        call(nav)
    after = snapshot(nav)
    for one, other in zip(before[0], after[0], strict=True):
        np.testing.assert_array_equal(one, other)
    assert before[1:] == after[1:]
    nav.observe({"p": (6.1, 6.0)})
    assert np.isfinite(nav.tick()["a"].position).all()
    nav.close()


@pytest.mark.parametrize("tick_s", [0.0, -0.1, 0.6, math.nan])
def test_a_tick_has_a_sensible_length(tick_s) -> None:
    with pytest.raises(ValueError, match="tick_s"):
        Navigator(GRID, tick_s=tick_s)


def some(seed: int, actors: int):
    """Starts, goals and walking people that do not stand in each other."""
    rng = np.random.default_rng(seed)
    cells = rng.permutation(100)[: 2 * actors + 4]
    spots = (
        1.0 + np.stack([cells % 10, cells // 10], axis=1) + rng.uniform(-0.1, 0.1, (len(cells), 2))
    )
    spots = spots.tolist()
    people = {
        f"p{k}": along(spots[-1 - k], rng.uniform(1.0, 11.0, 2).tolist(), speed_mps=0.9)
        for k in range(4)
    }
    return spots[:actors], spots[actors : 2 * actors], people


def play(world: int, actors: int, seconds: float, *, turned: bool = False, **changes):
    starts, goals, people = some(world, actors)
    nav = navigator(GRID, **changes)
    rows = list(range(actors))
    for k in reversed(rows) if turned else rows:
        nav.add_actor(f"a{k}", starts[k], goals[k], BODY)
    if turned:
        people = dict(reversed(people.items()))
    record = run(nav, seconds, people)
    nav.close()
    return record


def same(one, other) -> bool:
    return (
        one.positions.keys() == other.positions.keys()
        and all(np.array_equal(one.positions[a], other.positions[a]) for a in one.positions)
        and one.reasons == other.reasons
    )


@given(st.integers(0, 1000))
@holds(2)
def test_neither_the_order_of_adding_nor_of_listing_nor_threads_matter(seed) -> None:
    once = play(seed, 8, 3.0)
    assert same(once, play(seed, 8, 3.0))
    assert same(once, play(seed, 8, 3.0, turned=True))
    assert same(once, play(seed, 8, 3.0, threads=2))


def test_the_seed_decides_between_those_with_equal_ways_and_nothing_else() -> None:
    def meet(seed: int):
        nav = navigator(GRID, seed=seed)
        nav.add_actor("a", (2.0, 6.0), (10.0, 6.0), BODY)
        nav.add_actor("b", (6.0, 2.0), (6.0, 10.0), BODY)
        record = run(nav, 4.0)
        nav.close()
        return record

    records = [meet(seed) for seed in range(4)]
    assert any(not same(records[0], record) for record in records[1:])
    assert same(play(4, 1, 4.0), play(4, 1, 4.0, seed=1))


@given(st.integers(0, 1000))
@holds(4)
def test_actors_never_touch_each_other(seed) -> None:
    record = play(seed, 10, 5.0)
    assert record.nearest_actors() >= 0.5
    for track in record.positions.values():
        assert (track >= 0.0).all()
        assert (track <= 12.0).all()


@given(st.integers(0, 1000))
@holds(6)
def test_among_walls_nobody_walks_through_one(seed) -> None:
    rng = np.random.default_rng(seed)
    turns = rng.uniform(0.0, np.pi, 6)
    starts = rng.uniform(1.0, 9.0, (6, 2))
    ends = starts + 2.5 * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    walls = list(zip(map(tuple, starts), map(tuple, ends), strict=True))
    nav = navigator(Scene.open_space((0.0, 0.0, 12.0, 12.0), walls=walls))
    spots = [spot for spot in rng.uniform(0.5, 11.5, (60, 2)).tolist()
             if nav.grid.is_free([spot], [0], 0.4)[0]][:8]  # fmt: skip
    for k in range(4):
        nav.add_actor(f"a{k}", spots[k], spots[k + 4], BODY)
    before = np.array(spots[:4])
    for _ in range(50):
        nav.observe({})
        states = nav.tick()
        now = np.array([states[f"a{k}"].position for k in range(4)])
        assert [states[f"a{k}"].layer for k in range(4)] == [0] * 4
        for a, b in zip(before, now, strict=True):
            assert not any(meets(a, b, *map(np.array, wall)) for wall in walls)
        # Cells know a wall to within half their diagonal.
        assert nav.grid.clearance(now, [0] * 4).min() > 0.25 - 0.18
        before = now
    nav.close()


def meets(a, b, c, d) -> bool:
    def side(p, q, r) -> float:
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    return side(a, b, c) * side(a, b, d) < 0.0 and side(c, d, a) * side(c, d, b) < 0.0


def test_acceleration_is_kept_but_when_another_actor_is_in_the_way() -> None:
    nav = navigator(GRID)
    nav.add_actor("a", (2.0, 6.0), (10.0, 6.0), BODY)
    velocity = np.zeros(2)
    crossing = along((6.0, 2.0), (6.0, 10.0))
    for k in range(90):
        nav.observe({"p": crossing(k * TICK_S)})
        state = nav.tick()["a"]
        assert math.dist(state.velocity, velocity) <= 2.0 * TICK_S + 1e-6
        velocity = state.velocity
    nav.close()


def test_who_leaves_is_forgotten_and_ids_may_be_used_again() -> None:
    nav = navigator(GRID)
    for name in ("a", "b", "c"):
        nav.add_actor(name, (2.0 + 2.0 * ord(name[0]) % 7, 3.0), (6.0, 9.0), BODY)
    run(nav, 0.5)
    nav.remove_actor("b")
    nav.observe({})
    assert set(nav.tick()) == {"a", "c"}
    nav.add_actor("b", (9.0, 2.0), (2.0, 2.0), BODY)
    record = run(nav, 1.0)
    nav.close()
    assert record.positions["b"][-1, 0] < 9.0
    assert set(record.positions) == {"a", "b", "c"}


def crossing(count: int) -> Navigator:
    navigator = Navigator(Scene.open_space((0.0, 0.0, 12.0, 12.0)), tick_s=0.1, seed=4)
    for k in range(count):
        angle = 2.0 * math.pi * k / count
        at = 6.0 + 4.0 * math.cos(angle), 6.0 + 4.0 * math.sin(angle)
        body = ActorParameters(radius_m=0.2 + 0.05 * (k % 3))
        navigator.add_actor(k, at, (12.0 - at[0], 12.0 - at[1]), body)
    return navigator


def test_actors_that_were_saved_go_on_as_they_would_have() -> None:
    first, second = crossing(6), crossing(2)
    for _ in range(20):
        first.observe({})
        first.advance()
    second.load(*first.table.save())
    for _ in range(20):
        for each in (first, second):
            each.observe({})
            each.advance()
    (header, columns), (other_header, others) = first.table.save(), second.table.save()
    assert header == other_header
    for name, column in columns.items():
        np.testing.assert_array_equal(column, others[name], err_msg=name)
    first.close()
    second.close()


def test_saved_actors_of_another_horizon_are_refused_and_nothing_changes() -> None:
    first, second = crossing(2), Navigator(OPEN, plan=PlanModel(steps=5))
    second.add_actor("a", (1.0, 1.0))
    with pytest.raises(SavedAgentsError, match="plan 18 slices ahead, this zone 10"):
        second.load(*first.table.save())
    assert second.table.ids == ["a"]
    first.close()
    second.close()


@pytest.mark.parametrize(
    ("radius_m", "person_radius_m"), [(0.25, 0.25), (0.9, 0.25), (0.25, 0.6), (0.15, 0.25)]
)
def test_room_to_a_person_grows_with_both_radii(radius_m, person_radius_m) -> None:
    """Somebody stands in the middle of the way: how near an actor passes depends on both bodies."""
    scene = Scene.open_space((0.0, 0.0, 14.0, 10.0))
    risk = RiskModel(person_radius_m=person_radius_m)
    navigator = Navigator(scene, tick_s=0.1, risk=risk)
    body = ActorParameters(radius_m=radius_m)
    navigator.add_actor("a", (1.0, 5.05), (13.0, 5.05), body)
    nearest = math.inf
    for _ in range(150):
        navigator.observe({"p": (7.0, 5.0)})
        nearest = min(nearest, math.dist(navigator.tick()["a"].position, (7.0, 5.0)))
    navigator.close()
    assert navigator.state("a").reason is Reason.ARRIVED
    assert nearest > radius_m + person_radius_m + 0.05


def test_arrays_of_people_are_seen_as_a_mapping_is() -> None:
    walks = {3: (1.0, 0.5), 11: (-0.5, 0.2), 2: (0.0, -1.0)}
    first, second = crossing(4), crossing(4)
    for tick in range(30):
        if tick == 15:
            del walks[11]
        now = 0.1 * tick
        seen = {who: (6.0 + vx * now, 6.0 + vy * now, 0.0) for who, (vx, vy) in walks.items()}
        first.observe(seen)
        ids = np.array(list(seen), dtype=np.int64)
        second.observe(ObservedPeople(ids, np.array(list(seen.values()))))
        first.advance()
        second.advance()
    np.testing.assert_array_equal(first.table.agents.positions, second.table.agents.positions)
    first.close()
    second.close()
