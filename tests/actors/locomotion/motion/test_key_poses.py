import numpy as np
import pytest

from esplanade.actors.locomotion.motion.key_poses import (
    ANKLE,
    CHEST,
    KEYS,
    PELVIS,
    ROOT,
    SETTLE,
    STANDING_PITCH,
    SWING_HEADING,
    SWING_PITCH,
    WIDTH,
    heel_from_toe,
    interpolate,
    sample_keys,
    standing_ankles,
)
from esplanade.planning.compiled.arrays import Floats
from tests.actors.locomotion.step_vectors import sample_steps
from tests.naive import steps as naive


def some_keys(count: int) -> Floats:
    keys = np.random.default_rng(1).normal(size=(count, KEYS, WIDTH))
    for part in (PELVIS, CHEST):
        keys[..., part] = [1.0, 0.0, 0.0, 0.0] + 0.1 * keys[..., part]
        keys[..., part] /= np.linalg.norm(keys[..., part], axis=-1, keepdims=True)
    return keys


def test_curves_go_through_the_keys() -> None:
    keys = some_keys(4)
    for k in range(KEYS):
        np.testing.assert_allclose(
            interpolate(keys, np.full(4, k / (KEYS - 1))), keys[:, k], atol=1e-12
        )


def test_curves_are_as_smooth_as_their_slopes() -> None:
    keys, step = some_keys(3), 1e-6
    for u in np.linspace(0.05, 0.95, 19):
        before, here, after = (
            interpolate(keys, np.full(3, share)) for share in (u - step, u, u + step)
        )
        np.testing.assert_allclose((here - before) / step, (after - here) / step, atol=2e-3)


def test_lines_stay_lines() -> None:
    keys = some_keys(1)
    keys[0, :, ROOT] = np.linspace(-1.0, 1.0, KEYS)[:, None]
    for u in np.linspace(0.0, 1.0, 23):
        np.testing.assert_allclose(
            interpolate(keys, np.array([u]))[0, ROOT], 2.0 * u - 1.0, atol=1e-12
        )


def test_the_swinging_foot_comes_to_rest() -> None:
    keys, step = some_keys(5), 1e-5
    last = interpolate(keys, np.ones(5)) - interpolate(keys, np.full(5, 1.0 - step))
    for part in (ANKLE, SWING_PITCH, SWING_HEADING):
        assert np.abs(last[:, part] / step).max() < 0.01
    assert np.abs(last[:, STANDING_PITCH] / step).max() > 0.5


def test_kernels_agree_with_their_plain_twins() -> None:
    steps, sizes = sample_steps()
    for u in np.linspace(0.0, 1.0, 31):
        share = np.full(len(steps.lift), u)
        np.testing.assert_allclose(
            interpolate(steps.keys, share), naive.interpolate(steps.keys, share), atol=1e-12
        )
        np.testing.assert_allclose(
            sample_keys(steps, share, sizes.foot_m),
            naive.sample_keys(steps, share, sizes.foot_m),
            atol=1e-12,
        )


def test_the_toe_stays_until_the_foot_lifts() -> None:
    steps, sizes = sample_steps()
    count = len(steps.lift)

    def toes(u: Floats) -> Floats:
        key = sample_keys(steps, u, sizes.foot_m)
        heading = steps.landing[:, 3] + key[:, SWING_HEADING]
        foot = heel_from_toe(key[:, SWING_PITCH], heading, sizes.foot_m)
        return np.asarray(steps.landing[:, :3] + key[:, ANKLE] - foot)

    first = toes(np.zeros(count))
    for share in (0.3, 0.7, 1.0):
        np.testing.assert_allclose(toes(share * steps.lift), first, atol=1e-12)
    # From there it comes over to its curve without a jump.
    moved = np.linalg.norm(toes(steps.lift + 1e-5) - first, axis=1)
    assert moved[steps.lift > 0.0].max() < 1e-4
    free = np.minimum(steps.lift + SETTLE, 1.0)
    np.testing.assert_allclose(
        sample_keys(steps, free, sizes.foot_m), interpolate(steps.keys, free), atol=1e-12
    )


@pytest.mark.parametrize(("pitch", "stays"), [(0.4, "heel"), (-0.7, "toe"), (0.0, "both")])
def test_a_standing_foot_turns_about_the_end_it_stands_on(pitch: float, stays: str) -> None:
    footprint, foot = np.array([[1.0, 2.0, 0.5, 0.8]]), np.array([0.18])
    ankle = standing_ankles(footprint, np.array([pitch]), foot)
    toe = ankle - heel_from_toe(np.array([pitch]), footprint[:, 3], foot)
    flat = footprint[:, :3] - heel_from_toe(np.zeros(1), footprint[:, 3], foot)
    if stays != "toe":
        np.testing.assert_allclose(ankle, footprint[:, :3], atol=1e-15)
    if stays != "heel":
        np.testing.assert_allclose(toe, flat, atol=1e-15)
    assert ankle[0, 2] >= 0.5
    assert toe[0, 2] >= 0.5 - 1e-12
