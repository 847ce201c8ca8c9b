"""Gymnasium's and PettingZoo's environments: their own checkers, seeds, trips and their ends."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from esplanade.evaluation.policies import make_policy
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.simulation import run_episode
from esplanade.evaluation.trials import Source
from esplanade.recordings import Crowd, Track
from tests.evaluation.worlds import busy_plaza, walk, write_csv

gymnasium = pytest.importorskip("gymnasium")
pytest.importorskip("pettingzoo")

from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import SyncVectorEnv  # noqa: E402
from pettingzoo.test import parallel_api_test, parallel_seed_test  # noqa: E402

from esplanade.evaluation.episodes import choose_episodes  # noqa: E402
from esplanade.evaluation.learning import trips  # noqa: E402
from esplanade.evaluation.learning.crowds import CrowdEnv  # noqa: E402
from esplanade.evaluation.learning.trips import TripEnv  # noqa: E402

STRAIGHT = np.array([1.3 / Rules().max_speed_mps, 0.0], dtype=np.float32)
PEOPLE = pytest.mark.parametrize("people", ["recorded", "reacting"])


@pytest.fixture
def plaza(tmp_path: Path) -> Path:
    return write_csv(tmp_path, busy_plaza())


def walked(env: Any, action: Any = STRAIGHT, **options: Any) -> tuple[float, str, int]:
    """A trip by one action: its rewards, how it ends, and its ticks."""
    env.reset(seed=0, options=options)
    total = 0.0
    for tick in range(1, 602):
        _, reward, terminated, truncated, info = env.step(np.asarray(action, dtype=np.float32))
        total += reward
        if terminated or truncated:
            return total, info["outcome"], tick
    raise AssertionError("the trip does not end")


def lanes(folder: Path, *tracks: Track) -> Path:
    """Tracks in a recording that goes on for a minute, as somebody walks far away."""
    far = walk("9", 0.0, (-50.0, 50.0), (-50.0, 122.0))
    return write_csv(folder, Crowd("lanes", (*tracks, far)))


def walled(recording: Path, *walls: tuple[float, float, float, float]) -> Path:
    """The recording, with walls from x, y to x, y beside it."""
    told = {"segments": [list(wall) for wall in walls]}
    recording.with_suffix(".walls.json").write_text(json.dumps(told))
    return recording


@PEOPLE
def test_gymnasium_finds_no_fault(plaza: Path, people: str) -> None:
    made = gymnasium.make(f"{trips.__name__}:{trips.ID}", recording=plaza, people=people)
    check_env(made.unwrapped)


@PEOPLE
def test_pettingzoo_finds_no_fault(plaza: Path, people: Any) -> None:
    parallel_api_test(CrowdEnv(plaza, 3, people), num_cycles=700)
    parallel_seed_test(lambda: CrowdEnv(plaza, 3, people), num_cycles=50)


def test_random_actions_raise_nothing(plaza: Path) -> None:
    env = TripEnv(plaza, "reacting")
    env.action_space.seed(1)
    env.reset(seed=1)
    ends: dict[str, int] = {}
    for _ in range(10_000):
        seen, reward, terminated, truncated, info = env.step(env.action_space.sample())
        assert env.observation_space.contains(seen)
        assert np.isfinite(reward)
        if terminated or truncated:
            ends[info["outcome"]] = ends.get(info["outcome"], 0) + 1
            env.reset()
    assert ends


def test_the_same_trip_as_in_an_evaluation(tmp_path: Path) -> None:
    source = lanes(tmp_path, walk("1", 0.0, (0.0, 0.0), (9.0, 3.0)))
    env = TripEnv(source)
    environment = Source(source).environment(Rules().tick_s)
    for number, episode in enumerate(choose_episodes(environment.replay, Rules(), 9, 0)):
        policy = make_policy("straight")
        expected = run_episode(environment, episode, policy, Rules())
        total, outcome, ticks = walked(env, trip=number)
        assert outcome == "reached"
        assert abs(ticks - (len(expected.trajectory) - 1)) <= 1
        assert total == pytest.approx(episode.distance_m - 0.3 * ticks * 0.1 + 5.0, abs=0.5)


def test_a_contact_ends_a_trip_and_costs(tmp_path: Path) -> None:
    east, west = walk("1", 0.0, (0.0, 0.0), (12.0, 0.0)), walk("2", 0.0, (12.0, 0.0), (0.0, 0.0))
    env = TripEnv(lanes(tmp_path, east, west))
    total, outcome, ticks = walked(env, trip=0)
    assert outcome == "touched"
    assert ticks < 60
    assert total < 0.0
    total, outcome, _ = walked(env, np.zeros(2), trip=0)  # the other walks into it
    assert outcome == "touched"


def test_a_robot_that_stands_is_late(tmp_path: Path) -> None:
    east, west = walk("1", 0.0, (0.0, 0.0), (12.0, 0.0)), walk("2", 0.0, (12.0, 9.0), (0.0, 9.0))
    assert walked(TripEnv(lanes(tmp_path, east, west)), np.zeros(2), trip=0)[1:] == ("late", 600)


def test_a_wall_ends_a_trip(tmp_path: Path) -> None:
    east = walk("1", 0.0, (0.0, 0.0), (9.0, 0.0))
    stands = walk("2", 0.0, (-2.0, -2.0), (-2.0, -1.0), speed_mps=0.02)
    recording = write_csv(tmp_path, Crowd("lane", (east, stands)))
    env = TripEnv(walled(recording, (-2.0, 0.7, 11.0, 0.7)))
    assert walked(env, trip=0)[1] == "reached"
    total, outcome, ticks = min(
        (walked(env, (0.5, side), trip=0) for side in (-0.8, 0.8)), key=lambda trip: trip[2]
    )
    assert outcome == "wall"
    assert ticks < 20
    assert total < 0.0


def test_several_environments_walk_as_one(plaza: Path) -> None:
    many = SyncVectorEnv([lambda: TripEnv(plaza)] * 3)
    seen, _ = many.reset(seed=[4, 5, 4])
    assert np.array_equal(seen[0], seen[2])
    assert not np.array_equal(seen[0], seen[1])
    seen, rewards, *_ = many.step(np.repeat(STRAIGHT[None], 3, axis=0))
    assert seen.shape == (3, *many.single_observation_space.shape)
    assert rewards[0] == rewards[2]


def test_robots_see_and_touch_each_other(tmp_path: Path) -> None:
    east, west = walk("1", 0.0, (0.0, 0.0), (12.0, 0.0)), walk("2", 0.0, (12.0, 0.0), (0.0, 0.0))
    env = CrowdEnv(lanes(tmp_path, east, west), 3)
    env.reset(seed=0)
    last: dict[str, tuple[str, Any]] = {}
    while env.agents:
        seen, _, _, _, infos = env.step(dict.fromkeys(env.agents, STRAIGHT))
        last |= {agent: (info["outcome"], seen[agent]) for agent, info in infos.items() if info}
    assert sorted(outcome for outcome, _ in last.values()) == ["reached", "touched", "touched"]
    for outcome, row in last.values():
        assert row[6] == (outcome == "touched")  # somebody is in view
        assert outcome == "reached" or abs(row[7]) < 0.1  # within a metre


@PEOPLE
def test_the_same_seed_makes_the_same_walk(plaza: Path, people: Any) -> None:
    walks = []
    for _ in range(2):
        env = TripEnv(plaza, people)
        env.action_space.seed(3)
        rows = [env.reset(seed=3)[0]]
        for _ in range(40):
            seen, _, terminated, truncated, _ = env.step(env.action_space.sample())
            rows.append(env.reset()[0] if terminated or truncated else seen)
        walks.append(np.array(rows))
    assert np.array_equal(walks[0], walks[1])


def test_what_cannot_be_is_named(tmp_path: Path, plaza: Path) -> None:
    short = write_csv(tmp_path, Crowd("short", (walk("1", 0.0, (0.0, 0.0), (1.0, 0.0)),)), "short")
    with pytest.raises(ValueError, match="nobody in it makes a trip"):
        TripEnv(short)
    with pytest.raises(ValueError, match="no moment at which 99 people make trips"):
        CrowdEnv(plaza, 99)
    with pytest.raises(ValueError, match=r"trip: 10000 is not from 0 to"):
        TripEnv(plaza).reset(options={"trip": 10_000})
