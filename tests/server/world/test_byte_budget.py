"""Viewers get no more bytes than they may: the nearest first, and everyone in the end."""

import math
from collections import defaultdict

import numpy as np
import pytest

from esplanade.protocol.snapshot import RECORD, unpack_block
from esplanade.protocol.steps import STEP, step_records
from esplanade.server.world.audience import News
from esplanade.server.world.byte_budget import BURST_S, FAR_S, NEAR, STEPPING_S, byte_budget
from esplanade.server.world.compiled._interest_kernels import (
    NEVER,
    NOT_NEAR,
    RECORD_UNDER_WAY,
    STEP_UNDER_WAY,
    Views,
)
from esplanade.server.world.compiled._snapshot_kernels import Budget, Changes, choose
from esplanade.server.world.inputs import Steer
from tests.server.worlds import FIELD, TICK_S, Trial, block_of, rules, steps_of

FAR_TICKS = round(FAR_S / TICK_S)
STEPPING_TICKS = round(STEPPING_S / TICK_S)


def crowd(trial: Trial, count: int) -> list[int]:
    """The first stands in the middle, the others farther and farther away around it."""
    turns = 2.4 * np.arange(count)
    away_m = 0.8 * np.sqrt(np.arange(count))
    x, y = 100.0 + away_m * np.cos(turns), 100.0 + away_m * np.sin(turns)
    return trial.join(*zip(x.tolist(), y.tolist(), strict=True))


def walking(people: list[int], tick: int) -> list[Steer]:
    """Everyone but the first walks, in a circle."""
    if tick % 10:
        return []
    return [Steer(who, tick, who + 0.1 * tick, 1.2) for who in people[1:]]


def bytes_of(news: News, viewer: int) -> int:
    return len(block_of(news, viewer)) + len(steps_of(news, viewer))


def ids_of(news: News, viewer: int) -> list[int]:
    ids: list[int] = unpack_block(block_of(news, viewer))["id"].tolist()
    return ids


def steppers(news: News, viewer: int) -> list[int]:
    ids: list[int] = step_records(steps_of(news, viewer))["id"].tolist()
    return ids


@pytest.mark.parametrize("viewer_bytes", [4000, 12_000])
def test_a_crowd_costs_a_viewer_no_more_than_its_budget(viewer_bytes: int) -> None:
    trial = Trial(scene=FIELD, view_limit=100, steps_limit=60, viewer_bytes=viewer_bytes)
    people = crowd(trial, 60)
    sizes, told, feet = [], defaultdict(list), defaultdict(int)
    for tick in range(400):
        news = trial.tick(*walking(people, tick))
        sizes.append(bytes_of(news, people[0]))
        for who in ids_of(news, people[0]):
            told[who].append(tick)
        if tick >= 200:
            for who in steppers(news, people[0]):
                feet[who] += 1
    most = viewer_bytes * BURST_S
    for seconds in (1.0, 5.0):
        window = round(seconds / TICK_S)
        sums = np.convolve(sizes, np.ones(window), "valid")
        assert sums.max() <= seconds * viewer_bytes + most + STEP.itemsize + RECORD.itemsize
    assert sum(sizes[200:]) >= 0.7 * viewer_bytes * 200 * TICK_S, "the budget is used"
    assert set(told) == set(people)
    if viewer_bytes > 4000:
        for who in people[1:]:
            assert max(np.diff(told[who])) <= 2 * STEPPING_TICKS, "nobody is forgotten"
        away_m = {who: math.dist(trial.position(people[0]), trial.position(who)) for who in people}
        nearest = sorted(people[1:], key=lambda who: away_m[who])
        assert sum(feet[who] > 0 for who in nearest[:8]) >= 7
        assert len([who for who in people[1:] if feet[who] > 5]) < 40, "feet of all cost too much"


def test_comings_into_view_and_goings_out_of_it_are_charged() -> None:
    """In a stream of people who come by, a viewer is sent no more than where nobody does."""
    viewer_bytes, seconds = 4000, 20
    trial = Trial(scene=FIELD, view_limit=24, steps_limit=20, viewer_bytes=viewer_bytes)
    people = crowd(trial, 60)
    sizes, changes = [], 0
    for tick in range(round(seconds / TICK_S)):
        wishes = [
            Steer(who, tick, 2.1 * who + (math.pi if tick // 40 % 2 else 0.0), 2.4)
            for who in people[1:]
            if tick % 40 == 0
        ]
        news = trial.tick(*wishes)
        came, went = news.entered.get(people[0], []), news.left.get(people[0], [])
        changes += len(came) + len(went)
        sizes.append(bytes_of(news, people[0]) + sum(map(len, came)) + 3 * len(went))
    assert changes > 100
    settled = sizes[100:]
    assert sum(settled) <= 1.02 * viewer_bytes * len(settled) * TICK_S


def test_far_avatars_are_told_of_five_times_a_second_and_near_ones_always() -> None:
    trial = Trial(scene=FIELD, view_limit=100, steps_limit=0)
    people = crowd(trial, 30)
    told = np.zeros(30)
    for tick in range(100):
        news = trial.tick(*walking(people, tick))
        here = trial.position(people[0])
        by_distance = sorted(people, key=lambda who: math.dist(here, trial.position(who)))
        told += [who in ids_of(news, people[0]) for who in by_distance]
    assert told[0] == 100
    assert (told[1 : NEAR - 4] >= 85).all()
    assert told[NEAR + 8 :].mean() == pytest.approx(100 / FAR_TICKS, rel=0.3)


def test_who_wants_no_steps_gets_none_and_places_instead() -> None:
    trial = Trial(scene=FIELD)
    trial.audience.send_no_steps(1)
    ann, ben = trial.join((100.0, 100.0), (102.0, 100.0))
    assert ann == 1
    counts = {ann: [0, 0], ben: [0, 0]}
    for tick in range(60):
        news = trial.tick(*([Steer(ben, 1, 0.0, 0.8), Steer(ann, 1, 3.0, 0.8)] if not tick else []))
        for viewer, other in ((ann, ben), (ben, ann)):
            counts[viewer][0] += other in ids_of(news, viewer)
            counts[viewer][1] += len(steppers(news, viewer))
    assert counts[ann][1] == 0
    assert counts[ann][0] >= 55
    assert counts[ben][1] > 5
    assert counts[ben][0] <= 60 // STEPPING_TICKS + 4


def test_a_walker_whose_steps_are_known_is_told_of_seldom_and_at_once_when_it_halts() -> None:
    trial = Trial(scene=FIELD)
    ann, ben = trial.join((100.0, 100.0), (102.0, 100.0))
    trial.tick(Steer(ben, 1, 0.0, 1.0))
    told = [ben in ids_of(trial.tick(), ann) for _ in range(3 * STEPPING_TICKS)]
    assert 2 <= sum(told) <= 6
    assert not all(told[-2:])
    news = trial.tick(Steer(ben, 2, 0.0, 0.0))
    assert trial.speed(ben) == 0.0
    assert ben in ids_of(news, ann)


def is_due(views: Views, changes: Changes, budget: Budget, tick: int, v: int, c: int) -> bool:
    """Whether the record in column `c` is due."""
    row, sent = views.rows[v, c], int(views.record_sent[v, c])
    period = 0 if c < budget.near else budget.far_ticks
    if views.step_sent[v, c] >= changes.begun[row] > NEVER and tick <= changes.over[row]:
        period = budget.stepping_ticks
    if sent == NEVER or changes.urgent[row] > sent:
        period = 0
    return bool(changes.changed[row] > sent and tick - sent >= period)


def plain(
    views: Views, viewers: np.ndarray, changes: Changes, budget: Budget, tick: int
) -> list[tuple[int, int]]:
    """The obvious twin of `choose`, on lists of columns."""
    counts = []
    for v in viewers.tolist():
        own = int(views.avatar[v])
        columns = list(range(int(views.seen[v])))
        rows = {c: int(views.rows[v, c]) for c in columns}
        full = int(views.credit[v]) + budget.refill >= budget.most
        credit = min(int(views.credit[v]) + budget.refill, budget.most) - budget.snapshot_head
        records = [c for c in columns if rows[c] == own]
        credit -= budget.record * len(records)
        steps: list[int] = []
        short = False
        for c in columns:
            sent = int(views.step_sent[v, c])
            if sent == NOT_NEAR or changes.begun[rows[c]] <= sent:
                continue
            cost = budget.step + (0 if steps else budget.steps_head)
            if rows[c] == own or credit >= cost:
                steps.append(c)
                credit -= cost
            else:
                short = True
        near = [c for c in columns if c < budget.near]
        far = [c for c in columns if c >= budget.near]
        turn = int(views.turn[v])
        if turn in far:
            far = far[far.index(turn) :] + far[: far.index(turn)]
        next_turn = len(near)
        for c in near + far:
            if rows[c] == own or not is_due(views, changes, budget, tick, v, c):
                continue
            if credit < budget.record:
                short, next_turn = True, max(c, len(near))
                break
            records.append(c)
            credit -= budget.record
        views.under_way[v] = 0
        views.under_way[v, records] |= RECORD_UNDER_WAY
        views.under_way[v, steps] |= STEP_UNDER_WAY
        views.turn[v], views.credit[v], views.encoded[v] = next_turn, credit, tick
        calm, reach, most = views.calm[v] + 1, views.reach[v], views.most[v]
        if short and calm >= budget.settling_ticks:
            reach, calm = max(reach - max(1, reach // 8), min(1, most)), 0
        elif not short and full and calm >= budget.calm_ticks:
            reach, calm = min(reach + max(1, reach // 8), most), 0
        views.calm[v], views.reach[v] = calm, reach
        counts.append((len(records), len(steps)))
    return counts


def test_the_plain_twin_chooses_the_same() -> None:
    random = np.random.default_rng(5)
    budget = byte_budget(rules(viewer_bytes=12_000))
    many, columns, everyone, tick = 40, 60, 90, 1000

    def ticks(shape: int | tuple[int, int], least: int = 0) -> np.ndarray:
        return random.integers(tick - 30, tick + 1, shape, dtype=np.int32) * (
            random.random(shape) < 0.9
        ).astype(np.int32) + np.int32(least)

    changes = Changes(*(ticks(everyone) for _ in range(3)), over=ticks(everyone) + np.int32(10))
    rows = np.stack([random.permutation(everyone)[:columns] for _ in range(many)])
    step_sent = ticks((many, columns))
    step_sent[random.random((many, columns)) < 0.4] = NOT_NEAR
    views = Views(
        avatar=rows[:, 0].astype(np.int64),
        seen=random.integers(1, columns, many, dtype=np.int32),
        encoded=np.zeros(many, np.int32),
        written=np.zeros(many, np.int32),
        ack=np.zeros(many, np.int64),
        rows=rows.astype(np.int32),
        record_sent=ticks((many, columns)),
        step_sent=step_sent,
        under_way=np.zeros((many, columns), np.uint8),
        credit=random.integers(-300, budget.most, many, dtype=np.int32),
        reach=random.integers(0, 60, many, dtype=np.int32),
        most=np.full(many, 61, np.int32),
        calm=random.integers(0, 100, many, dtype=np.int32),
        turn=random.integers(0, columns, many, dtype=np.int32),
    )
    twin = Views(*(table.copy() for table in views))
    viewers = np.flatnonzero(random.random(many) < 0.9)
    counts = np.zeros((len(viewers), 2), np.int64)
    choose(views, viewers, changes, budget, tick, counts)
    assert plain(twin, viewers, changes, budget, tick) == list(map(tuple, counts.tolist()))
    for name, table in views._asdict().items():
        for v in viewers.tolist():
            seen = int(views.seen[v]) if table.ndim == 2 else None
            np.testing.assert_array_equal(
                np.atleast_1d(table[v])[:seen], np.atleast_1d(getattr(twin, name)[v])[:seen], name
            )
    assert 0 < np.count_nonzero(views.turn[viewers] > budget.near) < len(viewers)
