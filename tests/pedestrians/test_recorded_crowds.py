"""Real crowds: undisturbed they are their recordings, and nobody is pushed through a wall."""

import numpy as np
import pytest

from esplanade.evaluation.people import crowd_of
from esplanade.evaluation.replay import Replay
from esplanade.recordings import read_crowd, read_obstacles
from tests.naive.geometry import segments_meet
from tests.recordings.data import recorded


def crosses(here: np.ndarray, there: np.ndarray, walls: np.ndarray) -> np.ndarray:
    """The walls (M, 4) that a step crosses, by the naive geometry of segments."""
    step = tuple(here), tuple(there)
    return np.array([segments_meet(*step, tuple(w[:2]), tuple(w[2:])) for w in walls], dtype=bool)


@pytest.fixture(scope="module", params=["hotel", "zara1"])
def replay(request: pytest.FixtureRequest) -> Replay:
    path = recorded(request.param)
    return Replay(read_crowd(path), read_obstacles(path.with_suffix(".walls.json")))


def test_an_undisturbed_crowd_is_its_recording(replay: Replay) -> None:
    walk = crowd_of(replay, 1.0, 0).begin(500)
    for _ in range(1000):
        walk.step()
        np.testing.assert_array_equal(walk.positions, walk.recorded)


def test_nobody_is_pushed_through_a_wall(replay: Replay) -> None:
    """Wide actors walk to and fro along the middle of the recording."""
    crowd = crowd_of(replay, 3.0, 0)
    walk = crowd.begin(500)
    x0, y0, x1, y1 = replay.bounds
    for tick in range(1000):
        before = dict(zip(walk.present.tolist(), walk.positions, strict=True))
        share = 0.5 + 0.5 * np.sin(0.02 * tick + np.arange(3))
        velocities = np.diff([share, 0.5 + 0.5 * np.sin(0.02 * (tick + 1) + np.arange(3))], axis=0)
        xs, ys = x0 + share * (x1 - x0), y0 + (y1 - y0) * np.array([0.3, 0.5, 0.7])
        vx = velocities[0] * (x1 - x0) / replay.tick_s
        walk.step(np.column_stack([xs, ys, vx, np.zeros(3), np.full(3, 0.6)]))
        for person, place in zip(walk.present.tolist(), walk.positions, strict=True):
            if person in before:
                met = crosses(before[person], place, crowd.walls)
                assert not (met & ~crowd.passes[person]).any()
    assert walk.displacement_m.sum() > 10.0
