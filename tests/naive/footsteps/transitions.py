"""Transitions: the keys of a step that goes on smoothly from the pose that is drawn now."""

from __future__ import annotations

from typing import Final

import numpy as np

from esplanade.actors.locomotion.body.sizes import BodySizes
from esplanade.actors.locomotion.gait.curves import smooth
from esplanade.actors.locomotion.motion._current_pose_kernels import CurrentPose
from esplanade.actors.locomotion.motion._transition_kernels import fill_keys, inertialise
from esplanade.actors.locomotion.motion.key_poses import (
    ANKLE,
    KEYS,
    ROOT,
    ROOT_ON_MAP,
    STANDING_PITCH,
    SWING_HEADING,
    SWING_PITCH,
    WIDTH,
    Steps,
    sample_keys,
)
from esplanade.actors.locomotion.motion.leg_poses import leg_poses
from esplanade.actors.locomotion.planted.footprints import (
    HEADING,
    ON_MAP,
    PLACE,
    StepFootprints,
    Z,
)
from esplanade.actors.locomotion.planted.step import step_targets
from esplanade.actors.locomotion.planted.targets import Targets
from esplanade.planning.compiled.arrays import Bools, Floats, Ints
from tests.naive.headings import wrap_angle

_SHARES: Final = np.linspace(0.0, 1.0, KEYS)

# A foot that stands lower than the other one leaves the ground earlier: lengths in legs.
_LEVEL: Final = 0.15
"""Up to this rise it does so as on level ground."""
_STEEP: Final = 0.35
"""From this rise on it does so earliest."""
_EARLIER: Final = 0.7
"""Share of the usual time to toe-off that is then left out."""

_BACK: Final = 0.02
"""Share of a step over which the speed of the current pose is taken."""


def current_pose(
    old: Steps, tick: int, footprints: StepFootprints, swapped: Bools, sizes: BodySizes
) -> CurrentPose:
    """The pose of N bodies at a tick, as keys of their next steps.

    Parameters
    ----------
    old : the steps that are under way, or were the last ones
    footprints : of the next steps
    swapped : bool (N,)
        Whether the feet change parts: the swing foot has landed and is the next standing foot.
    sizes : of the N bodies
    """
    share = old.share(tick)
    now = sample_keys(old, share, sizes.foot_m)
    before = np.maximum(share - _BACK, 0.0)
    passed = (share - before) * old.ticks
    # A body that stands, or has stood since its step ended, does not move.
    moving = (passed > 0.0) & (tick <= old.start + old.ticks)
    speed = now - sample_keys(old, before, sizes.foot_m)
    speed /= np.where(moving, passed, np.inf)[:, None]

    # Feet as they are, which may be raised further than their curves say, and hips lower.
    legs = leg_poses(old, share, now, sizes)
    rows = np.arange(len(share))
    swing = np.where(footprints.on_right, 0, 1)
    now[:, ROOT] = legs.root - footprints.standing[:, PLACE]
    now[:, ANKLE] = legs.ankles[rows, swing] - footprints.landing[:, PLACE]
    now[:, SWING_PITCH] = legs.pitches[rows, swing]
    now[:, STANDING_PITCH] = legs.pitches[rows, 1 - swing]
    now[:, SWING_HEADING] = wrap_angle(legs.headings[rows, swing] - footprints.landing[:, HEADING])
    earlier = leg_poses(old, before, sample_keys(old, before, sizes.foot_m), sizes)
    moved = legs.ankles[rows, swing] - earlier.ankles[rows, swing]
    flies = moving & (old.flight > 0.0)
    moved /= np.where(flies, passed, np.inf)[:, None]
    speed[swapped, ANKLE] = moved[swapped]
    speed[swapped, SWING_HEADING] = 0.0
    speed[swapped, SWING_PITCH], speed[swapped, STANDING_PITCH] = (
        speed[swapped, STANDING_PITCH],
        speed[swapped, SWING_PITCH],
    )
    return CurrentPose(now, speed)


def step_keys(
    footprints: StepFootprints,
    elapsed: Floats,
    now: CurrentPose,
    ticks: Ints,
    hips: Floats,
    room_m: Floats,
) -> tuple[Floats, Floats, Floats]:
    """Keys of what is left of N steps, which begin with the current pose in value and speed.

    Parameters
    ----------
    footprints : of the steps
    elapsed : float64 (N,), in [0, 1)
        Share of each step that is over already: 0 for steps that begin.
    now : the current pose
    ticks : int64 (N,)
        How long the steps take from now on.
    hips : float64 (N, 2), metres
        Where the hips should be at the end.
    room_m : float64 (N,), metres
        How far the hips may be for that from where the footprints have them.

    Returns
    -------
    float64 (N, KEYS, WIDTH) keys, and float64 (N,) toe-offs and flights, as in `Steps`
    """
    targets = _targets(footprints, elapsed[:, None] + (1.0 - elapsed[:, None]) * _SHARES)
    keys = _keys(targets, footprints)
    aside = hips - footprints.standing[:, ON_MAP] - keys[:, -1, ROOT_ON_MAP]
    distance = np.maximum(np.hypot(aside[:, 0], aside[:, 1]), 1e-9)
    aside *= (np.minimum(distance, room_m) / distance)[:, None]
    from_air = targets.lift <= 0.0
    inertialise(keys, now.key, now.speed, elapsed > 0.0, from_air, ticks, aside)
    lift = np.clip((targets.lift - elapsed) / (1.0 - elapsed), 0.0, 1.0)
    return keys, lift, np.minimum(targets.flight / (1.0 - elapsed), 63.0 / 128.0)


def standing_keys(footprints: StepFootprints) -> Floats:
    """Keys, float64 (N, KEYS, WIDTH), of bodies that just stand on two footprints."""
    still = _keys(step_targets(footprints, np.zeros(1)), footprints)
    return np.repeat(still, KEYS, axis=1)


def weight_shift_keys(now: CurrentPose, footprints: StepFootprints, places: Floats) -> Floats:
    """Keys of bodies on both feet that shift their weight.

    Parameters
    ----------
    now : the current pose
    footprints : of both feet
    places : float64 (N, 2), metres
        Where the hips go.

    Returns
    -------
    float64 (N, KEYS, WIDTH)
    """
    keys = np.repeat(now.key[:, None], KEYS, axis=1)
    shift = places - footprints.standing[:, ON_MAP] - now.key[:, ROOT_ON_MAP]
    keys[..., ROOT_ON_MAP] += smooth(_SHARES)[None, :, None] * shift[:, None]
    keys[..., ANKLE] = 0.0
    return keys


def _targets(footprints: StepFootprints, share: Floats) -> Targets:
    """Targets at shares (N, K) of steps whose swing foot leaves a lower tread early.

    Otherwise that foot would hold the hips down, which then had to jump.
    """
    targets = step_targets(footprints, share)
    climbed = (footprints.standing[:, Z] - footprints.lifted[:, Z]) / footprints.leg_m
    rows = np.flatnonzero(climbed > _LEVEL)
    if not len(rows):
        return targets
    usual = targets.lift[rows, None]
    lift = usual * (1.0 - _EARLIER * smooth((climbed[rows, None] - _LEVEL) / (_STEEP - _LEVEL)))
    share = share[rows]
    swung = usual + (share - lift) * (1.0 - usual) / (1.0 - lift)
    some = StepFootprints._make(column[rows] for column in footprints)
    early = step_targets(some, np.where(share < lift, share * usual / lift, swung))
    targets.swing_ankle[rows] = early.swing_ankle
    targets.swing_pitch[rows] = early.swing_pitch
    targets.swing_heading[rows] = early.swing_heading
    targets.lift[rows] = lift[:, 0]
    return targets


def _keys(targets: Targets, footprints: StepFootprints) -> Floats:
    """Keys (N, K, WIDTH) of targets."""
    keys = np.empty((*targets.yaw.shape, WIDTH))
    fill_keys(targets, footprints, keys)
    return keys
