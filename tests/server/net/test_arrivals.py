"""Places that are kept for people of other zones."""

from typing import Any, cast

from esplanade.protocol.looks import Look
from esplanade.server.net.arrivals import Arrival, Arrivals
from esplanade.server.net.newcomers import MAX_JOINS_PER_TICK


def arrival(number: int, until_s: float = 5.0) -> Arrival:
    return Arrival(
        session=cast(Any, None),
        id=100 + number,
        name=f"p{number}",
        at=(1.0, 2.0, 0.0),
        zone="hall",
        look=Look(shirt=number % 12),
        portal="door",
        until_s=until_s,
        release=lambda: None,
        fail=lambda why: None,
    )


def test_a_crowd_comes_in_over_some_ticks_and_each_of_them_once() -> None:
    arrivals = Arrivals()
    for ticket in range(MAX_JOINS_PER_TICK + 4):
        arrivals.expect(ticket, arrival(ticket))
    first, second, third = (arrivals.joins() for _ in range(3))
    assert [join.ticket for join in (*first, *second)] == list(range(MAX_JOINS_PER_TICK + 4))
    assert (len(first), len(second), third) == (MAX_JOINS_PER_TICK, 4, [])
    assert (first[0].id, first[0].at, first[0].anywhere) == (100, (1.0, 2.0, 0.0), True)
    assert [join.look.shirt for join in first[:3]] == [0, 1, 2]


def test_a_place_is_kept_for_a_time_and_given_once() -> None:
    arrivals = Arrivals()
    early, late = arrival(1, until_s=2.0), arrival(2, until_s=9.0)
    arrivals.expect(1, early)
    arrivals.expect(2, late)
    assert arrivals.end_waiting(1.9) == []
    assert arrivals.end_waiting(2.0) == [early]
    # Whoever was not asked for in time is not asked for any more.
    assert [join.ticket for join in arrivals.joins()] == [2]
    assert arrivals.take(1) is None
    assert arrivals.take(2) is late
    assert arrivals.take(2) is None
    assert len(arrivals) == 0
