"""Actors that are planned by turns: who is due, what the others do, and that nobody touches."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.actors import ActorParameters, GoTo, Navigator, Population, Reason
from esplanade.actors.planning_interval import PlanningInterval
from esplanade.planning import LayeredGrid, PlanModel, RuleModel, SavedAgentsError, Scene
from tests.actors.worlds import BODY, TICK_S, along, holds, plaza, run

STREAMS = Scene.open_space((0.0, 0.0, 16.0, 10.0))
WALKS = {f"p{k}": along((8.0 + k, 1.0), (6.0 + k, 9.0), speed_mps=0.8) for k in range(3)}
ACTORS = 12


def streams(interval: int = 1, threads: int = 1, checked_slices: int = 6) -> Navigator:
    """Two streams of actors against each other, among people who cross."""
    plan = PlanModel(threads=threads, interval_s=interval * TICK_S)
    made = Navigator(STREAMS, TICK_S, plan=plan, rules=RuleModel(checked_slices=checked_slices))
    for n in range(ACTORS):
        start, goal = (2.0, 14.0)[:: 1 if n % 2 else -1]
        made.add_actor(f"a{n}", (start, 1.5 + 0.6 * n), (goal, 8.0 - 0.6 * n), BODY)
    return made


def ticks(made: Navigator, number: int, first: int = 0) -> None:
    for k in range(first, first + number):
        made.observe({name: walk(k * TICK_S) for name, walk in WALKS.items()})
        made.advance()


def columns(made: Navigator) -> list[bytes]:
    return [column.tobytes() for column in (*made.table.agents, *made.table.trips)]


@given(st.integers(1, 6), st.integers(0, 50), st.integers(0, 1000))
@holds(50)
def test_each_actor_is_due_once_in_an_interval(interval: int, actors: int, count: int) -> None:
    turns = PlanningInterval(interval)
    turns.count = count
    ranks = np.random.default_rng(actors).permutation(actors)
    times = np.zeros(actors, dtype=np.int64)
    for _ in range(interval):
        due = turns.due(ranks)
        assert actors // interval <= due.sum() <= -(-actors // interval)
        times += due
        turns.count += 1
    assert (times == 1).all()


def test_an_interval_is_a_number_of_ticks() -> None:
    with pytest.raises(ValueError, match="at least one tick, got 0"):
        PlanningInterval(0)
    for interval_s in (-0.1, math.nan, math.inf):
        with pytest.raises(ValueError, match="interval_s must be at least 0"):
            PlanModel(interval_s=interval_s)
    turns = PlanningInterval(3)
    with pytest.raises(ValueError, match="at least one tick, got -1"):
        turns.ticks = -1
    for saved in ({"ticks": 0}, {"ticks": "2"}, {"count": -1}, {"count": 0.5}):
        with pytest.raises(SavedAgentsError, match="planning interval"):
            turns.load(saved)
    assert turns.save() == {"ticks": 3, "count": 0}


@pytest.mark.parametrize(("tick_s", "ticks"), [(0.1, 1), (0.05, 2), (1 / 60, 6), (0.3, 1)])
def test_the_usual_interval_is_a_tenth_of_a_second_in_whole_ticks(tick_s, ticks) -> None:
    nav = Navigator(STREAMS, tick_s)
    assert (nav.planning_interval.ticks, nav.planning_interval.usual) == (ticks, ticks)
    nav.close()


@pytest.mark.parametrize("threads", [1, 2])
def test_those_who_are_due_decide_as_ever_and_the_others_go_on(threads: int) -> None:
    """From one state, with everybody due and with every third."""
    every, third = streams(1, threads, 0), streams(1, threads, 0)
    for made in (every, third):
        ticks(made, 25)
    third.planning_interval.ticks = 3
    due = third.planning_interval.due(third.table.agents.ranks)
    assert 0 < due.sum() < ACTORS
    for made in (every, third):
        ticks(made, 1, 25)
    ours, theirs = (made._batch.zone.decisions for made in (every, third))
    assert ours.replanned.all()
    assert np.array_equal(theirs.replanned, due)
    for one, other in zip(ours, theirs, strict=True):
        if one is not ours.reasons:  # the steps of others may change them
            assert np.array_equal(one[due], other[due])
    followed = third._batch.zone.world.reservations.paths
    assert np.array_equal(theirs.paths[~due], followed[~due])
    assert not theirs.renewed[~due].any()
    assert not theirs.expansions[~due].any()
    for made in (every, third):
        made.close()


@pytest.mark.parametrize("interval", [2, 3, 4])
def test_nobody_touches_and_everybody_arrives_in_about_the_same_time(interval: int) -> None:
    took_s = []
    for each in (1, interval):
        made = streams(each)
        record = run(made, 25.0, WALKS)
        made.close()
        assert record.nearest_actors() >= 2.0 * BODY.radius_m
        assert min(record.nearest_person(actor) for actor in record.positions) > BODY.radius_m
        took_s.append([record.arrival_s(actor) for actor in record.positions])
        for actor, reasons in record.reasons.items():
            speeds = np.hypot(*np.diff(record.positions[actor], axis=0).T) / TICK_S
            for reason, speed in zip(reasons[1:], speeds.tolist(), strict=True):
                assert speed > 0.01 or reason not in {Reason.MOVING, Reason.REPLANNING}
    assert np.isfinite(took_s).all()
    assert np.mean(took_s[1]) == pytest.approx(np.mean(took_s[0]), rel=0.1)


def test_a_new_goal_is_planned_for_at_once() -> None:
    made = streams(4)
    ticks(made, 12)
    for n in range(ACTORS):
        made.set_goal(f"a{n}", (8.0, 9.0 if n % 2 else 1.0))
    ticks(made, 1, 12)
    assert made._batch.zone.decisions.replanned.all()
    made.close()


def test_saved_actors_go_on_with_the_same_turns() -> None:
    made, again = streams(3), streams(1)
    ticks(made, 10)
    again.load(*made.save())
    # People who were seen by the one alone would be expected elsewhere.
    for nav in (made, again):
        for _ in range(20):
            nav.observe({})
            nav.advance()
    assert again.planning_interval.save() == made.planning_interval.save()
    assert columns(again) == columns(made)
    for nav in (made, again):
        nav.close()


def test_actors_that_were_saved_before_there_were_turns_have_the_usual_ones() -> None:
    made, again = streams(3), streams(2)
    again.planning_interval.ticks = 4
    header, arrays = made.save()
    del header["planning"]
    again.load(header, arrays)
    assert again.planning_interval.save() == {"ticks": 2, "count": 0}
    for nav in (made, again):
        nav.close()


def test_a_tick_that_fails_takes_nobodys_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = plaza()
    population = Population(LayeredGrid.from_scene(scene), scene, tick_s=TICK_S, seed=3)
    population.navigator.planning_interval.ticks = 2
    population.add("a", GoTo("fountain"), ActorParameters(), position=(3.0, 2.0))
    population.advance({})
    advance = population.navigator.advance

    def fail() -> None:
        advance()
        raise MemoryError("told to fail")

    monkeypatch.setattr(population.navigator, "advance", fail)
    with pytest.raises(MemoryError):
        population.advance({})
    assert population.navigator.planning_interval.count == 1
    population.close()


def test_a_trace_tells_who_was_not_due() -> None:
    made = streams(2, checked_slices=0)
    made.tracing.wanted = True
    ticks(made, 20)
    told = {made.trace(f"a{n}").winner == "not_due" for n in range(ACTORS)}
    assert told == {True, False}
    for n in range(ACTORS):
        trace = made.trace(f"a{n}")
        assert trace.exact
        if trace.winner == "not_due":
            assert (len(trace.tree.nodes), trace.tree.expansions) == (0, 0)
            assert trace.searched is trace.perturbed is None
            assert trace.decided.previous is not None
            assert math.isclose(trace.decided.taken.total_s, trace.decided.previous.total_s)
    made.close()
