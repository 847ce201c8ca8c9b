"""Every policy in small cases: it arrives, keeps clear of people, and is reset completely."""

from importlib.util import find_spec
from typing import Any

import numpy as np
import pytest
from _pytest.mark.structures import ParameterSet

from esplanade.evaluation.policies import POLICIES, PolicyError, jupedsim_models, make_policy, orca
from esplanade.evaluation.policies.policy import Policy
from esplanade.evaluation.replay import Replay
from esplanade.evaluation.simulation import Environment, EpisodeResult, run_episode
from esplanade.recordings import Obstacles
from tests.evaluation.worlds import RULES, busy_plaza, environment, trip, walk

HEDGE = Obstacles(segments=(((5.0, -3.0), (5.0, 1.5)),))
ROBOT = walk("1", 0.0, (0, 0), (10, 0))
HEAD_ON = walk("2", 0.0, (10, 0.05), (-2, 0.05))

PEERS = {
    "orca": "pyrvo",
    "jupedsim-speed": "jupedsim",
    "jupedsim-anticipation": "jupedsim",
    "jupedsim-forces": "jupedsim",
}
"""The packages that policies need."""


def with_its_package(name: str) -> ParameterSet | str:
    """A policy as a parameter, which is skipped where its package is absent."""
    package = PEERS.get(name)
    if package is None or find_spec(package) is not None:
        return name
    return pytest.param(name, marks=pytest.mark.skip(reason=f"{package} is absent"))


every_policy = pytest.mark.parametrize(
    "name", [with_its_package(name) for name in POLICIES if name != "human"]
)


def run(name: str, place: Environment, policy: Policy | None = None) -> EpisodeResult:
    return run_episode(place, trip(place.replay), policy or make_policy(name), RULES)


@every_policy
def test_alone_every_policy_arrives_in_about_the_straight_lines_time(name: str) -> None:
    score = run(name, environment(ROBOT)).score
    assert score.reached
    assert score.time_ratio < 1.2


@every_policy
def test_every_policy_gets_around_a_wall(name: str) -> None:
    score = run(name, environment(ROBOT, obstacles=HEDGE)).score
    assert score.reached
    assert not score.wall_contact


@every_policy
def test_decisions_depend_on_nothing_before_the_reset(name: str) -> None:
    place = Environment.of(Replay(busy_plaza()))
    policy = make_policy(name)
    first, again = (run(name, place, policy) for _ in range(2))
    np.testing.assert_array_equal(first.trajectory, again.trajectory)
    np.testing.assert_array_equal(first.trajectory, run(name, place).trajectory)


@pytest.mark.parametrize("name", ["esplanade", "discs", "oracle"])
def test_policies_that_look_ahead_make_way(name: str) -> None:
    score = run(name, environment(ROBOT, HEAD_ON)).score
    assert score.reached
    assert not score.touched
    assert score.time_ratio < 1.3


def test_straight_on_runs_into_people() -> None:
    assert run("straight", environment(ROBOT, HEAD_ON)).score.moved_toward


def test_the_oracle_does_not_dodge_people_who_will_turn_off() -> None:
    turns_off = walk("2", 0.0, (10, 0.05), (6.5, 0.05), (6.5, 9.0))
    ratios = {
        name: run(name, environment(ROBOT, turns_off)).score.path_ratio
        for name in ("discs", "oracle")
    }
    assert ratios["oracle"] < ratios["discs"]


@pytest.mark.parametrize("name", ["esplanade", "discs", "oracle", "straight"])
def test_plans_can_be_drawn(name: str) -> None:
    policy = make_policy(name)
    run(name, environment(ROBOT, HEAD_ON), policy)
    debug_info = policy.debug_info()
    assert debug_info.path.shape[1:] == (2,)
    assert len(debug_info.path) > 0
    assert debug_info.circles.shape[1:] == (3,)


def test_our_actor_takes_changed_parameters() -> None:
    place = environment(ROBOT)
    slow = run("esplanade", place, make_policy("esplanade", {"speed_mps": 0.65})).score
    assert slow.time_ratio > 1.8


def test_a_recording_too_large_for_a_scene_is_refused_by_name() -> None:
    place = environment(ROBOT, walk("2", 0.0, (0, 900), (1, 900)))
    with pytest.raises(PolicyError, match=r"plaza cannot be made into a scene: .* 650 m"):
        run("esplanade", place)


@pytest.mark.parametrize("name", PEERS)
def test_peers_that_are_not_installed_say_what_helps(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def absent(module: str) -> object:
        raise ImportError(module)

    monkeypatch.setattr(jupedsim_models, "import_module", absent)
    monkeypatch.setattr(orca, "import_module", absent)
    needs = rf"needs? the package {PEERS[name]}: install it, or .*esplanade\[peers\]"
    with pytest.raises(PolicyError, match=needs):
        make_policy(name)


@pytest.mark.skipif(find_spec("pyrvo") is None, reason="pyrvo is absent")
def test_orca_gives_somebody_who_stands_the_room_that_it_is_told() -> None:
    stands = walk("2", 0.0, (5.0, 0.0), (5.0, 0.2), speed_mps=0.01)
    least = {
        margin_m: run(
            "orca", environment(ROBOT, stands), make_policy("orca", {"margin_m": margin_m})
        ).score.clearance_m
        for margin_m in (0.02, 0.5)
    }
    assert 0.0 < least[0.02] < 0.2
    assert least[0.5] > 0.4


@pytest.mark.skipif(find_spec("pyrvo") is None, reason="pyrvo is absent")
@pytest.mark.parametrize(
    ("options", "why"),
    [
        ({"horizon": 2.0}, "no option horizon; there are horizon_s, wall_horizon_s, margin_m"),
        ({"horizon_s": "long"}, "horizon_s='long' is no number from 0 to 100"),
        ({"margin_m": -1.0}, "margin_m=-1.0 is no number from 0 to 100"),
    ],
)
def test_options_of_orca_are_checked(options: dict[str, Any], why: str) -> None:
    with pytest.raises(PolicyError, match=why):
        make_policy("orca", options)
