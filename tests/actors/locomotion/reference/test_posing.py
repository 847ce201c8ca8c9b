import numpy as np

from esplanade.actors.locomotion.body.sizes import BodySizes
from esplanade.actors.locomotion.body.skeleton import FOOT, HANGING_ARMS, SHIN, THIGH
from esplanade.actors.locomotion.motion.key_poses import (
    ANKLE,
    STANDING_PITCH,
    SWING_PITCH,
    sample_keys,
)
from esplanade.actors.locomotion.motion.leg_poses import REACH, leg_poses
from esplanade.actors.locomotion.reference.posing import Pose, pose
from esplanade.planning.compiled.arrays import Floats
from tests.actors.locomotion.step_vectors import sample_steps
from tests.naive import steps as naive

SHARES = np.linspace(0.0, 1.0, 41)


def poses() -> list[tuple[Floats, Pose, BodySizes]]:
    steps, sizes = sample_steps()
    count = len(steps.lift)
    return [(np.full(count, u), pose(steps, np.full(count, u), sizes), sizes) for u in SHARES]


def test_bones_keep_their_lengths() -> None:
    for _, joints, sizes in poses():
        leg, trunk = sizes.leg_m[:, None], sizes.trunk_m[:, None]
        for a, b, length in (
            (joints.hips, joints.knees, THIGH * leg),
            (joints.ankles, joints.toes, FOOT * leg),
            (joints.shoulders, joints.elbows, HANGING_ARMS.upper_arm * trunk),
            (joints.elbows, joints.hands, HANGING_ARMS.forearm * trunk),
        ):
            bone = np.linalg.norm(a - b, axis=2)
            np.testing.assert_allclose(bone, np.broadcast_to(length, bone.shape), atol=1e-12)


def test_shins_reach_the_feet_where_hips_can_come_down_to_them() -> None:
    for _, joints, sizes in poses():
        leg = sizes.leg_m[:, None]
        apart = np.linalg.norm((joints.hips - joints.ankles)[..., :2], axis=2)
        near = apart <= REACH * leg
        shin = np.linalg.norm(joints.knees - joints.ankles, axis=2)
        np.testing.assert_allclose(shin[near], np.broadcast_to(SHIN * leg, shin.shape)[near])


def test_knees_bend_forward() -> None:
    for _, joints, sizes in poses():
        w, x, y, z = joints.pelvis.T
        forward = np.stack([1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z)], axis=1)
        line = joints.ankles - joints.hips
        length2 = np.einsum("nsd,nsd->ns", line, line)
        along = np.einsum("nsd,nsd->ns", joints.knees - joints.hips, line) / length2
        bend = (joints.knees - joints.hips - along[..., None] * line)[..., :2]
        ahead = np.einsum("nsd,nd->ns", bend, forward)
        assert (ahead > -0.02 * sizes.leg_m[:, None]).all()


def test_legs_agree_with_their_plain_twin() -> None:
    steps, sizes = sample_steps()
    raised = lowered = 0
    for u in SHARES:
        share = np.full(len(steps.lift), u)
        key = sample_keys(steps, share, sizes.foot_m)
        legs, plain = leg_poses(steps, share, key, sizes), naive.leg_poses(steps, share, key, sizes)
        for one, other in zip(legs, plain, strict=True):
            np.testing.assert_allclose(one, other, atol=1e-9)
        asked = np.stack([key[:, STANDING_PITCH], key[:, SWING_PITCH]], axis=1)
        raised += int((legs.pitches.sum(axis=1) < asked.sum(axis=1) - 1e-6).sum())
        lowered += int((legs.root[:, 2] < steps.standing[:, 2] + key[:, 2] - 1e-6).sum())
    assert raised > 20
    assert lowered > 20


def test_a_short_leg_raises_the_heel_of_the_foot_it_stands_on_and_not_its_toe() -> None:
    steps, sizes = sample_steps()
    share = np.ones(len(steps.lift))
    key = sample_keys(steps, share, sizes.foot_m)
    key[:, 2] += 0.05
    legs = leg_poses(steps, share, key, sizes)
    rows = np.arange(len(share))
    stands = steps.on_right.astype(np.int64)
    pitch = legs.pitches[rows, stands]
    assert (pitch <= key[:, STANDING_PITCH] + 1e-12).all()
    level = sizes.foot_m * np.cos(pitch)
    heading = steps.standing[:, 3]
    toe = legs.ankles[rows, stands] + np.stack(
        [level * np.cos(heading), level * np.sin(heading), sizes.foot_m * np.sin(pitch)], axis=1
    )
    flat = steps.standing[:, :3].copy()
    flat[:, 0] += sizes.foot_m * np.cos(heading)
    flat[:, 1] += sizes.foot_m * np.sin(heading)
    on_toe = (pitch <= 0.0) & (steps.flight == 0.0)
    assert on_toe.sum() > 6
    np.testing.assert_allclose(toe[on_toe], flat[on_toe], atol=1e-12)
    np.testing.assert_allclose(
        legs.ankles[rows, 1 - stands], steps.landing[:, :3] + key[:, ANKLE], atol=1e-12
    )


def test_a_tall_trunk_stands_on_the_same_legs() -> None:
    steps, sizes = sample_steps()
    taller = BodySizes(sizes.leg_m, sizes.stature_m + 0.2)
    share = np.full(len(steps.lift), 0.4)
    one, other = pose(steps, share, sizes), pose(steps, share, taller)
    np.testing.assert_array_equal(one.knees, other.knees)
    assert (other.head[:, 2] > one.head[:, 2] + 0.15).all()
