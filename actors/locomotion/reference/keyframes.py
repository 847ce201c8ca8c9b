"""A walking cycle as eight key poses, the poses between them, and their repair (Chen et al. 2012).

Between keys every joint turns along a great arc (sec. 3). That alone leaves feet a little beside
where they should be; so the legs are bent anew, in closed form, onto root and feet of the gait
(sec. 4, fig. 9). Bodies walk straight on, along x; lengths are shares of the leg's.
"""

from __future__ import annotations

from functools import cache, reduce
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion.body.skeleton import FOOT, SHIN, THIGH, TRACK_HALF_WIDTH
from esplanade.actors.locomotion.gait.curves import support_share
from esplanade.actors.locomotion.gait.step_length import solve_relative_velocity
from esplanade.actors.locomotion.motion.key_poses import standing_ankles
from esplanade.actors.locomotion.planted.footprints import StepFootprints
from esplanade.actors.locomotion.planted.step import step_targets
from esplanade.actors.locomotion.planted.targets import Targets
from esplanade.actors.locomotion.reference import rotations
from esplanade.actors.locomotion.reference.limbs import leg_ik
from esplanade.planning.compiled.arrays import Floats

KEYS: Final = 8
"""Number of key poses of a cycle."""

# Joints of a frame; pairs are left, right.
PELVIS: Final = 0
"""Rotation in the world, axes forward, left, up."""
CHEST: Final = 1
"""Rotation relative to the pelvis."""
HIPS: Final = slice(2, 4)
KNEES: Final = slice(4, 6)
ANKLES: Final = slice(6, 8)
SHOULDERS: Final = slice(8, 10)
ELBOWS: Final = slice(10, 12)
JOINTS: Final = 12

_FORWARD, _LEFT, _UP = np.eye(3)
_ASIDE: Final = TRACK_HALF_WIDTH * np.stack([_LEFT, -_LEFT])
_SAMPLES: Final = 400


class Frames(NamedTuple):
    """N poses."""

    root: Floats
    """(N, 3): hip centre, from a point on the ground that moves along at a steady pace."""
    joints: Floats
    """(N, JOINTS, 4): quaternions, each relative to the joint nearer to the pelvis."""


class Feet(NamedTuple):
    """The places of the feet of N poses; pairs are left, right."""

    ankles: Floats
    """(N, 2, 3): ankles, which are the heels."""
    toes: Floats
    """(N, 2, 3)."""
    pitches: Floats
    """(N, 2), radians: positive with the toe up."""


def key_phases(step_length: float) -> Floats:
    """Phases of the keys of a gait with steps of a length (leg lengths): float64 (KEYS,), cycles.

    They are heel strike, toe-off, the middle of the swing and a moment near its end, for each side.
    Phase 0 is the heel strike of the left foot, phase 0.5 that of the right one.
    """
    rv = solve_relative_velocity(np.array([step_length]))
    both_down = float(support_share(rv)[0]) - 0.5
    half = np.array([0.0, both_down, 0.30, 0.45])
    return np.concatenate([half, half + 0.5])


def exact(step_length: float, phase: Floats) -> Frames:
    """The planted gait at phases (N,), cycles, as rotations of joints."""
    targets = _targets(step_length, phase)
    joints = np.empty((len(phase), JOINTS, 4))
    yaw, lean, roll = targets.yaw[:, 0], targets.lean[:, 0], targets.roll[:, 0]
    joints[:, PELVIS] = _about(_UP, yaw, _LEFT, lean, _FORWARD, roll)
    # The back makes up for the pelvis' roll: shoulders and head stay level.
    joints[:, CHEST] = _about(_FORWARD, -roll, _UP, targets.torsion[:, 0])
    joints[:, SHOULDERS] = _about(_LEFT, -targets.shoulders[:, 0])
    joints[:, ELBOWS] = _about(_LEFT, -targets.elbows[:, 0])
    joints[:, HIPS.start : ANKLES.stop] = rotations.IDENTITY
    return repaired(Frames(np.zeros((len(phase), 3)), joints), step_length, phase)


def interpolate(keys: Frames, phases: Floats, at: Floats) -> Frames:
    """Poses between keys.

    Parameters
    ----------
    keys : K poses
    phases : float64 (K,), cycles, ascending
    at : float64 (N,), cycles
        Phases of the poses asked for; the cycle goes round.

    Returns
    -------
    Frames of N poses

    Notes
    -----
    Chen et al. 2012, sec. 3: joints by slerp, roots along straight lines.
    """
    count = len(phases)
    before = (np.searchsorted(phases, at % 1.0, side="right") - 1) % count
    after = (before + 1) % count
    share = (at - phases[before]) % 1.0 / ((phases[after] - phases[before]) % 1.0)
    root = keys.root[before] + share[:, None] * (keys.root[after] - keys.root[before])
    joints = rotations.slerp(keys.joints[before], keys.joints[after], share[:, None])
    return Frames(root, joints)


def repaired(frames: Frames, step_length: float, phase: Floats) -> Frames:
    """Poses with the root of the gait, and legs bent so that both feet are where the gait has them.

    Pelvis, trunk and arms stay as they are. Chen et al. 2012, sec. 4.
    """
    root, wanted = walked(step_length, phase)
    joints = frames.joints.copy()
    pelvis = joints[:, None, PELVIS]
    hips = root[:, None] + rotations.rotate(pelvis, _ASIDE)
    ankles = rotations.rotate(rotations.inverse(pelvis), wanted.ankles - hips)
    forward = rotations.rotate(pelvis, _FORWARD)
    angles, _ = leg_ik(ankles, -np.arctan2(forward[..., 1], forward[..., 0]))
    joints[:, HIPS] = _about(_UP, angles.yaw, _FORWARD, angles.abduction, _LEFT, -angles.flexion)
    joints[:, KNEES] = _about(_LEFT, angles.knee)
    shins = _product(pelvis, joints[:, HIPS], joints[:, KNEES])
    feet = _about(_LEFT, -wanted.pitches)
    joints[:, ANKLES] = rotations.multiply(rotations.inverse(shins), feet)
    return Frames(root, joints)


def feet_of(frames: Frames) -> Feet:
    """Feet of poses, by forward kinematics of both legs."""
    joints = frames.joints
    pelvis = joints[:, None, PELVIS]
    thighs = rotations.multiply(pelvis, joints[:, HIPS])
    shins = rotations.multiply(thighs, joints[:, KNEES])
    feet = rotations.multiply(shins, joints[:, ANKLES])
    hips = frames.root[:, None] + rotations.rotate(pelvis, _ASIDE)
    knees = hips - THIGH * rotations.rotate(thighs, _UP)
    ankles = knees - SHIN * rotations.rotate(shins, _UP)
    ahead = rotations.rotate(feet, _FORWARD)
    return Feet(ankles, ankles + FOOT * ahead, np.arcsin(np.clip(ahead[..., 2], -1.0, 1.0)))


def walked(step_length: float, phase: Floats) -> tuple[Floats, Feet]:
    """Root, float64 (N, 3), and feet of the planted gait at phases (N,), cycles."""
    targets = _targets(step_length, phase)
    right = _right_stands(phase)
    rows = np.arange(len(phase))
    standing = _footprints(step_length, phase)[1]
    ankles, pitches = np.empty((len(phase), 2, 3)), np.empty((len(phase), 2))
    pitches[rows, right] = targets.standing_pitch[:, 0]
    pitches[rows, 1 - right] = targets.swing_pitch[:, 0]
    ankles[rows, right] = standing_ankles(
        standing, targets.standing_pitch[:, 0], np.full(len(phase), FOOT)
    )
    ankles[rows, 1 - right] = targets.swing_ankle[:, 0]
    root = targets.root[:, 0].copy()
    travelled = 2.0 * step_length * (phase % 1.0) + _lead(step_length)
    root[:, 0] -= travelled
    ankles[:, :, 0] -= travelled[:, None]
    toes = ankles.copy()
    toes[..., 0] += FOOT * np.cos(pitches)
    toes[..., 2] += FOOT * np.sin(pitches)
    return root, Feet(ankles, toes, pitches)


@cache
def _lead(step_length: float) -> float:
    """Mean distance of the root ahead of a steady pace from x = 0 on, over a cycle."""
    phase = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
    root = _targets(step_length, phase).root[:, 0, 0]
    return float(np.mean(root - 2.0 * step_length * phase))


def _right_stands(phase: Floats) -> NDArray[np.intp]:
    """1 where the right foot stands, else 0."""
    return (phase % 1.0 >= 0.5).astype(np.intp)


def _footprints(step_length: float, phase: Floats) -> tuple[Floats, Floats, Floats]:
    """Footprints (N, 4) lifted, standing and landing; the first left one is at x = 0."""
    right = _right_stands(phase)
    side = np.where(right, -TRACK_HALF_WIDTH, TRACK_HALF_WIDTH)
    made = np.zeros((3, len(phase), 4))
    made[:, :, 0] = step_length * (right + np.array([[-1.0], [0.0], [1.0]]))
    made[:, :, 1] = side * np.array([[-1.0], [1.0], [-1.0]])
    return made[0], made[1], made[2]


def _targets(step_length: float, phase: Floats) -> Targets:
    lifted, standing, landing = _footprints(step_length, phase)
    footprints = StepFootprints(
        _right_stands(phase).astype(np.bool_), lifted, standing, landing, np.ones(len(phase))
    )
    return step_targets(footprints, (2.0 * phase % 1.0)[:, None])


def _about(*axes_and_angles: Floats) -> Floats:
    """Product of rotations: axis, angles, axis, angles, ... from the outermost inwards."""
    return _product(
        *(
            rotations.about(axis, angle)
            for axis, angle in zip(axes_and_angles[::2], axes_and_angles[1::2], strict=True)
        )
    )


def _product(*factors: Floats) -> Floats:
    return reduce(rotations.multiply, factors)
