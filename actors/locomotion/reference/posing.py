"""The joints of a body that is taking a step, computed a second time as a client draws them.

All of it is a closed form of the fields of a step; nothing depends on the frame before. The client
does the same in `client_web/src/world/steps.ts` and `body.ts`; shared vectors hold both together.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion.body.sizes import BodySizes
from esplanade.actors.locomotion.body.skeleton import (
    ARMS_OUT_RAD,
    HANGING_ARMS,
    HEAD_TOP,
    HIP_DEPTH,
    SHIN,
    THIGH,
)
from esplanade.actors.locomotion.motion.key_poses import (
    CHEST,
    ELBOWS,
    PELVIS,
    SHOULDERS,
    Steps,
    heel_from_toe,
    sample_keys,
)
from esplanade.actors.locomotion.motion.leg_poses import REACH, LegPoses, leg_poses
from esplanade.actors.locomotion.reference.rotations import multiply, normalise, rotate
from esplanade.planning.compiled.arrays import Floats


class Pose(NamedTuple):
    """Joints of N bodies in the world, metres; pairs are left, right."""

    root: Floats
    """(N, 3): hip centre."""
    pelvis: Floats
    """(N, 4): quaternion, in the world."""
    chest: Floats
    """(N, 4): quaternion, in the world."""
    hips: Floats
    """(N, 2, 3)."""
    knees: Floats
    """(N, 2, 3)."""
    ankles: Floats
    """(N, 2, 3): ankles, which are the heels."""
    toes: Floats
    """(N, 2, 3)."""
    pitches: Floats
    """(N, 2): of the feet, radians, toe up positive."""
    headings: Floats
    """(N, 2): of the feet, radians from +x."""
    lumbar: Floats
    """(N, 3): where the spine bends."""
    neck: Floats
    """(N, 3): base of the neck."""
    head: Floats
    """(N, 3): top of the head."""
    shoulders: Floats
    """(N, 2, 3)."""
    elbows: Floats
    """(N, 2, 3)."""
    hands: Floats
    """(N, 2, 3)."""


def pose(steps: Steps, u: Floats, sizes: BodySizes) -> Pose:
    """Joints of N bodies at shares of their steps.

    Parameters
    ----------
    steps : N steps
    u : float64 (N,), shares, in [0, 1]
    sizes : of the N bodies

    Returns
    -------
    Pose of N bodies
    """
    key = sample_keys(steps, u, sizes.foot_m)
    legs = leg_poses(steps, u, key, sizes)
    pelvis = key[:, PELVIS]
    chest = multiply(pelvis, key[:, CHEST])
    return Pose(
        legs.root,
        pelvis,
        chest,
        legs.hips,
        _knees(legs, _facing(pelvis), sizes),
        legs.ankles,
        legs.ankles - _heels_from_toes(legs.pitches, legs.headings, sizes.foot_m),
        legs.pitches,
        legs.headings,
        *_upper_body(legs.root, pelvis, chest, key, sizes),
    )


def left_and_right(half_m: Floats, up_m: Floats) -> Floats:
    """Points to the left and the right of the middle of N bodies.

    Parameters
    ----------
    half_m : float64 (N,), metres
        Distance of both points from the middle.
    up_m : float64 (N,), metres
        Height of both points above it.

    Returns
    -------
    float64 (N, 2, 3), metres, in the axes forward, left, up of the bodies
    """
    out = np.zeros((len(half_m), 2, 3))
    out[:, 0, 1], out[:, 1, 1] = half_m, -half_m
    out[:, :, 2] = up_m[:, None]
    return out


def _heels_from_toes(pitches: Floats, headings: Floats, foot_m: Floats) -> Floats:
    """Vectors from the toes to the ankles of N pairs of feet, (N, 2, 3)."""
    count = len(pitches)
    feet = heel_from_toe(pitches.ravel(), headings.ravel(), np.repeat(foot_m, 2))
    return feet.reshape(count, 2, 3)


def _facing(q: Floats) -> Floats:
    """Unit vectors (N, 2) on the map where the forward axes of rotations (N, 4) point."""
    w, x, y, z = q.T
    forward = np.stack([1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z)], axis=1)
    return normalise(forward)


def _knees(legs: LegPoses, facing: Floats, sizes: BodySizes) -> Floats:
    """Knees (N, 2, 3) by the law of cosines, bent forward midway between pelvis and foot."""
    leg_m = sizes.leg_m[:, None]
    line = legs.ankles - legs.hips
    distance = np.maximum(np.linalg.norm(line, axis=2), 1e-9 * leg_m)
    line = line / distance[..., None]
    distance = np.minimum(distance, REACH * leg_m)
    along = (distance**2 + (THIGH**2 - SHIN**2) * leg_m**2) / (2.0 * distance)
    aside = np.sqrt(np.maximum((THIGH * leg_m) ** 2 - along**2, 0.0))
    forward = np.zeros_like(line)
    forward[..., 0] = facing[:, None, 0] + np.cos(legs.headings)
    forward[..., 1] = facing[:, None, 1] + np.sin(legs.headings)
    forward -= np.einsum("nsd,nsd->ns", forward, line)[..., None] * line
    return np.asarray(legs.hips + along[..., None] * line + aside[..., None] * normalise(forward))


def _upper_body(
    root: Floats, pelvis: Floats, chest: Floats, key: Floats, sizes: BodySizes
) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
    """Lumbar, neck, head (N, 3), shoulders, elbows, hands (N, 2, 3)."""
    size = sizes.trunk_m
    up = np.zeros_like(root)
    up[:, 2] = size
    lumbar = root + rotate(pelvis, HIP_DEPTH * up)
    shoulders = lumbar[:, None] + rotate(
        chest[:, None],
        left_and_right(HANGING_ARMS.shoulder_aside * size, HANGING_ARMS.shoulder_height * size),
    )
    flexed = key[:, SHOULDERS]
    upper = rotate(chest[:, None], _arm(flexed))
    fore = rotate(chest[:, None], _arm(flexed + key[:, ELBOWS]))
    elbows = shoulders + HANGING_ARMS.upper_arm * size[:, None, None] * upper
    hands = elbows + HANGING_ARMS.forearm * size[:, None, None] * fore
    return (
        lumbar,
        lumbar + rotate(chest, HANGING_ARMS.shoulder_height * up),
        lumbar + rotate(chest, HEAD_TOP * up),
        shoulders,
        elbows,
        hands,
    )


def _arm(flexion: Floats) -> Floats:
    """Directions (N, 2, 3) of arms, in the axes of the chest: they hang a little outwards."""
    out = np.empty((*flexion.shape, 3))
    out[..., 0] = np.sin(flexion)
    out[..., 1] = np.array([np.sin(ARMS_OUT_RAD), -np.sin(ARMS_OUT_RAD)]) * np.cos(flexion)
    out[..., 2] = -np.cos(ARMS_OUT_RAD) * np.cos(flexion)
    return out
