import numpy as np

from esplanade.actors.locomotion.motion._current_pose_kernels import CurrentPose
from esplanade.actors.locomotion.motion._transition_kernels import (
    fill_keys,
    fill_shift_keys,
    fill_step_keys,
    inertialise,
)
from esplanade.actors.locomotion.motion.key_poses import KEYS, PELVIS, WIDTH, interpolate
from esplanade.actors.locomotion.motion.transitions import standing_keys
from esplanade.actors.locomotion.planted.footprints import StepFootprints
from esplanade.actors.locomotion.planted.step import gait_tables, step_targets
from esplanade.planning.compiled.arrays import Floats, Ints
from tests.naive import steps as naive

SHARES = np.linspace(0.0, 1.0, KEYS)


def some_footprints(count: int) -> StepFootprints:
    random = np.random.default_rng(5)
    right = np.arange(count) % 2 == 0
    side = np.where(right, 1.0, -1.0)
    standing = np.zeros((count, 4))
    standing[:, 3] = random.uniform(-9.0, 9.0, count)
    feet = []
    for ahead in (random.uniform(-0.6, 0.1, count), random.uniform(-0.1, 0.6, count)):
        foot = standing.copy()
        h, across = standing[:, 3], side * random.uniform(0.15, 0.3, count)
        foot[:, 0] += ahead * np.cos(h) - across * np.sin(h)
        foot[:, 1] += ahead * np.sin(h) + across * np.cos(h)
        foot[:, 3] += random.uniform(-0.3, 0.3, count)
        feet.append(foot)
    return StepFootprints(right, feet[0], standing, feet[1], random.uniform(0.8, 0.95, count))


def some_pose(keys: Floats) -> CurrentPose:
    """Something near the first key, on the move; every other pelvis with the other sign."""
    random = np.random.default_rng(6)
    key = keys[:, 0] + 0.02 * random.normal(size=(len(keys), WIDTH))
    key[::2, PELVIS] *= -1.0
    return CurrentPose(key, 0.01 * random.normal(size=(len(keys), WIDTH)))


def step_keys(
    footprints: StepFootprints,
    elapsed: Floats,
    now: CurrentPose,
    ticks: Ints,
    hips: Floats,
    room_m: Floats,
) -> tuple[Floats, Floats]:
    """Keys and toe-offs of what `fill_step_keys` writes."""
    keys = np.empty((len(elapsed), KEYS, WIDTH))
    lift, flight = np.empty(len(elapsed)), np.empty(len(elapsed))
    own = CurrentPose(now.key.copy(), now.speed.copy())
    tables = gait_tables()
    fill_step_keys(footprints, elapsed, own, ticks, hips, room_m, tables, keys, lift, flight)
    return keys, lift


def test_kernels_agree_with_their_plain_twins() -> None:
    footprints = some_footprints(9)
    targets = step_targets(footprints, SHARES)
    keys = np.empty((9, KEYS, WIDTH))
    fill_keys(targets, footprints, keys)
    plain = naive.keys_of(targets, footprints)
    np.testing.assert_allclose(keys, plain, atol=1e-12)

    now = some_pose(keys)
    ticks, re_aimed = np.arange(9) + 4, np.arange(9) % 3 == 0
    from_air = np.arange(9) % 4 == 1
    aside = np.random.default_rng(7).normal(size=(9, 2)) * 0.1
    bent = naive.inertialise(keys, now, re_aimed, from_air, ticks, aside)
    inertialise(keys, now.key.copy(), now.speed.copy(), re_aimed, from_air, ticks, aside)
    np.testing.assert_allclose(keys, bent, atol=1e-12)


def test_a_step_re_aimed_from_what_is_drawn_in_place_and_speed() -> None:
    footprints = some_footprints(8)
    now = some_pose(standing_keys(footprints))
    now.speed[:, PELVIS] = 0.0
    now.key[:, PELVIS] /= np.linalg.norm(now.key[:, PELVIS], axis=1, keepdims=True)
    ticks = np.full(8, 9)
    elapsed = np.full(8, 0.4)
    hips = footprints.landing[:, :2].copy()
    keys, lift = step_keys(footprints, elapsed, now, ticks, hips, np.full(8, 0.1))
    body = [0, 1, 2, 7, 8, 9, 10, 11]
    start = interpolate(keys, np.zeros(8))
    np.testing.assert_allclose(start[:, body], now.key[:, body], atol=1e-12)
    step = 1e-6
    slope = (interpolate(keys, np.full(8, step)) - start) / step
    np.testing.assert_allclose(slope[:, body], 9.0 * now.speed[:, body], atol=1e-4)
    assert ((lift >= 0.0) & (lift < 1.0)).all()


def test_hips_end_where_they_should_within_their_room() -> None:
    footprints = some_footprints(6)
    now = CurrentPose(standing_keys(footprints)[:, 0].copy(), np.zeros((6, WIDTH)))
    elapsed, ticks = np.zeros(6), np.full(6, 10)
    free, _ = step_keys(footprints, elapsed, now, ticks, np.zeros((6, 2)), np.zeros(6))
    ends = free[:, -1, :2] + footprints.standing[:, :2]
    asked = ends + np.array([0.06, -0.08])
    near, _ = step_keys(footprints, elapsed, now, ticks, asked, np.full(6, 0.2))
    np.testing.assert_allclose(near[:, -1, :2] + footprints.standing[:, :2], asked, atol=1e-12)
    far, _ = step_keys(footprints, elapsed, now, ticks, asked, np.full(6, 0.05))
    moved = far[:, -1, :2] - free[:, -1, :2]
    np.testing.assert_allclose(np.hypot(moved[:, 0], moved[:, 1]), 0.05, atol=1e-12)


def test_a_shift_of_weight_keeps_both_feet_where_they_are() -> None:
    footprints = some_footprints(4)
    footprints = footprints._replace(landing=footprints.lifted)
    still = standing_keys(footprints)
    places = np.full((4, 2), 0.03)
    keys = np.empty((4, KEYS, WIDTH))
    now = CurrentPose(still[:, 0].copy(), np.zeros((4, WIDTH)))
    fill_shift_keys(now, footprints, places, keys)
    np.testing.assert_allclose(keys[:, 0, :7], still[:, 0, :7])
    np.testing.assert_allclose(keys[:, -1, :2] + footprints.standing[:, :2], places, atol=1e-12)
    assert (keys[..., 7:10] == 0.0).all()
