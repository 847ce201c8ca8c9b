import numpy as np
import pytest

from esplanade.protocol.steps import new_step_records, step_records
from esplanade.server.world.audience import News
from esplanade.server.world.inputs import Attach, Detach, Leave
from esplanade.server.world.interest import LEAVE_RATIO, PERIOD_TICKS
from esplanade.server.world.walking import Feet
from tests.server.doubles import ScriptedPopulation
from tests.server.worlds import FIELD, TICK_S, Trial
from tests.server.worlds import steps_of as steps_block


@pytest.fixture(autouse=True)
def nobody_steps_unless_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Feet, "update", lambda _self, _tick: None)


def begin(trial: Trial, *avatar_ids: int, lift: int = 0) -> None:
    """These avatars begin a step in the tick that comes; tests know it by its `lift`."""
    world = trial.world
    slots = np.array([world.state.slot(avatar_id) for avatar_id in avatar_ids])
    records = new_step_records(len(slots))
    records["id"], records["tick"], records["lift"] = avatar_ids, world.tick + 1, lift
    world.steps.begin(slots, records, world.tick + 1)


def steps_of(news: News, viewer: int) -> dict[int, int]:
    """The steps that this viewer is to be sent: id of the walker -> lift."""
    records = step_records(steps_block(news, viewer))
    return dict(zip(records["id"].tolist(), records["lift"].tolist(), strict=True))


def test_a_step_is_told_once_to_those_who_are_near() -> None:
    trial = Trial(scene=FIELD, steps_radius_m=10.0)
    ann, ben, far = trial.join((50.0, 50.0), (58.0, 50.0), (65.0, 50.0))
    begin(trial, ann, ben, far, lift=3)
    update = trial.tick()
    assert steps_of(update, ann) == {ann: 3, ben: 3}
    assert steps_of(update, far) == {ben: 3, far: 3}
    assert trial.audience.sees(ann, far)
    assert steps_of(trial.tick(), ann) == {}
    begin(trial, ben, lift=4)
    assert steps_of(trial.tick(), ann) == {ben: 4}


def test_who_has_never_stepped_is_in_no_block() -> None:
    trial = Trial(scene=FIELD)
    (ann,) = trial.join((50.0, 50.0))
    assert steps_of(trial.tick(writing=False), ann) == {}


def test_a_walker_who_comes_near_brings_the_latest_step() -> None:
    population = ScriptedPopulation(TICK_S)
    population.put("oak", (63.0, 50.0), (-2.0, 0.0))
    trial = Trial(scene=FIELD, population=population, steps_radius_m=10.0)
    (ann,) = trial.join((50.0, 50.0))
    oak = next(i for i in range(1, 3) if trial.world.is_actor(i))
    begin(trial, oak, lift=7)
    came = [
        population.positions["oak"][0] - 50.0
        for _ in range(60)
        if oak in steps_of(trial.tick(), ann)
    ]
    assert len(came) == 1
    assert 10.0 - 2.0 * TICK_S * PERIOD_TICKS <= came[0] <= 10.0


def test_nobody_comes_near_twice_at_the_edge() -> None:
    population = ScriptedPopulation(TICK_S)
    population.put("oak", (59.9, 50.0))
    trial = Trial(scene=FIELD, population=population, steps_radius_m=10.0)
    (ann,) = trial.join((50.0, 50.0))
    oak = next(i for i in range(1, 3) if trial.world.is_actor(i))
    begin(trial, oak)
    trial.ticks(PERIOD_TICKS + 1)
    for k in range(40):
        population.velocities["oak"] = (4.0 if k % 2 else -4.0, 0.0)
        assert steps_of(trial.tick(), ann) == {}
    population.velocities["oak"] = (4.0, 0.0)
    while population.positions["oak"][0] < 50.0 + 10.0 * LEAVE_RATIO + 1.0:
        trial.tick()
    begin(trial, oak)
    assert steps_of(trial.tick(), ann) == {}


def test_the_nearest_are_shown_when_there_are_too_many() -> None:
    trial = Trial(scene=FIELD, steps_radius_m=15.0, steps_limit=3)
    everyone = trial.join(*((50.0 + k, 50.0) for k in range(10)))
    trial.ticks(PERIOD_TICKS)
    begin(trial, *everyone)
    assert sorted(steps_of(trial.tick(), everyone[0])) == everyone[:4]
    assert trial.audience.walkers_shown == 40


def test_at_the_limit_the_near_ones_stay_until_they_fall_well_behind() -> None:
    """Of eight places the last one is kept free for those who are there already."""
    population = ScriptedPopulation(TICK_S)
    population.put("oak", (59.0, 50.0))
    trial = Trial(scene=FIELD, population=population, steps_radius_m=15.0, steps_limit=8)
    everyone = trial.join(*((50.0 + k, 50.0) for k in range(8)))
    trial.ticks(PERIOD_TICKS)
    oak = next(i for i in range(1, 10) if trial.world.is_actor(i))
    begin(trial, oak)
    assert oak not in steps_of(trial.tick(), everyone[0])
    population.put("oak", (51.5, 50.0))
    trial.ticks(PERIOD_TICKS)
    population.put("oak", (58.0, 50.0))
    trial.ticks(PERIOD_TICKS)
    begin(trial, oak)
    assert oak in steps_of(trial.tick(), everyone[0])


def test_with_a_limit_of_none_one_sees_oneself_step() -> None:
    trial = Trial(scene=FIELD, steps_limit=0)
    ann, ben = trial.join((50.0, 50.0), (51.0, 50.0))
    begin(trial, ann, ben)
    assert steps_of(trial.tick(), ann) == {ann: 0}


def test_oneself_is_shown_in_the_thick_of_a_crowd_on_one_spot() -> None:
    trial = Trial(scene=FIELD, steps_limit=2, view_limit=4)
    everyone = trial.join(*[(50.0, 50.0)] * 8)
    slots = [trial.world.state.slot(avatar_id) for avatar_id in everyone]
    trial.world.state.positions[slots] = (50.0, 50.0)
    trial.ticks(PERIOD_TICKS)
    begin(trial, *everyone)
    update = trial.tick()
    assert all(avatar_id in steps_of(update, avatar_id) for avatar_id in everyone)


def test_steps_that_were_left_out_come_with_the_next_ones_the_latest_of_each() -> None:
    trial = Trial(scene=FIELD)
    ann, ben, cy = trial.join((50.0, 50.0), (52.0, 50.0), (54.0, 50.0))
    begin(trial, ben, lift=1)
    assert steps_of(trial.tick(writing=False), ann) == {ben: 1}
    begin(trial, ben, lift=2)
    trial.tick(writing=False)
    begin(trial, cy, lift=3)
    assert steps_of(trial.tick(), ann) == {ben: 2, cy: 3}
    assert steps_of(trial.tick(), ann) == {}


def test_who_comes_back_is_told_everything_anew() -> None:
    trial = Trial(scene=FIELD)
    ann, ben = trial.join((50.0, 50.0), (52.0, 50.0))
    begin(trial, ann, ben)
    trial.tick()
    trial.tick(Detach(ann))
    assert trial.audience.walkers_shown == 2
    assert steps_of(trial.tick(Attach(ann)), ann) == {ann: 0, ben: 0}


def test_who_takes_the_place_of_somebody_gone_does_not_step_as_they_did() -> None:
    trial = Trial(scene=FIELD, max_people=2)
    ann, ben = trial.join((50.0, 50.0), (52.0, 50.0))
    begin(trial, ben)
    trial.tick(Leave(ben))
    assert trial.audience.walkers_shown == 1
    (cy,) = trial.join((52.0, 50.0))
    begin(trial, cy, lift=5)
    update = trial.tick()
    trial.ticks(PERIOD_TICKS)
    assert ben not in steps_of(update, ann)
    begin(trial, cy, lift=6)
    assert steps_of(trial.tick(), ann) == {cy: 6}


def test_floors_above_and_below_count_as_further_away() -> None:
    trial = Trial(scene=FIELD, steps_radius_m=10.0)
    ann, ben = trial.join((50.0, 50.0), (52.0, 50.0))
    trial.world.state.heights[trial.world.state.slot(ben)] = 5.0
    trial.ticks(PERIOD_TICKS)
    begin(trial, ben)
    assert steps_of(trial.tick(), ann) == {}
