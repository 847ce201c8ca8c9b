"""When ticks were: at any pace, and over pauses."""

from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from esplanade.server.live.moments import TOLERANCE_US, Moments

SECOND_US = 1_000_000


def taken(moments: list[tuple[int, int]]) -> Moments:
    made = Moments()
    for tick, at_us in moments:
        made.take(tick, at_us)
    return made


def test_a_pause_is_no_time_of_the_world() -> None:
    before = [(k, k * 50_000) for k in range(1, 401)]
    after = [(400 + k, 620 * SECOND_US + k * 50_000) for k in range(1, 201)]
    moments = taken([*before, *after])
    assert moments.tick_at(10 * SECOND_US) == 200
    assert moments.tick_at(300 * SECOND_US) == 400
    assert moments.tick_at(625 * SECOND_US) == 500
    assert moments.tick_at(0) == 1
    assert moments.tick_at(900 * SECOND_US) == 600
    assert moments.told(0) == [before[0], before[-1], after[0], after[-1]]
    assert moments.told(450) == [after[0], after[-1]]


def test_at_an_even_pace_few_corners_are_kept() -> None:
    noise = np.random.default_rng(3).uniform(0, 40_000, 12_000)
    found = taken([(k, round(k * 12_500 + each)) for k, each in enumerate(noise, 1)]).told(0)
    assert len(found) <= 3
    assert (Moments().told(0), Moments().tick_at(5)) == ([], 0)


def test_after_a_jump_back_of_ticks_the_line_begins_anew() -> None:
    assert taken([(1, 0), (2, 50_000), (1, 90_000), (2, 140_000)]).told(0) == [
        (1, 90_000),
        (2, 140_000),
    ]


@given(st.lists(st.tuples(st.integers(1, 30), st.integers(-1000, 40 * SECOND_US)), min_size=1))
def test_every_tick_is_near_the_line(steps: list[tuple[int, int]]) -> None:
    moments, tick, at_us = [], 0, 0
    for ticks, us in steps:
        tick, at_us = tick + ticks, at_us + us
        moments.append((tick, at_us))
    line = taken(moments).told(0)
    assert all(a[0] < b[0] and a[1] <= b[1] for a, b in pairwise(line))
    latest_us = moments[0][1]
    for tick, at_us in moments:
        latest_us = max(latest_us, at_us)
        found_us = np.interp(tick, *zip(*line, strict=True))
        assert abs(found_us - latest_us) <= 2 * TOLERANCE_US + 1
