"""The benchmark of doorways: its rooms are what they say, and a plugged doorway costs little."""

import numpy as np
import pytest
from benchmarks import doorways

from tests.planning.worlds import scaled


def test_people_stand_apart_in_and_about_the_doorway() -> None:
    for seed in range(20):
        spots = np.array(doorways.standing(1.2, 5, np.random.default_rng(seed)))
        away = np.hypot(*(spots[:, None] - spots[None]).transpose(2, 0, 1))
        assert away[~np.eye(len(spots), dtype=bool)].min(initial=1.0) >= 0.5
        assert np.abs(spots[:, 0] - doorways.WALL_M).max() <= 0.9


def test_walling_up_leaves_the_further_doorway_alone() -> None:
    both, one = (doorways.rooms(1.2, 8.0, walled_up=up) for up in (False, True))
    assert (len(both.walls), len(one.walls)) == (3, 2)
    assert one.walls[0].end == both.walls[1].end


@pytest.mark.parametrize("people", [1, scaled(5, 1)])
def test_a_plugged_doorway_costs_no_more_than_the_goal(people: int) -> None:
    lost_s = [doorways.trial(1.2, 4.0, people, seed).lost_s for seed in range(scaled(3, 1))]
    assert max(lost_s) <= doorways.WORST_S
    assert float(np.median(lost_s)) <= doorways.MEDIAN_S
