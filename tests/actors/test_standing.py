"""The memory of standing bodies fades once their place has cleared."""

import numpy as np
import pytest

from esplanade.actors.standing import LONGEST_FADE_S, StandingPeople, stand_on

TICK_S = 0.1


def stood(places, anchors, seconds, ticks: int = 1):
    """Account kept of one body for some ticks at one place."""
    at, anchor, s = np.array([places], float), np.array([anchors], float), np.array([seconds])
    for _ in range(ticks):
        stand_on(at, anchor, s, TICK_S)
    return anchor[0].tolist(), float(s[0])


def test_whoever_sways_goes_on_standing_where_it_stood() -> None:
    anchor, seconds = stood((1.2, 0.9, 0.0), (1.0, 1.0, 0.0), 5.0, ticks=10)
    assert anchor == [1.0, 1.0, 0.0]
    assert seconds == pytest.approx(6.0)


def test_a_place_that_has_cleared_fades_and_is_forgotten() -> None:
    anchor, seconds = stood((3.0, 1.0, 0.0), (1.0, 1.0, 0.0), 50.0)
    assert anchor == [1.0, 1.0, 0.0]
    assert 0.0 < seconds < LONGEST_FADE_S
    anchor, seconds = stood((3.0, 1.0, 0.0), (1.0, 1.0, 0.0), 50.0, ticks=15)
    assert anchor == [3.0, 1.0, 0.0]
    assert seconds <= TICK_S


def test_whoever_has_gone_upstairs_stands_no_longer_below() -> None:
    _, seconds = stood((1.0, 1.0, 3.0), (1.0, 1.0, 0.0), 0.1)
    assert seconds == 0.0


def test_people_keep_their_account_when_others_come_and_leave() -> None:
    standing = StandingPeople()
    places = np.zeros((2, 3))
    for _ in range(10):
        standing.observe(["a", "b"], places, 0, TICK_S)
    standing.observe(["b", "c"], places, 1, TICK_S)
    assert standing.stood_s == pytest.approx([1.1, 0.1])


def test_what_was_saved_is_remembered_when_people_are_seen_again() -> None:
    standing, again = StandingPeople(), StandingPeople()
    for _ in range(10):
        standing.observe([4, 7], np.ones((2, 3)), 0, TICK_S)
    again.load(standing.save())
    again.observe([7], np.ones((1, 3)), 0, TICK_S)
    assert again.stood_s == pytest.approx([1.1])
    with pytest.raises(ValueError, match="stands is none"):
        again.load([[7, float("nan"), 0.0, 0.0, 1.0]])
