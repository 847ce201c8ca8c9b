"""The choice of episodes."""

import numpy as np
import pytest

from esplanade.evaluation.episodes import choose_episodes
from esplanade.evaluation.replay import Replay
from esplanade.recordings import Obstacles, Track
from tests.evaluation.worlds import RULES, busy_plaza, replay, walk

LONG = walk("1", 0.0, (0, 0), (10, 0))
LATER = walk("9", 30.0, (0, 50), (10, 50))
END = walk("99", 55.0, (0, 60), (0, 61))


def chosen(*tracks: Track, obstacles: Obstacles | None = None) -> list[tuple[str, bool]]:
    walked = replay(*tracks, END, obstacles=obstacles)
    episodes = choose_episodes(walked, RULES, 100, 0)
    return sorted((walked.ids[e.pedestrian], e.reverse) for e in episodes)


def test_a_trip_there_and_then_back() -> None:
    walked = replay(LONG, END)
    there, back = choose_episodes(walked, RULES, 100, 0)
    assert (there.start, there.first_tick) == ((0.0, 0.0), 0)
    assert back.start == there.goal
    assert (there.reverse, back.reverse) == (False, True)
    assert there.distance_m == pytest.approx(10.0, abs=0.5)


def test_the_number_of_forward_trips_decides_whether_any_go_back() -> None:
    walked = Replay(busy_plaza())
    forward = [e for e in choose_episodes(walked, RULES, 10_000, 0) if not e.reverse]
    assert len(forward) > 4
    few = choose_episodes(walked, RULES, len(forward), 0)
    assert not any(e.reverse for e in few)
    assert [e.number for e in few] == list(range(len(forward)))


def test_the_seed_decides_the_order() -> None:
    walked = Replay(busy_plaza())
    orders = [[e.pedestrian for e in choose_episodes(walked, RULES, 5, seed)] for seed in (0, 0, 1)]
    assert orders[0] == orders[1] != orders[2]


@pytest.mark.parametrize(
    "track",
    [
        walk("1", 0.0, (0, 0), (4.5, 0)),
        walk("1", 0.0, (0, 0), (10, 0), speed_mps=0.4),
        walk("1", 50.0, (0, 0), (10, 0)),
        walk("1", 0.0, (0, 0), (6, 0), (0.5, 0)),
    ],
    ids=["short", "slow", "cut off by the end", "comes back"],
)
def test_trips_that_say_little_are_left_out(track: Track) -> None:
    assert chosen(track, LATER) == [("9", False), ("9", True)]


def test_someone_too_near_to_the_start_rules_a_trip_out_in_that_direction() -> None:
    beside = walk("2", 0.0, (0.0, 0.7), (0.0, 0.75), speed_mps=0.02)
    assert chosen(LONG, beside) == [("1", True)]
    farther = walk("2", 0.0, (0.0, 0.9), (0.0, 0.95), speed_mps=0.02)
    assert ("1", False) in chosen(LONG, farther)


def test_an_end_within_a_wall_rules_both_directions_out() -> None:
    wall = Obstacles(segments=(((-1.0, 0.2), (1.0, 0.2)),))
    assert chosen(LONG, obstacles=wall) == []


def test_nobody_is_judged_in_an_empty_recording() -> None:
    still = Track("1", np.array([0.0]), np.zeros((1, 2)))
    assert choose_episodes(replay(still), RULES, 5, 0) == []
