"""Contacts are found between ticks, and active ones are counted separately."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.evaluation.contacts import ContactMonitor, closest_approach
from esplanade.evaluation.policies.policy import Person
from esplanade.evaluation.replay import Replay
from tests.evaluation.worlds import RULES, Point, replay, walk

number = st.floats(-3.0, 3.0)


@given(number, number, number, number)
def test_closest_approach_is_that_of_a_dense_sampling(
    ox: float, oy: float, dx: float, dy: float
) -> None:
    offset, change = np.array([ox, oy]), np.array([dx, dy])
    naive = np.hypot(*(offset + np.linspace(0, 1, 401)[:, None] * change).T).min()
    assert closest_approach(offset, change) == pytest.approx(naive, abs=0.02)
    assert closest_approach(offset, change) <= naive + 2e-6  # tiny changes are neglected


def meet(walked: Replay, tick: int, old: Point, new: Point) -> ContactMonitor:
    contacts = ContactMonitor(walked, RULES)
    here, there = np.array(old), np.array(new)
    people = [Person(int(j), walked.past(int(j), tick, 32)) for j in walked.present(tick)]
    contacts.step(tick, people, here, (there - here) / RULES.tick_s, there)
    return contacts


def test_passing_through_within_one_tick_is_a_contact() -> None:
    fast = replay(walk("1", 0.0, (0, 0), (100, 0), speed_mps=12.0))
    contacts = meet(fast, 10, (12.6, 0.45), (12.6, 0.45))
    assert contacts.touched == {0}
    assert contacts.clearance_m == pytest.approx(0.45 - 0.5)
    assert contacts.near_s == pytest.approx(RULES.tick_s)


def test_standing_still_is_touched_but_not_to_blame() -> None:
    walked = replay(walk("1", 0.0, (0, 0), (12, 0)))
    assert meet(walked, 10, (1.75, 0.0), (1.75, 0.0)).active == 0
    assert meet(walked, 10, (1.75, 0.0), (1.65, 0.0)).active == 1
    assert meet(walked, 10, (1.75, 0.0), (1.742, 0.0)).active == 0


def test_a_touch_counts_once_for_each_person() -> None:
    walked = replay(walk("1", 0.0, (0, 0), (12, 0)), walk("2", 0.0, (0, 0.1), (12, 0.1)))
    contacts = ContactMonitor(walked, RULES)
    for tick in (10, 11):
        people = [Person(j, walked.past(j, tick, 32)) for j in (0, 1)]
        spot = np.array([1.5, 0.0])
        contacts.step(tick, people, spot, np.zeros(2), spot)
    assert contacts.touched == {0, 1}
    assert contacts.near_s == pytest.approx(0.2)


def test_people_who_leave_in_this_tick_cannot_be_touched() -> None:
    walked = replay(walk("1", 0.0, (0, 0), (1.2, 0)))
    last = int(walked.last[0])
    contacts = meet(walked, last, (1.2, 0.0), (1.2, 0.0))
    assert not contacts.touched
    assert contacts.clearance_m == RULES.clearance_cap_m
