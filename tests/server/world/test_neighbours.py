import numpy as np

from esplanade.server.world.neighbours import Neighbours
from esplanade.server.world.state import PERSON, State


def crowd(*places: tuple[float, float, float]) -> State:
    state = State(len(places) + 2)
    for place in places:
        state.add(PERSON, "p", place, 0, 0.25)
    return state


def test_nearest_are_in_order_and_padded_with_nobody() -> None:
    state = crowd((0.0, 0.0, 0), (3.0, 0.0, 0), (1.0, 0.0, 0))
    distances, found = Neighbours(state).nearest(np.array([0]), 4, 10.0)
    assert distances[0].tolist() == [0.0, 1.0, 3.0, np.inf]
    assert found[0].tolist() == [0, 2, 1, state.capacity]


def test_nobody_is_met_through_a_floor_and_who_is_on_this_one_is_seen_first() -> None:
    state = crowd((0.0, 0.0, 0.0), (0.0, 0.0, 3.0), (5.0, 0.0, 0.0), (1.0, 0.0, 1.0))
    neighbours = Neighbours(state)
    first, second = neighbours.within(np.array([0]), 5.0)
    assert sorted(zip(first.tolist(), second.tolist(), strict=True)) == [(0, 2), (0, 3)]
    assert neighbours.nearest(np.array([0]), 4, 100.0)[1][0].tolist() == [0, 3, 2, 1]


def test_pairs_within_reach_match_the_obvious_search() -> None:
    random = np.random.default_rng(3)
    state = crowd(*((float(x), float(y), 0) for x, y in random.uniform(0.0, 10.0, (60, 2))))
    state.remove(int(state.ids[7]))
    first, second = Neighbours(state).within(state.live(), 1.5)
    found = set(zip(first.tolist(), second.tolist(), strict=True))
    live = state.live().tolist()
    expected = {
        (a, b)
        for a in live
        for b in live
        if a != b and np.hypot(*(state.positions[a] - state.positions[b])) <= 1.5
    }
    assert found == expected
