"""The cost of steps, from the frames that a client is sent."""

from dataclasses import replace

import numpy as np
import pytest

from esplanade.bots.tally import Tally
from esplanade.bots.walkers import MAX_REMEMBERED, Walkers
from esplanade.protocol import encode_steps
from esplanade.protocol.steps import STEP, pack_steps
from tests.protocol.steps import made_up_steps


def frame(tick: int, *ids: int) -> bytes:
    """These avatars begin a step in that tick."""
    steps = replace(made_up_steps(len(ids)), ids=np.array(ids), begin_ticks=np.full(len(ids), tick))
    return encode_steps(tick, pack_steps(steps).tobytes())


def test_bytes_and_steps_are_those_of_the_frames() -> None:
    tally = Tally()
    walkers = Walkers(tally, tick_rate=20)
    frames = [frame(100, 1, 2), frame(110, 1)]
    for one in frames:
        walkers.take(one)
    assert tally.steps == 3
    assert tally.step_bytes == sum(map(len, frames)) == 3 * STEP.itemsize + 20


def test_who_walks_counts_from_step_to_step_and_who_stands_does_not() -> None:
    tally = Tally()
    walkers = Walkers(tally, tick_rate=20)
    for tick in (100, 110, 122, 400, 410):
        walkers.take(frame(tick, 1))
    walkers.take(frame(105, 2))
    assert tally.walker_seconds == pytest.approx((10 + 12 + 10) / 20)


def test_a_step_that_comes_twice_adds_no_time() -> None:
    tally = Tally()
    walkers = Walkers(tally, tick_rate=20)
    walkers.take(frame(100, 1))
    walkers.take(frame(100, 1))
    assert tally.walker_seconds == 0.0


def test_only_so_many_are_remembered() -> None:
    tally = Tally()
    walkers = Walkers(tally, tick_rate=20)
    walkers.take(frame(100, 1))
    for first in range(2, 2 + MAX_REMEMBERED, 128):
        walkers.take(frame(101, *range(first, first + 128)))
    walkers.take(frame(110, 1))
    assert tally.walker_seconds == 0.0
