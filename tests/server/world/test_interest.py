import math

import numpy as np

from esplanade.server.world.inputs import Attach, Detach, Join, Leave, Say, Steer
from esplanade.server.world.interest import LEAVE_RATIO, PERIOD_TICKS
from tests.server.doubles import ScriptedPopulation
from tests.server.worlds import FIELD, TICK_S, Trial, entered_ids


def test_one_sees_oneself_and_those_within_the_radius() -> None:
    trial = Trial(scene=FIELD, view_radius_m=20.0)
    ann, ben, far = trial.join((50.0, 50.0), (65.0, 50.0), (90.0, 50.0))
    assert trial.audience.sees(ann, ann)
    assert trial.audience.sees(ann, ben)
    assert not trial.audience.sees(ann, far)
    assert set(trial.audience.seen_by(ben)) == {ann, ben}


def test_coming_and_going_is_told_once_with_hysteresis_between() -> None:
    population = ScriptedPopulation(TICK_S)
    population.put("oak", (75.0, 50.0), (-4.0, 0.0))
    trial = Trial(scene=FIELD, population=population, view_radius_m=20.0)
    (ann,) = trial.join((50.0, 50.0))
    entered, left = [], []
    for _ in range(100):
        news = trial.tick()
        if ann in news.entered:
            entered.append(population.positions["oak"][0] - 50.0)
        if ann in news.left:
            left.append(population.positions["oak"][0] - 50.0)
        if entered:
            population.velocities["oak"] = (4.0, 0.0)
    slack_m = 4.0 * TICK_S * PERIOD_TICKS
    assert len(entered) == len(left) == 1
    assert 20.0 - slack_m <= entered[0] <= 20.0
    assert 20.0 * LEAVE_RATIO <= left[0] <= 20.0 * LEAVE_RATIO + slack_m


def test_nobody_flickers_at_the_edge_of_sight() -> None:
    population = ScriptedPopulation(TICK_S)
    population.put("oak", (69.9, 50.0))
    trial = Trial(scene=FIELD, population=population, view_radius_m=20.0)
    (ann,) = trial.join((50.0, 50.0))
    changes = 0
    for k in range(80):
        population.velocities["oak"] = (4.0 if k % 2 else -4.0, 0.0)
        news = trial.tick()
        changes += len(news.entered.get(ann, [])) + len(news.left.get(ann, []))
    assert changes == 0
    assert trial.audience.sees(ann, trial.world.state.ids[1].item())


def test_the_nearest_are_seen_when_there_are_too_many() -> None:
    trial = Trial(scene=FIELD, view_limit=5)
    people = trial.join(*((50.0 + k, 50.0) for k in range(12)))
    seen = {who for who in people if trial.audience.sees(people[0], who)}
    assert seen == set(people[:6])


def test_oneself_is_seen_even_in_a_heap_of_people() -> None:
    trial = Trial(scene=FIELD, view_limit=3)
    people = trial.join(*[(50.0, 50.0)] * 20)
    assert all(trial.audience.sees(who, who) for who in people)
    views = [sum(trial.audience.sees(who, other) for other in people) for who in people]
    assert max(views) <= 4


def test_everyone_near_sees_a_newcomer_at_once() -> None:
    trial = Trial(scene=FIELD, view_radius_m=20.0)
    early = trial.join(*((50.0 + k, 50.0) for k in range(8)))
    trial.ticks(2)
    news = trial.tick(Join(0, "late", (60.0, 50.0, 0)), Join(1, "far", (90.0, 50.0, 0)))
    late, far = (avatar_id for _, avatar_id in trial.joined)
    assert all(entered_ids(news, who) == [late] for who in early)
    assert set(entered_ids(news, late)) == {*early, late}
    assert entered_ids(news, far) == [far]


def test_a_line_reaches_those_who_see_its_speaker_and_the_last_one_too() -> None:
    trial = Trial(scene=FIELD, view_radius_m=20.0)
    ann, ben, far = trial.join((50.0, 50.0), (52.0, 50.0), (90.0, 50.0))
    news = trial.tick(Say(far, "anybody?"), Say(ann, "here"), Say(ben, "bye"), Leave(ben))
    heard = [(one.line.text, one.name, one.viewers) for one in news.chat]
    assert heard[:2] == [("anybody?", "p2", [far]), ("here", "p0", [ann])]
    text, name, viewers = heard[2]
    assert (text, name, set(viewers)) == ("bye", "p1", {ann, ben})
    assert trial.tick(Say(ben, "I am gone")).chat == []


def test_who_leaves_the_world_leaves_every_view_at_once() -> None:
    trial = Trial(scene=FIELD)
    ann, ben = trial.join((50.0, 50.0), (52.0, 50.0))
    update = trial.tick(Leave(ben))
    assert update.left[ann] == [ben]
    assert not trial.audience.sees(ann, ben)
    assert ben not in update.left
    (cem,) = trial.join((52.0, 50.0))
    trial.ticks(PERIOD_TICKS)
    assert trial.audience.sees(ann, cem)


def test_who_looks_again_is_told_everything_again() -> None:
    trial = Trial(scene=FIELD)
    ann, ben = trial.join((50.0, 50.0), (52.0, 50.0))
    update = trial.tick(Detach(ann))
    assert ann not in update.snapshots.viewers
    assert not trial.audience.sees(ann, ben)
    update = trial.tick(Attach(ann))
    assert set(entered_ids(update, ann)) == {ann, ben}
    assert ann in update.snapshots.viewers


def test_events_rebuild_exactly_what_the_server_thinks_is_in_view() -> None:
    random = np.random.default_rng(8)
    trial = Trial(scene=FIELD, view_radius_m=15.0, view_limit=6)
    people = trial.join(*((float(x), float(y)) for x, y in random.uniform(80.0, 120.0, (40, 2))))
    told: dict[int, set[int]] = {who: set() for who in people}
    first = trial.tick(*(Attach(who) for who in people))
    for tick in range(200):
        steering = [
            Steer(who, tick, float(random.uniform(0.0, 2.0 * math.pi)), 3.0)
            for who in random.choice(people, 5).tolist()
        ]
        news = trial.tick(*steering) if tick else first
        for viewer, gone in news.left.items():
            assert told[viewer] >= set(gone)
            told[viewer] -= set(gone)
        for viewer in news.entered:
            assert not told[viewer] & set(entered_ids(news, viewer))
            told[viewer] |= set(entered_ids(news, viewer))
    for viewer in people:
        assert told[viewer] == {who for who in people if trial.audience.sees(viewer, who)}
        assert len(told[viewer]) <= 7
