"""Every rule of planning is noticed: a walk that goes well with it goes worse without it.

So a rule that nobody uses any more, or uses the wrong way, makes a test fail. What each rule is
worth among recorded people and at doorways is measured by `python -m benchmarks.ablations`.
"""

import numpy as np

from esplanade.actors import ActorParameters, Navigator, Reason
from esplanade.planning import PlanModel, RuleModel, Scene
from esplanade.planning.agents._reservation_kernels import conflict, crowding
from tests.actors.worlds import TICK_S, along, run
from tests.planning.worlds import open_grid, reserved

OFF = 1_000_000


def walked(ways, people=None, seconds=12.0, scene=None, tempers=None, **rules):
    """A run of some actors, each on its way, with some rules and tempers changed."""
    scene = scene or Scene.open_space((0.0, 0.0, 16.0, 12.0))
    plan = PlanModel(threads=1)
    nav = Navigator(scene, TICK_S, plan=plan, rules=RuleModel(**rules))
    for k, (start, goal) in enumerate(ways):
        nav.add_actor(f"a{k}", start, goal, ActorParameters(**(tempers or {})))
    record = run(nav, seconds, people)
    nav.close()
    return record


ACROSS = [((2.0, 6.0), (14.0, 6.0))]


def test_followed_paths_are_bent() -> None:
    """Where no other path is good enough to replace the followed one, only bends are left."""
    people = {"p": along((9.0, 6.1), (9.0, 6.1))}
    faithful = {"hysteresis_s": 5.0, "risk_weight": 4.0}
    bent = walked(ACROSS, people, tempers=faithful, checks_steps=False)
    straight = walked(ACROSS, people, tempers=faithful, checks_steps=False, perturbs=False)
    assert straight.nearest_person("a0") < 0.4
    assert bent.nearest_person("a0") > 0.7


def test_a_path_is_given_up_only_for_a_cheaper_one() -> None:
    people = {f"p{k}": along((14.0, 4.6 + k), (2.0, 4.6 + k), speed_mps=0.9) for k in range(4)}

    def changes(**rules) -> int:
        return walked(ACROSS, people, **rules).reasons["a0"].count(Reason.REPLANNING)

    assert 2 * changes() < changes(weighs_paths=False)


def test_a_path_is_given_up_only_for_one_that_is_cheaper_by_the_hysteresis() -> None:
    people = {f"p{k}": along((14.0, 4.6 + k), (2.0, 4.6 + k), speed_mps=0.9) for k in range(4)}

    def changes(hysteresis_s) -> int:
        record = walked(ACROSS, people, tempers={"hysteresis_s": hysteresis_s})
        return record.reasons["a0"].count(Reason.REPLANNING)

    assert changes(0.15) < changes(0.0)


def first_plan(people, **rules):
    nav = Navigator(
        Scene.open_space((0.0, 0.0, 16.0, 12.0)),
        TICK_S,
        plan=PlanModel(threads=1),
        rules=RuleModel(**rules),
    )
    nav.add_actor("a", *ACROSS[0], ActorParameters())
    for k in range(20):
        nav.observe({name: walk(k * TICK_S) for name, walk in people.items()})
        nav.place_actor("a", ACROSS[0][0], (1.3, 0.0))
        nav.set_back("a")
        state = nav.tick()["a"]
    circles = nav.predicted_near(state.position, 0.0, 20.0)
    nav.close()
    return state.path[:, :2], circles


def test_searches_remember_the_risk_that_was_taken() -> None:
    """The printed key goes straight past a person whose risk lies behind the next node."""
    people = {"p": along((5.0, 6.15), (5.0, 6.15))}
    ours, (circles,) = first_plan(people)
    printed, _ = first_plan(people, greedy=True)
    nearest = [np.hypot(*(path - circles[: len(path), :2]).T).min() for path in (ours, printed)]
    assert nearest[0] > nearest[1] + 0.1


def test_planned_paths_keep_clear_of_each_other() -> None:
    ways = [((3.0, 6.0), (13.0, 6.0)), ((8.0, 1.0), (8.0, 11.0))]

    def nearest_m(**rules) -> float:
        nav = Navigator(
            Scene.open_space((0.0, 0.0, 16.0, 12.0)),
            TICK_S,
            plan=PlanModel(threads=1),
            rules=RuleModel(**rules),
        )
        for k, (start, goal) in enumerate(ways):
            nav.add_actor(k, start, goal)
        found = []
        for _ in range(45):
            nav.observe({})
            states = nav.tick()
            found.append(np.hypot(*(states[0].path - states[1].path)[:, :2].T).min())
        nav.close()
        return min(found[6:])  # in the tick in which they first see each other both evade

    assert nearest_m() > 0.4
    assert nearest_m(reserves=False) < 0.3


def test_a_search_goes_on_from_a_path_that_somebody_has_crossed() -> None:
    """The way of one who walks straight on is crossed by those who go first, again and again."""
    ways = [((2.0, 6.0), (15.0, 6.0))]
    ways += [((4.0 + 1.25 * k, 1.0), (4.0 + 1.25 * k, 10.0 - 0.3 * k)) for k in range(8)]

    def expansions(**rules) -> int:
        nav = Navigator(
            Scene.open_space((0.0, 0.0, 16.0, 12.0)),
            TICK_S,
            plan=PlanModel(threads=1),
            rules=RuleModel(**rules),
        )
        for k, (start, goal) in enumerate(ways):
            nav.add_actor(k, start, goal, ActorParameters(catch_up=0.2))
        found = 0
        for _ in range(50):
            nav.observe({})
            nav.tick()
            found += int(nav._batch.zone.decisions.expansions[0])
        nav.close()
        return found

    assert expansions() < 0.6 * expansions(goes_on=False)


def test_far_ahead_there_are_fewer_moves() -> None:
    """Without anybody in the way the same path is found, among fewer nodes."""

    def made(**rules) -> int:
        nav = Navigator(
            Scene.open_space((0.0, 0.0, 16.0, 12.0)),
            TICK_S,
            plan=PlanModel(threads=1),
            rules=RuleModel(**rules),
        )
        nav.add_actor("a", *ACROSS[0])
        nav.tracing.wanted = True
        nav.observe({})
        nav.tick()
        tree = nav.trace("a").tree
        nav.close()
        return len(tree.nodes)

    assert made() < made(fine_steps=1000)


def sudden(**rules) -> float:
    """How near somebody comes who walks beside an actor and turns into its way."""
    person = along((2.0, 6.7), (5.0, 6.7), (5.3, 5.0), (5.3, 1.0), speed_mps=1.6)
    return walked(ACROSS, {"p": person}, 7.0, **rules).nearest_person("a0")


def test_steps_are_checked_once_more() -> None:
    assert sudden() > sudden(checks_steps=False) + 0.1


def test_a_turn_is_minded_at_once() -> None:
    assert sudden() > sudden(minds_turns=False) + 0.02


def test_who_is_in_the_way_steps_aside() -> None:
    """Two who stand face to face with no plan to pass: half steps and sidesteps get them going."""
    walls = [((0.0, 5.0), (16.0, 5.0)), ((0.0, 6.6), (16.0, 6.6))]
    scene = Scene.open_space((0.0, 0.0, 16.0, 12.0), walls=walls)
    ways = [((2.0, 5.8), (14.0, 5.8)), ((14.0, 5.8), (2.0, 5.8)), ((1.0, 5.8), (13.0, 5.8))]

    def last_s(**rules) -> float:
        record = walked(ways, None, 30.0, scene, **rules)
        return max(record.arrival_s(f"a{k}") for k in range(3))

    assert last_s() < last_s(sidesteps=False, reserves=False)


def crowds(tempers=None, ticks=2, **rules):
    """Two crowds before a doorway, and one who has just come through it from the west."""
    walls = [((8.0, 0.1), (8.0, 5.0)), ((8.0, 7.0), (8.0, 11.9))]
    nav = Navigator(
        Scene.open_space((0.0, 0.0, 16.0, 12.0), walls=walls),
        TICK_S,
        plan=PlanModel(threads=1),
        rules=RuleModel(**rules),
    )
    body = ActorParameters(**(tempers or {}))
    for k in range(9):
        x, y = 5.5 - 0.7 * (k // 3), 5.3 + 0.7 * (k % 3)
        nav.add_actor(f"west {k}", (x, y), (14.0, 6.0), body)
        nav.add_actor(f"east {k}", (16.0 - x, y), (2.0, 6.0), body)
    nav.add_actor("through", (7.5, 6.0), (15.0, 6.0), body)
    nav.add_actor("elsewhere", (13.0, 10.5), (14.5, 9.5), body)
    for k in range(ticks):
        nav.observe({})
        nav.tick()
        if k == 0:
            nav.place_actor("through", (9.0, 6.0))
    return nav


def order(**rules):
    """The ids of actors, first those who go first."""
    nav = crowds(**rules)
    ids = nav.table.ids
    found = [ids[row] for row in nav._batch.zone.order]
    contested = nav._batch.zone.world.reservations.contested.sum()
    nav.close()
    return found, contested


def test_who_has_come_through_goes_first_and_who_is_elsewhere_last() -> None:
    first, contested = order()
    assert contested >= 18
    assert first[0] == "through"
    assert first[-1] == "elsewhere"


def test_each_of_the_two_orders_lets_out_who_has_come_through() -> None:
    assert order(jam_actors=OFF)[0][0] == "through"
    assert order(orders_passages=False)[0][0] == "through"
    assert order(jam_actors=OFF, orders_passages=False)[0][0] == "elsewhere", "by distance alone"


def test_passages_are_contested_by_the_number_that_the_rule_says() -> None:
    assert order(contested_actors=OFF)[1] == 0


def test_crowds_keep_right() -> None:
    def aside_m(weight) -> float:
        nav = crowds({"keep_right_weight": weight}, 25)
        y = dict(zip(nav.table.ids, nav.table.agents.positions[:, 1].tolist(), strict=True))
        nav.close()
        return float(np.mean([y[f"east {k}"] - y[f"west {k}"] for k in range(9)]))

    assert aside_m(0.8) > aside_m(0.0) + 0.2


def face_to_face(**rules):
    """A waiting agent and one that comes, with a gap of 0.2 m, and what the second one pays."""
    paths = np.repeat(np.array([[(2.0, 2.0)], [(2.7, 2.0)]]), 4, axis=1)
    r = reserved(open_grid(8.0), paths, (0.25, 0.25), (1, 0))
    r = r._replace(rules=RuleModel(**rules).row)
    r.courses[:], r.held_up[:] = ((1.0, 0.0), (-1.0, 0.0)), True
    return r


def test_room_is_wanted_by_whoever_is_held_up() -> None:
    assert crowding(face_to_face(), 0, 1, 2, 2.0, 2.0) > 0.05
    assert crowding(face_to_face(meeting_weight=0.0), 0, 1, 2, 2.0, 2.0) == 0.0
    queue, none = face_to_face(), face_to_face(queue_weight=0.0)
    queue.courses[1] = none.courses[1] = (1.0, 0.0)
    assert crowding(queue, 0, 1, 2, 2.0, 2.0) > 0.05
    assert crowding(none, 0, 1, 2, 2.0, 2.0) == 0.0


def test_meetings_are_priced_or_forbidden_as_the_rules_say() -> None:
    toward = 2.0, 2.0, 2.4, 2.0
    assert conflict(face_to_face(), 1, 0.0, 0, 2.7, 2.0, 2.3, 2.0) == (False, 0.25)
    assert conflict(face_to_face(yielding_weight=0.0), 1, 0.0, 0, 2.7, 2.0, 2.3, 2.0)[1] == 0.0
    assert conflict(face_to_face(), 0, 0.0, 0, *toward)[0]
    assert not conflict(face_to_face(reserves=False), 0, 0.0, 0, *toward)[0]
    pressed = face_to_face()
    pressed.paths[1, 1:] = (2.2, 2.0)  # the other comes whether one stands or goes
    aside = (2.0, 2.0, 1.9, 2.1)
    assert not conflict(pressed, 0, 0.0, 0, *aside)[0]
    stubborn = pressed._replace(rules=RuleModel(evading_slices=0).row)
    assert conflict(stubborn, 0, 0.0, 0, *aside)[0]
