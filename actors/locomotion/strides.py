"""Keys of steps between footprints, which go on smoothly from what is drawn now."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion._stride_kernels import fill_keys, go_on
from esplanade.actors.locomotion.footfalls import Footfalls, Targets
from esplanade.actors.locomotion.motion import (
    ANKLE,
    KEYS,
    ROOT,
    STANDING_PITCH,
    SWING_HEADING,
    SWING_PITCH,
    WIDTH,
    Floats,
    Steps,
    smooth,
    under_way,
)
from esplanade.actors.locomotion.planted import step_targets
from esplanade.actors.locomotion.stance import Build, stance

_SHARES: Final = np.linspace(0.0, 1.0, KEYS)
_LEVEL: Final = 0.15
_STEEP: Final = 0.35
_EARLIER: Final = 0.7
"""A foot that has been left behind so far below, in legs, lifts by so much earlier."""
_BACK: Final = 0.02
"""Share of a step over which the speed of what is drawn is taken."""


class Drawn(NamedTuple):
    """What is drawn of N bodies at one moment, in the terms of the steps that they begin."""

    key: Floats
    """(N, WIDTH)."""
    speed: Floats
    """(N, WIDTH): its change in a tick."""


def wrapped(angle: Floats) -> Floats:
    """The same angles within half a turn of 0."""
    return np.asarray((angle + np.pi) % (2.0 * np.pi) - np.pi)


def drawn(
    old: Steps, tick: int, falls: Footfalls, swapped: NDArray[np.bool_], build: Build
) -> Drawn:
    """What is drawn of steps at a tick, as keys of the next ones.

    Swapped are those whose swinging foot has landed and stands now; the others' goes on.
    """
    share = old.share(tick)
    now = under_way(old, share, build.foot_m)
    before = np.maximum(share - _BACK, 0.0)
    passed = (share - before) * old.ticks
    # Who stands, or has stood since a step ended, does not move.
    moving = (passed > 0.0) & (tick <= old.start + old.ticks)
    speed = now - under_way(old, before, build.foot_m)
    speed /= np.where(moving, passed, np.inf)[:, None]

    # Feet as they are, which may be raised further than their curves say, and hips lower.
    legs = stance(old, share, now, build)
    rows = np.arange(len(share))
    swing = np.where(falls.right, 0, 1)
    now[:, ROOT] = legs.root - falls.standing[:, :3]
    now[:, ANKLE] = legs.ankles[rows, swing] - falls.landing[:, :3]
    now[:, SWING_PITCH] = legs.pitches[rows, swing]
    now[:, STANDING_PITCH] = legs.pitches[rows, 1 - swing]
    now[:, SWING_HEADING] = wrapped(legs.headings[rows, swing] - falls.landing[:, 3])
    speed[swapped, ANKLE] = 0.0
    speed[swapped, SWING_HEADING] = 0.0
    speed[swapped, SWING_PITCH], speed[swapped, STANDING_PITCH] = (
        speed[swapped, STANDING_PITCH],
        speed[swapped, SWING_PITCH],
    )
    return Drawn(now, speed)


def strides(
    falls: Footfalls,
    gone: Floats,
    now: Drawn,
    ticks: NDArray[np.int64],
    place: Floats,
    room_m: Floats,
) -> tuple[Floats, Floats]:
    """Keys of what is left of N steps after the share gone (N,) of them.

    Parameters
    ----------
    falls : the steps' footprints
    gone : (N,), 0 for steps that begin
    now : what is drawn, which they begin with, in value and speed
    ticks : (N,), how long they take from now on
    place : (N, 2), metres: where the hips should be in the end
    room_m : (N,): how far from between the feet they may be for that

    Returns
    -------
    float64 (N, KEYS, WIDTH) keys and (N,) lifts, as in `Steps`.
    """
    targets = _targets(falls, gone[:, None] + (1.0 - gone[:, None]) * _SHARES)
    keys = _keys(targets, falls)
    aside = place - falls.standing[:, :2] - keys[:, -1, :2]
    distance = np.maximum(np.hypot(aside[:, 0], aside[:, 1]), 1e-9)
    aside *= (np.minimum(distance, room_m) / distance)[:, None]
    go_on(keys, now.key, now.speed, gone > 0.0, ticks, aside)
    lift = np.clip((targets.lift - gone) / (1.0 - gone), 0.0, 1.0)
    return keys, lift


def standing_keys(falls: Footfalls) -> Floats:
    """Keys (N, KEYS, WIDTH) of bodies that just stand on two footprints."""
    still = _keys(step_targets(falls, np.zeros(1)), falls)
    return np.repeat(still, KEYS, axis=1)


def _targets(falls: Footfalls, share: Floats) -> Targets:
    """Targets at shares (N, K), of steps whose foot leaves a lower tread earlier than on the level.

    It would hold the hips down, which then had to jump.
    """
    targets = step_targets(falls, share)
    climbed = (falls.standing[:, 2] - falls.lifted[:, 2]) / falls.leg_m
    rows = np.flatnonzero(climbed > _LEVEL)
    if not len(rows):
        return targets
    usual = targets.lift[rows, None]
    lift = usual * (1.0 - _EARLIER * smooth((climbed[rows, None] - _LEVEL) / (_STEEP - _LEVEL)))
    share = share[rows]
    swung = usual + (share - lift) * (1.0 - usual) / (1.0 - lift)
    some = Footfalls._make(column[rows] for column in falls)
    early = step_targets(some, np.where(share < lift, share * usual / lift, swung))
    targets.swing_ankle[rows] = early.swing_ankle
    targets.swing_pitch[rows] = early.swing_pitch
    targets.swing_heading[rows] = early.swing_heading
    targets.lift[rows] = lift[:, 0]
    return targets


def shifted(now: Drawn, falls: Footfalls, places: Floats) -> Floats:
    """Keys of bodies on both feet whose hips move over places (N, 2) from where they are drawn."""
    keys = np.repeat(now.key[:, None], KEYS, axis=1)
    shift = places - falls.standing[:, :2] - now.key[:, :2]
    keys[..., :2] += smooth(_SHARES)[None, :, None] * shift[:, None]
    keys[..., ANKLE] = 0.0
    return keys


def _keys(targets: Targets, falls: Footfalls) -> Floats:
    """Keys (N, K, WIDTH) of targets."""
    keys = np.empty((*targets.yaw.shape, WIDTH))
    fill_keys(targets, falls, keys)
    return keys
