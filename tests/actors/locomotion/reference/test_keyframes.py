"""Eight key poses of a cycle: what slerp between them costs, and that repair restores the feet."""

import numpy as np
import pytest

from esplanade.actors.locomotion.reference import keyframes, rotations
from esplanade.actors.locomotion.reference.keyframes import ANKLES, HIPS, KEYS, KNEES

PHASES = np.linspace(0.0, 1.0, 800, endpoint=False)
LENGTH = 0.5


def with_midpoints(phases: np.ndarray) -> np.ndarray:
    return np.sort(np.concatenate((phases, phases + np.diff(np.append(phases, 1.0)) / 2.0)))


def joint_errors_deg(frames: keyframes.Frames, length: float = LENGTH) -> np.ndarray:
    """Largest angle per joint between poses and those of the gait."""
    truth = keyframes.exact(length, PHASES)
    return np.degrees(rotations.angle_between(frames.joints, truth.joints)).max(axis=0)


def interpolated(phases: np.ndarray, length: float = LENGTH) -> keyframes.Frames:
    return keyframes.interpolate(keyframes.exact(length, phases), phases, PHASES)


def test_there_are_eight_keys_in_two_mirrored_halves():
    phases = keyframes.key_phases(LENGTH)
    assert len(phases) == KEYS
    assert np.all(np.diff(phases) > 0.0)
    assert np.allclose(phases[4:] - phases[:4], 0.5)


@pytest.mark.parametrize("length", [0.1, 0.3, 0.5, 0.65])
def test_joint_rotations_hold_the_gait_exactly(length: float):
    legs = keyframes.feet_of(keyframes.exact(length, PHASES))
    _, wanted = keyframes.walked(length, PHASES)
    assert np.max(np.abs(legs.ankles - wanted.ankles)) < 1e-9
    assert np.max(np.abs(legs.toes - wanted.toes)) < 1e-9


def test_keys_are_passed_exactly():
    phases = keyframes.key_phases(LENGTH)
    keys = keyframes.exact(LENGTH, phases)
    passed = keyframes.interpolate(keys, phases, phases)
    assert np.allclose(passed.root, keys.root, atol=1e-12)
    assert np.max(rotations.angle_between(passed.joints, keys.joints)) < 1e-7


def test_twice_the_keys_are_closer_to_the_gait():
    phases = keyframes.key_phases(LENGTH)
    eight = joint_errors_deg(interpolated(phases))
    sixteen = joint_errors_deg(interpolated(with_midpoints(phases)))
    assert eight.max() < 13.0
    assert sixteen.max() < eight.max()


def test_repair_restores_both_feet():
    frames = keyframes.repaired(interpolated(keyframes.key_phases(LENGTH)), LENGTH, PHASES)
    legs = keyframes.feet_of(frames)
    _, wanted = keyframes.walked(LENGTH, PHASES)
    assert np.max(np.abs(legs.ankles - wanted.ankles)) < 1e-9
    assert np.max(np.abs(legs.toes - wanted.toes)) < 1e-9
    for joint in (HIPS, KNEES, ANKLES):
        assert joint_errors_deg(frames)[joint].max() < 1.0


def test_without_repair_flat_feet_nearly_stay_but_swinging_ones_are_off():
    legs = keyframes.feet_of(interpolated(keyframes.key_phases(LENGTH)))
    _, wanted = keyframes.walked(LENGTH, PHASES)
    flat = (PHASES > 0.1) & (PHASES < 0.25)
    heel = legs.ankles[flat, 0, 0] + 2.0 * LENGTH * PHASES[flat]
    assert np.ptp(heel) < 5e-4
    off = np.abs(legs.ankles - wanted.ankles)[:, 0].max(axis=-1)
    assert off[flat].max() < 6e-3
    assert off[PHASES > 0.6].max() > 1e-2


def test_half_a_cycle_later_the_sides_have_changed():
    root, legs = keyframes.walked(LENGTH, PHASES)
    later_root, later = keyframes.walked(LENGTH, PHASES + 0.5)
    mirror = np.array([1.0, -1.0, 1.0])
    assert np.allclose(later_root, root * mirror, atol=1e-12)
    assert np.allclose(later.ankles, legs.ankles[:, ::-1] * mirror, atol=1e-12)


def test_hips_go_along_with_the_steady_point():
    root, _ = keyframes.walked(LENGTH, PHASES)
    assert np.abs(root[:, 0].mean()) < 1e-6
    assert np.abs(root[:, 0]).max() < 0.05
