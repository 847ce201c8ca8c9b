import numpy as np
import pytest

from esplanade.protocol.snapshot import positions_m, unpack_block
from esplanade.server.world.inputs import Attach, Join, Leave, Steer
from esplanade.server.world.interest import PERIOD_TICKS
from tests.server.worlds import FIELD, Trial, block_of, ids_in


def test_the_first_snapshot_holds_everyone_in_view() -> None:
    trial = Trial(scene=FIELD)
    update = trial.tick(Join(0, "Ann", (50.0, 50.0, 0)), Join(1, "Ben", (53.21, 50.0, 0)))
    (_, ann), (_, ben) = trial.joined
    records = unpack_block(block_of(update, ann))
    assert ids_in(records) == [ann, ben]
    places = dict(
        zip(
            records["id"].tolist(),
            positions_m(records, trial.world.origin_m).tolist(),
            strict=True,
        )
    )
    assert places[ben] == pytest.approx((53.21, 50.0))


def test_later_ones_hold_oneself_and_only_those_who_changed() -> None:
    trial = Trial(scene=FIELD)
    ann, ben, cem = trial.join((50.0, 50.0), (53.0, 50.0), (56.0, 50.0))
    assert ids_in(unpack_block(block_of(trial.tick(), ann))) == [ann]
    update = trial.tick(Steer(ben, 1, 0.0, 1.0))
    assert ids_in(unpack_block(block_of(update, ann))) == [ann, ben]
    assert ids_in(unpack_block(block_of(update, cem))) == [ben, cem]


def test_what_was_not_written_is_sent_with_the_next_one() -> None:
    trial = Trial(scene=FIELD)
    ann, ben = trial.join((50.0, 50.0), (53.0, 50.0))
    trial.tick(Steer(ben, 1, 0.0, 1.0), writing=False)
    trial.tick(Steer(ben, 2, 0.0, 0.0), writing=False)
    update = trial.tick()
    records = unpack_block(block_of(update, ann))
    assert ids_in(records) == [ann, ben]
    assert ids_in(unpack_block(block_of(trial.tick(), ann))) == [ann]


def test_acks_follow_the_movements_and_begin_anew_with_a_new_client() -> None:
    trial = Trial(scene=FIELD)
    (ann,) = trial.join((50.0, 50.0))
    update = trial.tick(Steer(ann, 41, 0.0, 1.0))
    assert update.snapshots.acks.tolist() == [41]
    update = trial.tick(Attach(ann))
    assert update.snapshots.acks.tolist() == [0]


def test_a_slot_used_again_is_new_to_everyone() -> None:
    trial = Trial(scene=FIELD)
    ann, ben = trial.join((50.0, 50.0), (53.0, 50.0))
    trial.ticks(2)
    update = trial.tick(Leave(ben), Join(9, "Cem", (53.0, 50.0, 0)))
    ((_, cem),) = trial.joined
    seen: set[int] = set()
    for _ in range(PERIOD_TICKS):
        seen |= set(ids_in(unpack_block(block_of(update, ann))))
        update = trial.tick()
    assert trial.world.state.slot(cem) == 1
    assert seen == {ann, cem}


def test_who_came_and_went_unsent_leaves_no_record_behind() -> None:
    trial = Trial(scene=FIELD)
    (ann,) = trial.join((50.0, 50.0))
    trial.ticks(2)
    trial.tick(Join(9, "Ben", (53.0, 50.0, 0)), writing=False)
    ((_, ben),) = trial.joined
    for _ in range(PERIOD_TICKS):
        if trial.audience.sees(ann, ben):
            break
        trial.tick(writing=False)
    assert trial.audience.sees(ann, ben)
    update = trial.tick(Leave(ben))
    assert ids_in(unpack_block(block_of(update, ann))) == [ann]


def test_snapshots_alone_rebuild_the_world_however_many_are_lost() -> None:
    random = np.random.default_rng(2)
    trial = Trial(scene=FIELD, view_radius_m=100.0)
    people = trial.join(*((float(x), float(y)) for x, y in random.uniform(90.0, 110.0, (20, 2))))
    known: dict[int, tuple[float, float]] = {}
    trial.tick(Attach(people[0]), writing=False)
    for tick in range(120):
        steering = [
            Steer(who, tick, float(random.uniform(0.0, 6.3)), float(random.integers(2)))
            for who in random.choice(people, 4).tolist()
        ]
        if tick >= 100:
            steering = [Steer(who, tick, 0.0, 0.0) for who in people]
        update = trial.tick(*steering, writing=False)
        if tick < 110 and random.uniform() < 0.7:
            continue
        records = unpack_block(block_of(update, people[0]))
        where = positions_m(records, trial.world.origin_m)
        known.update(zip(records["id"].tolist(), map(tuple, where.tolist()), strict=True))
        trial.audience.wrote(update.snapshots, list(range(len(people))))
    assert set(known) == set(people)
    for who in people:
        assert known[who] == pytest.approx(trial.position(who), abs=0.0051)
