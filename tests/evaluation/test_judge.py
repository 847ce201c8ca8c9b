"""Every episode has the same score as in an independent implementation of the rules."""

import warnings
from types import ModuleType

import numpy as np
import pytest

from esplanade.evaluation.episodes import Episode, choose_episodes
from esplanade.evaluation.policies import make_policy
from esplanade.evaluation.replay import Interpolation, Replay
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.simulation import Environment, run_episode
from esplanade.recordings import Obstacles, read_crowd, read_obstacles, walls_beside
from tests.evaluation.judge import Judged, load_judge
from tests.recordings.data import recorded

RULES = Rules()
EXACT = {
    "collided": "touched",
    "n_hit": "people_touched",
    "active": "moved_toward",
    "reached": "reached",
    "popins": "pop_ins",
    "wall": "wall_contact",
    "steps": "decisions",
    "reverse": "reverse",
}
CLOSE = {
    "time": "time_s",
    "time_ratio": "time_ratio",
    "path_ratio": "path_ratio",
    "min_clear": "clearance_m",
    "personal_s": "near_s",
    "acc_max": "acceleration_max_mps2",
    "acc_rms": "acceleration_rms_mps2",
    "jerk_rms": "jerk_rms_mps3",
    "turn_rms": "turn_rms_radps",
}


def open_recording(
    name: str, interpolation: Interpolation = "linear"
) -> tuple[ModuleType, object, Replay]:
    """The judge, the recording in its form, and in ours."""
    path = recorded(name)
    judge = load_judge(path)
    walls = walls_beside(path)
    obstacles = Obstacles() if walls is None else read_obstacles(walls)
    ours = Replay(read_crowd(path), obstacles, interpolation=interpolation)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ResourceWarning)  # the judge leaves the file of walls open
        theirs = judge.load_recording(name, root=str(path.parent), interp=interpolation)
    return judge, theirs, ours


def assert_same(
    judge: ModuleType, theirs: object, ours: Replay, episodes: list[Episode], policy: str
) -> None:
    environment, walker = Environment.of(ours), make_policy(policy)
    for episode in episodes:
        same = judge.Episode(
            ours.name, episode.pedestrian, episode.first_tick, episode.start, episode.goal,
            episode.reverse,
        )  # fmt: skip
        judged = Judged(walker, ours, RULES, episode)
        expected = judge.run_episode(theirs, same, judged, a_max=RULES.max_acceleration_mps2)
        score = run_episode(environment, episode, walker, RULES).score
        found = {name: int(getattr(score, field)) for name, field in EXACT.items()}
        assert found == {name: expected[name] for name in EXACT}
        np.testing.assert_allclose(
            [getattr(score, field) for field in CLOSE.values()],
            [expected[name] for name in CLOSE],
            rtol=1e-9,
            atol=1e-9,
        )


@pytest.mark.parametrize("name", ["eth", "hotel", "zara1", "students3"])
@pytest.mark.parametrize(("count", "seed"), [(100, 0), (250, 7)])
def test_episodes_are_the_same(name: str, count: int, seed: int) -> None:
    judge, theirs, ours = open_recording(name)
    expected = judge.make_episodes(theirs, count, seed)
    chosen = choose_episodes(ours, RULES, count, seed)
    assert [(e.pedestrian, e.first_tick, e.start, e.goal, e.reverse) for e in chosen] == [
        (e.ped, e.k0, e.start, e.goal, e.reverse) for e in expected
    ]


@pytest.mark.parametrize("name", ["zara1", "students3"])
def test_our_actor_is_judged_the_same(name: str) -> None:
    judge, theirs, ours = open_recording(name)
    episodes = choose_episodes(ours, RULES, 100, 0)
    assert_same(judge, theirs, ours, episodes[:4], "esplanade")


@pytest.mark.parametrize("name", ["hotel", "zara1", "students3"])
@pytest.mark.parametrize("policy", ["esplanade", "straight"])
def test_trips_backward_are_judged_the_same(name: str, policy: str) -> None:
    judge, theirs, ours = open_recording(name)
    backward = [e for e in choose_episodes(ours, RULES, 250, 0) if e.reverse]
    assert len(backward) > 60
    assert_same(judge, theirs, ours, backward[:3], policy)


@pytest.mark.parametrize("name", ["hotel", "zara1"])
def test_policies_without_a_map_are_led_around_walls_the_same(name: str) -> None:
    judge, theirs, ours = open_recording(name)
    episodes = choose_episodes(ours, RULES, 100, 0)
    assert_same(judge, theirs, ours, episodes[::6], "straight")


def test_smooth_replays_are_judged_the_same() -> None:
    judge, theirs, ours = open_recording("zara1", "cubic")
    episodes = choose_episodes(ours, RULES, 100, 0)
    assert_same(judge, theirs, ours, episodes[:5], "straight")


def test_recorded_people_are_judged_the_same() -> None:
    judge, theirs, ours = open_recording("zara1")
    environment, human = Environment.of(ours), make_policy("human")
    for episode in [e for e in choose_episodes(ours, RULES, 100, 0) if not e.reverse][:5]:
        same = judge.Episode(
            ours.name, episode.pedestrian, episode.first_tick, episode.start, episode.goal, False
        )
        expected = judge.run_episode(theirs, same, judge.RealPath(), a_max=2.0)
        score = run_episode(environment, episode, human, RULES).score
        assert (score.people_touched, score.pop_ins) == (expected["n_hit"], expected["popins"])
        assert score.time_s == pytest.approx(expected["time"])
        assert score.clearance_m == pytest.approx(expected["min_clear"], abs=1e-9)
