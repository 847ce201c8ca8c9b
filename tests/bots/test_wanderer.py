"""Wanderers: the same for the same seed, within the rules of the world."""

from itertools import islice

from hypothesis import given
from hypothesis import strategies as st

from esplanade.bots.wanderer import wander
from esplanade.protocol.messages import Move, WalkTo

BOUNDS = (-10.0, -5.0, 20.0, 5.0)


def test_the_same_seed_walks_the_same_way() -> None:
    again = [list(islice(wander(3, 7, BOUNDS, 2.0), 100)) for _ in range(2)]
    assert again[0] == again[1]


def test_other_visitors_and_other_seeds_walk_otherwise() -> None:
    ways = [list(islice(wander(*who, BOUNDS, 2.0), 5)) for who in ((3, 7), (3, 8), (4, 7))]
    assert ways[0] != ways[1]
    assert ways[0] != ways[2]


@given(st.integers(0, 2**32 - 1), st.integers(0, 10_000), st.floats(0.3, 3.0))
def test_they_stay_in_bounds_and_below_the_limit(seed: int, index: int, limit: float) -> None:
    acts = list(islice(wander(seed, index, BOUNDS, limit, (0.0, 3.5)), 60))
    for number, act in enumerate(acts, start=1):
        assert act.message.seq == number
        assert 0.3 <= act.pause_s <= 12.0
        if isinstance(act.message, WalkTo):
            assert -10.0 <= act.message.x <= 20.0
            assert -5.0 <= act.message.y <= 5.0
            assert act.message.z in {0.0, 3.5}
        else:
            assert act.message.speed <= limit
            assert -3.2 < act.message.direction < 3.2
    assert {type(act.message) for act in acts} == {Move, WalkTo}
