"""Meetings with numbers: figs. 10 and 11 of Lei & Li, and what goes wrong in real crowds.

Every bad walk ever found becomes a case here.
"""

import math

import numpy as np
import pytest
from tools.paper_scenes import FIG_10, FIG_11

from esplanade.actors import Reason
from esplanade.planning import Scene
from tests.actors.worlds import BODY, TICK_S, along, navigator, run

CONTACT_M = 0.5
"""Sum of the radii of an actor and a person."""
WALK_MPS = 1.3


def straight_s(start, goal) -> float:
    """Seconds of the straight way at the preferred speed."""
    return math.dist(start, goal) / WALK_MPS


def one(scene, start, goal, seconds, people=None):
    nav = navigator(scene)
    nav.add_actor("a", start, goal, BODY)
    record = run(nav, seconds, people)
    nav.close()
    return record


def several(scene, ways, seconds):
    nav = navigator(scene)
    for k, (start, goal) in enumerate(ways):
        nav.add_actor(f"a{k}", start, goal, BODY)
    record = run(nav, seconds)
    nav.close()
    return record


def open_space(x1=16.0, y1=12.0, **parts):
    return Scene.open_space((0.0, 0.0, x1, y1), **parts)


def test_fig_6_walked_to_the_end() -> None:
    """The four cases as they are walked: far, near, heading for the actor, heading away."""
    start, goal = (2.0, 6.0), (14.0, 6.0)
    people = {
        "far": along((3.0, 11.0), (14.0, 11.0), speed_mps=0.5),
        "near": along((6.0, 6.4), (14.0, 6.4), speed_mps=0.5),
        "towards": along((10.0, 6.2), (2.0, 6.2), speed_mps=0.8),
        "away": along((10.0, 6.2), (15.0, 6.2), speed_mps=0.8),
    }
    records = {name: one(open_space(), start, goal, 14.0, {"p": p}) for name, p in people.items()}
    bends = {name: record.sideways("a", 6.0) for name, record in records.items()}
    assert bends["far"] < 0.35
    assert bends["near"] > bends["far"] + 0.2
    assert bends["towards"] > bends["far"] + 0.2
    assert bends["away"] < bends["towards"]
    for name, record in records.items():
        assert record.nearest_person("a") > CONTACT_M, name
        assert record.arrival_s("a") < straight_s(start, goal) + 3.0, name


def seen_and_unseen(figure):
    """The same experiment with people in sight, and with an actor that is blind to them."""
    seen = one(figure.scene, figure.start, figure.goal, figure.seconds, figure.people)
    blind = one(figure.scene, figure.start, figure.goal, figure.seconds)
    blind.people = seen.people
    return seen, blind


def sideways(record, figure) -> float:
    """Largest distance from the straight way, metres."""
    way = np.subtract(figure.goal, figure.start)
    across = np.array([-way[1], way[0]]) / math.hypot(*way)
    return float(np.abs((record.positions["a"] - figure.start) @ across).max())


def test_fig_10_one_person_changes_its_goal_on_the_way() -> None:
    seen, blind = seen_and_unseen(FIG_10)
    assert blind.nearest_person("a") < CONTACT_M, "whoever does not look runs into somebody"
    assert seen.nearest_person("a") > CONTACT_M + 0.2
    assert sideways(blind, FIG_10) < 0.05
    assert sideways(seen, FIG_10) > 0.3, "it makes a bend"
    assert seen.arrival_s("a") < straight_s(FIG_10.start, FIG_10.goal) + 3.0


def test_fig_11_three_people_change_their_goals_among_obstacles() -> None:
    seen, blind = seen_and_unseen(FIG_11)
    assert blind.nearest_person("a") < CONTACT_M
    assert seen.nearest_person("a") > CONTACT_M + 0.1
    assert sideways(seen, FIG_11) > sideways(blind, FIG_11) + 0.2
    assert seen.arrival_s("a") < straight_s(FIG_11.start, FIG_11.goal) + 5.0


@pytest.mark.parametrize("lag", [-0.6, -0.3, 0.0, 0.3, 0.6])
def test_a_person_crosses_about_when_the_actor_is_there(lag) -> None:
    person = along((8.0, 6.0 - 1.2 * (6.0 / WALK_MPS + lag)), (8.0, 12.0))
    record = one(open_space(), (2.0, 6.0), (14.0, 6.0), 14.0, {"p": person})
    assert record.nearest_person("a") > CONTACT_M
    assert record.arrival_s("a") < straight_s((2.0, 6.0), (14.0, 6.0)) + 3.5


def test_a_person_who_stands_in_the_way_is_walked_around() -> None:
    record = one(open_space(), (2.0, 6.0), (14.0, 6.0), 14.0, {"p": along((8.0, 6.0), (8.0, 6.0))})
    assert CONTACT_M + 0.05 < record.nearest_person("a") < 2.0
    assert record.arrival_s("a") < straight_s((2.0, 6.0), (14.0, 6.0)) + 3.0


@pytest.mark.parametrize(
    ("way", "speed_mps", "there_s"),
    [(((13.0, 6.0), (2.0, 6.0)), 0.8, 6.25), (((12.0, 10.0), (2.0, 0.0)), 1.0, 5.66)],
)
def test_a_person_who_will_come_to_the_goal_keeps_nobody_from_it(way, speed_mps, there_s) -> None:
    """An actor that is there first has arrived first, and need not wait until the other is past."""
    person = along(*way, speed_mps=speed_mps)
    assert math.dist(person(there_s), (8.0, 6.0)) < 0.02
    record = one(open_space(), (2.0, 6.0), (8.0, 6.0), 9.0, {"p": person})
    assert record.arrival_s("a") < straight_s((2.0, 6.0), (8.0, 6.0)) + 0.5
    assert record.nearest_person("a") > CONTACT_M + 0.1


@pytest.mark.parametrize("lag", [-0.6, -0.3, 0.0, 0.3, 0.6])
@pytest.mark.parametrize("way", [(0.0, 1.0), (0.6, 0.8), (-0.8, 0.6), (-1.0, 0.0)])
def test_a_person_who_crosses_the_goal_while_the_actor_arrives_is_not_walked_into(way, lag) -> None:
    """The last check ends where the actor stands at its goal, and not before."""
    goal, there_s, speed_mps = np.array((8.0, 6.0)), 4.3 + lag, 1.2
    ends = (goal - np.multiply(way, speed_mps * there_s), goal + np.multiply(way, 6.0))
    person = along(*map(tuple, ends), speed_mps=speed_mps)
    record = one(open_space(), (2.0, 6.0), (8.0, 6.0), 9.0, {"p": person})
    assert record.nearest_person("a") > CONTACT_M + 0.1
    assert record.arrival_s("a") < straight_s((2.0, 6.0), (8.0, 6.0)) + 2.0


def corridor(width):
    walls = [((0.0, 5.0), (16.0, 5.0)), ((0.0, 5.0 + width), (16.0, 5.0 + width))]
    return open_space(walls=walls), 5.0 + width / 2


@pytest.mark.parametrize("width", [1.3, 1.6, 2.4, 6.0])
def test_two_who_meet_head_on_pass_each_other(width) -> None:
    scene, y = corridor(width)
    ways = [((2.0, y), (14.0, y)), ((14.0, y), (2.0, y))]
    record = several(scene, ways, 18.0)
    assert record.nearest_actors() >= 0.5
    for actor in ("a0", "a1"):
        assert record.arrival_s(actor) < straight_s(*ways[0]) + 3.0
        assert Reason.NO_PATH not in record.reasons[actor], "somebody in the way is no wall"


@pytest.mark.parametrize("width", [0.75, 0.9])
def test_at_a_doorway_one_yields_and_both_arrive(width) -> None:
    walls = [((8.0, 0.0), (8.0, 6.0 - width / 2)), ((8.0, 6.0 + width / 2), (8.0, 12.0))]
    ways = [((2.0, 6.0), (14.0, 6.0)), ((14.0, 6.0), (2.0, 6.0))]
    record = several(open_space(walls=walls), ways, 25.0)
    assert record.nearest_actors() >= 0.5
    arrivals = [record.arrival_s(actor) for actor in ("a0", "a1")]
    assert max(arrivals) < straight_s(*ways[0]) + 6.0
    yielding = {Reason.GIVING_WAY, Reason.WAITING, Reason.REPLANNING}
    assert any(yielding & set(reasons) for reasons in record.reasons.values())


def test_four_who_cross_at_a_point_all_arrive() -> None:
    ways = [
        ((4.0, 6.0), (12.0, 6.0)),
        ((12.0, 6.0), (4.0, 6.0)),
        ((8.0, 2.0), (8.0, 10.0)),
        ((8.0, 10.0), (8.0, 2.0)),
    ]
    record = several(open_space(), ways, 18.0)
    assert record.nearest_actors() >= 0.5
    for k in range(4):
        assert record.arrival_s(f"a{k}") < straight_s(*ways[k]) + 4.0


def test_eight_on_a_circle_change_places() -> None:
    turns = np.arange(8) * math.pi / 4
    rim = 6.0 + 4.0 * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    ways = [(tuple(p), tuple(12.0 - p)) for p in rim]
    record = several(open_space(12.0, 12.0), ways, 25.0)
    assert record.nearest_actors() >= 0.5
    assert max(record.arrival_s(f"a{k}") for k in range(8)) < straight_s(*ways[0]) + 8.0


def test_who_has_arrived_makes_way_for_a_person_and_comes_back() -> None:
    person = along((1.0, 6.0), (15.0, 6.0))
    record = one(open_space(), (8.0, 6.0), (8.0, 6.0), 18.0, {"p": person})
    away = np.hypot(*(record.positions["a"] - (8.0, 6.0)).T)
    assert record.nearest_person("a") > CONTACT_M
    assert away.max() > 0.3
    assert away[-1] < 0.35
    assert record.reasons["a"][-1] is Reason.ARRIVED


def test_who_has_no_goal_makes_way_too() -> None:
    record = one(open_space(), (8.0, 6.0), None, 14.0, {"p": along((1.0, 6.0), (15.0, 6.0))})
    assert record.nearest_person("a") > CONTACT_M


def test_an_actor_goes_around_one_who_has_arrived_in_its_way() -> None:
    nav = navigator(open_space())
    nav.add_actor("stands", (8.0, 6.0), (8.0, 6.0), BODY)
    nav.add_actor("walks", (2.0, 6.0), (14.0, 6.0), BODY)
    record = run(nav, 16.0)
    nav.close()
    assert record.nearest_actors() >= 0.5
    assert record.arrival_s("walks") < straight_s((2.0, 6.0), (14.0, 6.0)) + 3.0


def test_without_anyone_it_walks_straight_and_on_time() -> None:
    record = one(open_space(), (2.0, 6.0), (14.0, 6.0), 14.0)
    assert record.sideways("a", 6.0) < 0.35
    assert record.arrival_s("a") < straight_s((2.0, 6.0), (14.0, 6.0)) + 1.5
    steps = np.hypot(*np.diff(record.positions["a"], axis=0).T)
    assert steps.sum() < 12.0 * 1.02
    assert steps.max() <= BODY.max_speed_mps * TICK_S + 1e-9
