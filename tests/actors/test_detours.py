"""An actor goes another way when somebody stands in a doorway, and does not dither."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from esplanade.actors import Navigator, Outcome
from esplanade.actors.ways_around import AGAIN_S, PAUSE_S
from esplanade.planning import AgentTable, PlanModel, Scene, Wall
from esplanade.planning.routes.shut_way import ShutWays
from tests.actors.worlds import navigator
from tests.planning.worlds import scaled

Point = tuple[float, float]
START, GOAL, DOOR = (6.0, 4.6), (14.0, 4.6), (10.0, 4.6)


def scene(*doors: Point, side_m: float = 14.0) -> Scene:
    """Two rooms with doorways from y to y in the wall between them."""
    ends = [0.0, *(y for door in doors for y in door), side_m]
    pairs = zip(ends[::2], ends[1::2], strict=True)
    walls = tuple(Wall(start=(10.0, a), end=(10.0, b)) for a, b in pairs)
    return Scene(bounds=(0.0, 0.0, 20.0, side_m), walls=walls)


TWO = scene((4.0, 5.2), (8.0, 9.2))


def arrival_s(nav: Navigator, people, most_s: float = 40.0) -> float:
    """When actor "a" arrives; `people` tells where everyone is at some seconds."""
    for tick in range(round(most_s / nav.tick_s)):
        nav.observe(people(tick * nav.tick_s))
        if nav.tick()["a"].outcome is Outcome.ARRIVED:
            return (tick + 1) * nav.tick_s
    return math.inf


def walk(ground: Scene, people) -> tuple[Navigator, float]:
    nav = navigator(ground)
    nav.add_actor("a", START, GOAL)
    return nav, arrival_s(nav, people)


def test_a_plugged_doorway_costs_hardly_more_than_one_that_is_walled_up() -> None:
    _, walled_s = walk(scene((8.0, 9.2)), lambda _: {})
    nav, plugged_s = walk(TWO, lambda _: {"p": DOOR})
    assert plugged_s <= walled_s + 2.0
    assert len(nav.detours) == 1


def test_nothing_is_looked_for_where_nobody_stands_in_the_way() -> None:
    _, alone_s = walk(TWO, lambda _: {})
    nav, beside_s = walk(TWO, lambda _: {"p": (3.0, 11.0), "q": (17.0, 1.0)})
    assert beside_s == alone_s
    assert len(nav.detours) == 0
    assert sum(nav.potentials.users) == 1


def test_somebody_who_leaves_room_in_an_open_place_makes_nobody_go_another_way() -> None:
    nav, _ = walk(scene((2.0, 7.2), (9.0, 10.2)), lambda _: {"p": (10.0, 4.6)})
    assert not nav.table.trips.detours.any()


def test_an_actor_waits_for_somebody_who_goes_on_soon_when_the_other_way_is_long() -> None:
    ground = scene((4.0, 5.2), (28.0, 29.2), side_m=32.0)
    nav = navigator(ground)
    nav.add_actor("a", START, GOAL)
    took_s = arrival_s(nav, lambda s: {"p": DOOR if s < 4.0 else (3.0, 12.0)})
    assert took_s < 12.0


def test_an_actor_comes_back_when_the_doorway_has_cleared_early() -> None:
    ground = scene((4.0, 5.2), (24.0, 25.2), side_m=28.0)
    nav = navigator(ground)
    nav.add_actor("a", START, GOAL)
    took_s = arrival_s(nav, lambda s: {"p": DOOR if s < 7.0 else (16.0, 2.0)})
    assert took_s < 25.0
    assert len(nav.detours) == 0
    assert sum(nav.potentials.users) == 1


def test_an_actor_changes_its_mind_once_for_somebody_who_stays() -> None:
    nav = navigator(TWO)
    nav.add_actor("a", START, GOAL)
    changes, before = 0, False
    for _ in range(scaled(120, 60)):
        nav.observe({"p": DOOR})
        nav.tick()
        now = bool(nav.table.trips.detours[0])
        changes, before = changes + (now is not before), now
    assert changes <= 2


def test_actors_with_one_goal_share_one_way_around_and_others_make_none_anew() -> None:
    nav = navigator(TWO)
    nav.add_actor("a", START, GOAL)
    nav.add_actor("b", (5.0, 3.0), GOAL)
    nav.add_actor("c", (2.0, 12.0), (8.0, 12.0))
    own = nav.potentials.arrays[nav.table.trips.own_rows[2]].copy()
    for _ in range(20):
        nav.observe({"p": DOOR})
        nav.tick()
    trips = nav.table.trips
    assert trips.detours.tolist() == [True, True, False]
    assert nav.table.agents.potential_rows[0] == nav.table.agents.potential_rows[1]
    assert len(nav.detours) == 1
    assert np.array_equal(nav.potentials.arrays[trips.own_rows[2]], own)


def test_a_second_doorway_that_is_plugged_too_is_not_tried() -> None:
    nav = navigator(scene((4.0, 5.2), (8.0, 9.2), (12.0, 13.2), side_m=16.0))
    nav.add_actor("a", START, GOAL)
    assert arrival_s(nav, lambda _: {"p": DOOR, "q": (10.0, 8.6)}) < 25.0


@pytest.mark.parametrize("ticks", [12, 20])
def test_saved_actors_go_on_around_people_bit_by_bit(ticks: int) -> None:
    one = navigator(TWO)
    one.add_actor("a", START, GOAL)
    one.add_actor("idle", DOOR)
    one.add_actor("b", (5.0, 3.0), GOAL)
    for _ in range(ticks):
        one.observe({})
        one.tick()
    other = Navigator(TWO, plan=PlanModel(threads=1))
    other.load(*one.save())
    for _ in range(30):
        for nav in (one, other):
            nav.observe({})
            nav.tick()
        for name, ours in one.table.agents._asdict().items():
            if name not in ("bodies", "contacts", "potential_rows"):
                assert ours.tobytes() == getattr(other.table.agents, name).tobytes(), name
        assert np.array_equal(one.table.trips.detours, other.table.trips.detours)


def test_what_was_undone_happens_again_in_the_same_way() -> None:
    nav = navigator(TWO)
    nav.add_actor("a", START, GOAL)
    for _ in range(12):
        nav.observe({"p": DOOR})
        nav.tick()
    assert nav.table.trips.detours[0]
    undo = nav.undo_point()
    before = nav.table.agents.potential_rows.copy()
    nav.set_goal("a", (2.0, 2.0))
    undo()
    assert np.array_equal(nav.table.agents.potential_rows, before)
    assert isinstance(nav.table, AgentTable)


def test_a_way_around_that_is_derived_after_loading_is_taken() -> None:
    nav = navigator(TWO)
    nav.add_actor("a", START, GOAL)
    for _ in range(12):
        nav.observe({"p": DOOR})
        nav.tick()
    other = Navigator(TWO, plan=PlanModel(threads=1))
    other.potentials.derived_outside = True
    other.load(*nav.save())
    trips, agents = other.table.trips, other.table.agents
    assert trips.detours[0]
    assert agents.potential_rows[0] == trips.own_rows[0]
    while (derive := other.potentials.outdated()) is not None:
        other.potentials.renew(derive())
    for _ in range(6):
        other.observe({"p": DOOR})
        other.tick()
    assert trips.detours[0]
    assert agents.potential_rows[0] != trips.own_rows[0]


def test_both_the_way_around_that_is_gone_and_the_one_that_follows_are_saved() -> None:
    nav = navigator(TWO)
    nav.add_actor("a", START, GOAL)
    for _ in range(12):
        nav.observe({"p": DOOR})
        nav.tick()
    undo = nav.undo_point()
    ((key, (shut, _, derived_s)),) = nav.detours.undo_point().items()
    wanted = shut._replace(places=(*shut.places, (10.0, 8.6, 0.0, 0.5)))
    both = shut, wanted, derived_s
    nav.detours.put_back(nav.table, {key: both})
    assert nav.detours.undo_point() == {key: both}
    other = Navigator(TWO, plan=PlanModel(threads=1))
    other.load(*nav.save())
    assert other.detours.undo_point() == {key: both}
    for one in (nav, other):
        assert one.table.trips.detours[0]
    ours, theirs = (
        one.potentials.arrays[one.table.agents.potential_rows[0]] for one in (nav, other)
    )
    assert np.array_equal(ours, theirs)
    undo()
    assert nav.detours.undo_point() == {key: (shut, shut, derived_s)}


def test_the_way_of_a_goal_is_derived_anew_at_most_once_in_a_while() -> None:
    nav = navigator(TWO)
    nav.add_actor("a", START, GOAL)
    derived = []
    for tick in range(60):
        # One person stands in the door all the time, and beside it others come every half second.
        there = (10.3, DOOR[1] + 0.1 * (tick // 10))
        nav.observe({"p": DOOR, f"q{tick // 10}": there})
        nav.tick()
        ways = [state[0] for state in nav.detours.undo_point().values()]
        if ways and (not derived or derived[-1][1] != ways[0]):
            derived.append((tick, ways[0]))
    assert len(derived) >= 2
    ticks = [tick for tick, _ in derived]
    assert min(b - a for a, b in itertools.pairwise(ticks)) * nav.tick_s >= AGAIN_S - 1e-9


def test_ways_of_two_goals_are_not_derived_at_once() -> None:
    nav = navigator(TWO)
    nav.add_actor("a", START, GOAL)
    nav.add_actor("b", (START[0] - 1.0, START[1]), (GOAL[0], GOAL[1] + 1.0))
    known = [0]
    for _ in range(20):
        nav.observe({"p": DOOR})
        nav.tick()
        known.append(len(nav.detours))
    assert known[-1] == 2
    assert (known.index(2) - known.index(1)) * nav.tick_s >= PAUSE_S - 1e-9


def test_the_gap_beside_an_actor_is_shut_by_the_same_room_however_often_it_is_seen() -> None:
    nav = navigator(scene((4.0, 5.2)))
    nav.add_actor("a", (8.6, 4.6), GOAL)
    nav.add_actor("idle", DOOR)
    rooms = set()
    for _ in range(20):
        nav.table.trips.stalled_s[0] = 3.0
        nav.table.agents.positions[0] = 8.6, 4.6
        nav.observe({})
        nav.tick()
        for _, wanted, *_ in nav.detours.save(nav.table):
            rooms |= {disc[3] for disc in wanted}
    assert 0.65 in rooms
    assert rooms <= {0.3, 0.65}


def test_bodies_out_of_reach_are_not_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    looked_at: list[int] = []
    shut_by = ShutWays.shut_by

    def spy(self: ShutWays, *given):
        looked_at.append(len(given[5]))
        return shut_by(self, *given)

    monkeypatch.setattr(ShutWays, "shut_by", spy)
    walls = tuple(Wall(start=(10.0, a), end=(10.0, b)) for a, b in ((0.0, 4.0), (5.2, 8.0)))
    nav = navigator(Scene(bounds=(0.0, 0.0, 70.0, 8.0), walls=walls))
    nav.add_actor("a", START, GOAL)
    for _ in range(12):
        nav.observe({"p": DOOR, "near": (40.0, 4.0), "far": (66.0, 4.0)})
        nav.tick()
    assert set(looked_at) == {2}


def test_goals_beyond_the_bound_have_no_way_around_and_are_counted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("esplanade.actors.ways_around.MOST_DETOURS", 1)
    nav = navigator(TWO)
    nav.add_actor("a", START, GOAL)
    nav.add_actor("b", (5.0, 3.0), (14.0, 5.4))
    for _ in range(30):
        nav.observe({"p": DOOR})
        nav.tick()
    assert len(nav.detours) == 1
    assert nav.table.trips.detours.sum() == 1
    assert nav.detours.refused >= 2


def test_where_no_way_leads_with_room_to_people_the_wider_gap_beside_them_is_taken() -> None:
    walls = Wall(start=(6.99, 5.68), end=(12.0, 6.68)), Wall(start=(5.07, 5.29), end=(0.0, 4.28))
    nav = navigator(Scene(bounds=(0.0, 0.0, 12.0, 12.0), walls=walls))
    nav.add_actor("a", (3.55, 6.84), (5.5, 4.07))
    assert arrival_s(nav, lambda _: {"p": (5.95, 5.47)}, 30.0) < 16.0
