"""Two-stage inverse kinematics: it reaches, keeps limits, and saves joint updates."""

from functools import cache

import numpy as np
import pytest

from esplanade.actors.locomotion.body import skeleton
from esplanade.actors.locomotion.reaching.two_stage import (
    Reach,
    arm_chain,
    effector,
    heel_chain,
    reach,
    reach_by_ccd,
)
from tests.naive.inverse_kinematics import ccd, hinges_and_tip

TARGETS = 1000
TRUNK = 6
CHAINS = {
    "left heel": heel_chain(left=True),
    "right heel": heel_chain(left=False),
    "left hand": arm_chain(left=True),
    "right hand": arm_chain(left=False),
}
SHARE_OF_FULL = {"limb": 0.0, "mixed": 0.5, "full": 1.0}


@cache
def random_targets(chain_name: str, kind: str):
    """Random starts and targets within the limits; limb targets keep the trunk where it starts."""
    chain = CHAINS[chain_name]
    random = np.random.default_rng(11)
    starts, goals = random.uniform(chain.lows, chain.highs, (2, TARGETS, len(chain.lows)))
    limb_only = random.random(TARGETS) >= SHARE_OF_FULL[kind]
    goals[limb_only, :TRUNK] = starts[limb_only, :TRUNK]
    return starts, effector(chain, goals)


@cache
def two_stage(chain_name: str, kind: str) -> Reach:
    starts, targets = random_targets(chain_name, kind)
    return reach(CHAINS[chain_name], targets, starts, np.random.default_rng(12))


@cache
def plain(chain_name: str, kind: str) -> Reach:
    starts, targets = random_targets(chain_name, kind)
    return reach_by_ccd(CHAINS[chain_name], targets, starts)


def test_every_target_of_the_limb_is_reached_in_few_sweeps():
    for chain_name in CHAINS:
        found = two_stage(chain_name, "limb")
        assert np.all(found.reached)
        assert found.sweeps.max() <= 100
        assert found.left.max() <= 1e-3


@pytest.mark.parametrize("kind", ["mixed", "full"])
def test_nearly_all_targets_of_the_whole_chain_are_reached(kind: str):
    assert two_stage("left heel", kind).reached.mean() >= 0.99


@pytest.mark.parametrize(("kind", "saved"), [("limb", 0.80), ("mixed", 0.60), ("full", 0.40)])
def test_most_joint_updates_of_plain_ccd_are_saved(kind: str, saved: float):
    ratio = two_stage("left heel", kind).turned.mean() / plain("left heel", kind).turned.mean()
    assert ratio <= 1.0 - saved


@pytest.mark.parametrize("kind", SHARE_OF_FULL)
@pytest.mark.parametrize("chain_name", CHAINS)
def test_limits_are_never_violated(chain_name: str, kind: str):
    chain = CHAINS[chain_name]
    starts, targets = random_targets(chain_name, kind)
    for found in (
        two_stage(chain_name, kind),
        plain(chain_name, kind),
        reach_by_ccd(chain, targets, starts, limb_sweeps=10),
    ):
        assert np.all(found.angles >= chain.lows - 1e-12)
        assert np.all(found.angles <= chain.highs + 1e-12)


def test_what_is_reported_is_where_the_effector_is():
    chain = CHAINS["right hand"]
    _, targets = random_targets("right hand", "full")
    found = two_stage("right hand", "full")
    missed = np.linalg.norm(effector(chain, found.angles) - targets, axis=1)
    assert np.allclose(found.left, missed, atol=1e-12)
    assert np.array_equal(found.reached, missed <= 1e-3)


def test_the_trunk_rests_while_the_limb_is_enough():
    starts, _ = random_targets("left hand", "limb")
    found = two_stage("left hand", "limb")
    at_rest = np.all(found.angles[:, :TRUNK] == starts[:, :TRUNK], axis=1)
    assert at_rest.mean() > 0.95


def test_ccd_agrees_with_its_twin():
    chain = CHAINS["left heel"]
    starts, targets = (values[:25] for values in random_targets("left heel", "full"))
    found = reach_by_ccd(chain, targets, starts, sweeps=4)
    for n in range(25):
        angles, turned = ccd(chain, starts[n], targets[n], 1e-3, 4)
        assert np.allclose(found.angles[n], angles, atol=1e-9)
        assert found.turned[n] == turned


def test_forward_kinematics_agree_with_their_twin():
    for name, chain in CHAINS.items():
        poses = random_targets(name, "full")[0][:20]
        tips = [hinges_and_tip(chain, pose)[2] for pose in poses]
        assert np.allclose(effector(chain, poses), tips, atol=1e-12)


def test_chains_hang_where_the_body_has_its_heels_and_hands():
    rest = np.zeros(10)
    heel = effector(CHAINS["left heel"], rest)[0]
    hand = effector(CHAINS["right hand"], rest)[0]
    assert np.allclose(
        heel, (skeleton.HIP_HALF_WIDTH, -1.0 - skeleton.HIP_DEPTH - skeleton.CHEST_HEIGHT, 0.0)
    )
    arm = skeleton.REACHING_ARMS.upper_arm + skeleton.REACHING_ARMS.forearm
    shoulder = -skeleton.REACHING_ARMS.shoulder_aside, skeleton.REACHING_ARMS.shoulder_height
    assert np.allclose(hand, (shoulder[0], shoulder[1] - arm, 0.0))


def test_sides_mirror_each_other():
    mirror = np.array([-1.0, 1.0, 1.0])
    signs = np.array([-1, 1, -1, -1, 1, -1, -1, -1, 1, 1])
    starts, targets = random_targets("left heel", "limb")
    right = CHAINS["right heel"]
    found = reach_by_ccd(right, targets * mirror, starts * signs)
    assert np.allclose(
        effector(right, starts * signs), effector(CHAINS["left heel"], starts) * mirror
    )
    assert np.mean(found.reached) == pytest.approx(plain("left heel", "limb").reached.mean())


def test_a_hand_points_at_what_is_out_of_reach():
    chain = CHAINS["left hand"]
    target = np.array([[0.3, 0.4, 5.0]])
    found = reach(chain, target, np.zeros(10), np.random.default_rng(1))
    assert not found.reached[0]
    assert np.all(np.isfinite(found.angles))
    assert effector(chain, found.angles)[0, 2] > 0.6


def test_the_same_seed_gives_the_same_pose():
    starts, targets = random_targets("left heel", "full")
    once = two_stage("left heel", "full")
    again = reach(CHAINS["left heel"], targets, starts, np.random.default_rng(12))
    assert np.array_equal(once.angles, again.angles)


@pytest.mark.parametrize(
    ("changed", "named"),
    [
        ({"targets": np.zeros(3)}, "targets"),
        ({"targets": np.full((1, 3), np.nan)}, "targets"),
        ({"start": np.zeros(4)}, "start"),
        ({"start": np.full(10, np.inf)}, "start"),
        ({"tolerance": 0.0}, "tolerance"),
        ({"sweeps": 0}, "sweeps"),
        ({"restarts": -1}, "restarts"),
    ],
)
def test_what_cannot_be_solved_is_named(changed: dict, named: str):
    arguments = {"targets": np.zeros((1, 3)), "start": np.zeros(10)} | changed
    with pytest.raises(ValueError, match=named):
        reach(CHAINS["left heel"], random=np.random.default_rng(0), **arguments)
