"""From a step to the joints of a body that is taking it: what a client draws, once more here.

All of it is closed form in what a step holds; nothing depends on the frame before. The client does
the same in `client_web/src/world/steps.ts`, and shared vectors hold both together.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from actors.locomotion.motion import (
    ANKLE,
    CHEST,
    ELBOWS,
    PELVIS,
    ROOT,
    SETTLE,
    SHOULDERS,
    STANDING_PITCH,
    SWING_HEADING,
    SWING_PITCH,
    Floats,
    Steps,
    heel_from_toe,
    smooth,
    standing_ankles,
    under_way,
)
from actors.locomotion.rotations import multiply, normalise, rotate
from actors.locomotion.skeleton import (
    FOOT,
    HEAD_TOP,
    HIP_DEPTH,
    SHIN,
    THIGH,
    TRACK_HALF_WIDTH,
)

REACH: Final = 0.9995
"""A leg is not stretched further: knees that lock straighten with a jerk."""

# Shoulders and arms of measured people (Drillis & Contini), in shares of the trunk's scale: those
# of the gait's source are broad, high and long.
SHOULDER_UP: Final = 0.35
"""Above where the spine bends, along the chest."""
SHOULDER_ASIDE: Final = 0.215
UPPER_ARM: Final = 0.345
FOREARM: Final = 0.27
ARMS_OUT: Final = 0.12
"""Arms hang so far from the body, radians."""
STATURE: Final = 1.0 + HIP_DEPTH + HEAD_TOP
"""Of a body whose trunk fits its legs, in leg lengths."""

_STEEPEST_RAD: Final = -1.3
"""A heel is raised no further on its toe."""
_EASE_RAD: Final = 0.1
"""A standing foot whose pitch is so much below level rises on its toe where the leg is short."""


class Build(NamedTuple):
    """Sizes of N bodies, metres."""

    leg_m: Floats
    """(N,): from hip joint to ankle, the leg straight."""
    stature_m: Floats
    """(N,): from the ground to the top of the head."""

    @property
    def foot_m(self) -> Floats:
        """(N,): from heel to toe."""
        return self.leg_m * FOOT

    @property
    def trunk_m(self) -> Floats:
        """(N,): what lengths of the trunk and of arms are shares of."""
        return (self.stature_m - self.leg_m) / (STATURE - 1.0)


class Pose(NamedTuple):
    """Joints of N bodies in the world, metres. A pair of limbs is left, right."""

    root: Floats
    """(N, 3): hip centre."""
    pelvis: Floats
    """(N, 4): quaternion."""
    chest: Floats
    """(N, 4): quaternion, in the world."""
    hips: Floats
    """(N, 2, 3)."""
    knees: Floats
    """(N, 2, 3)."""
    ankles: Floats
    """(N, 2, 3): also the heels."""
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


def pose(steps: Steps, u: Floats, build: Build) -> Pose:
    """N bodies at shares u (N,) of their steps."""
    key = under_way(steps, u, build.foot_m)
    root = steps.standing[:, :3] + key[:, ROOT]
    pelvis = key[:, PELVIS]
    ankles, pitches, headings, raised = _feet(steps, u, key, build)
    hips = root[:, None] + rotate(
        pelvis[:, None], _aside(TRACK_HALF_WIDTH * build.leg_m, np.zeros_like(build.leg_m))
    )
    _raise_heels(hips, ankles, pitches, headings, raised, build)
    root, hips = _lower(root, hips, ankles, build)
    chest = multiply(pelvis, key[:, CHEST])
    knees = _knees(hips, ankles, _facing(pelvis), headings, build)
    return Pose(
        root,
        pelvis,
        chest,
        hips,
        knees,
        ankles,
        ankles - _heels_from_toes(pitches, headings, build.foot_m),
        pitches,
        headings,
        *_upper_body(root, pelvis, chest, key, build),
    )


def _feet(
    steps: Steps, u: Floats, key: Floats, build: Build
) -> tuple[Floats, Floats, Floats, Floats]:
    """Ankles (N, 2, 3), pitches, headings (N, 2), and how far each stands on its toe (N, 2)."""
    standing = standing_ankles(steps.standing, key[:, STANDING_PITCH], build.foot_m)
    swinging = steps.landing[:, :3] + key[:, ANKLE]
    right = steps.right.astype(np.int64)
    rows = np.arange(len(right))
    ankles = np.empty((len(right), 2, 3))
    ankles[rows, right], ankles[rows, 1 - right] = standing, swinging
    pitches, headings, raised = (np.empty((len(right), 2)) for _ in range(3))
    pitches[rows, right], pitches[rows, 1 - right] = key[:, STANDING_PITCH], key[:, SWING_PITCH]
    headings[rows, right] = steps.standing[:, 3]
    headings[rows, 1 - right] = steps.landing[:, 3] + key[:, SWING_HEADING]
    raised[rows, right] = smooth(-key[:, STANDING_PITCH] / _EASE_RAD)
    on_toe = 1.0 - smooth((u - steps.lift) / SETTLE)
    raised[rows, 1 - right] = np.where(steps.lift > 0.0, on_toe, 0.0)
    return ankles, pitches, headings, raised


def _heels_from_toes(pitches: Floats, headings: Floats, foot_m: Floats) -> Floats:
    count = len(pitches)
    feet = heel_from_toe(pitches.ravel(), headings.ravel(), np.repeat(foot_m, 2))
    return feet.reshape(count, 2, 3)


def _raise_heels(
    hips: Floats,
    ankles: Floats,
    pitches: Floats,
    headings: Floats,
    raised: Floats,
    build: Build,
) -> None:
    """Where a leg is too short for a foot on its toe, turn the foot about the toe; in place."""
    reach = REACH * build.leg_m[:, None]
    short = (np.linalg.norm(ankles - hips, axis=2) > reach) & (raised > 0.0)
    if not short.any():
        return
    foot = np.broadcast_to(build.foot_m[:, None], short.shape)[short]
    reach = np.broadcast_to(reach, short.shape)[short]
    pitch, heading = pitches[short], headings[short]
    toe = ankles[short] - heel_from_toe(pitch, heading, foot)
    hip = hips[short] - toe
    along = hip[:, 0] * np.cos(heading) + hip[:, 1] * np.sin(heading)
    # The heel is at -foot (cos p, sin p): as far from the hip as the leg reaches.
    cosine = (reach**2 - np.einsum("nd,nd->n", hip, hip) - foot**2) / (
        2.0 * foot * np.hypot(along, hip[:, 2])
    )
    steeper = np.arctan2(hip[:, 2], along) - np.arccos(np.clip(cosine, -1.0, 1.0))
    steeper = np.minimum(np.maximum(steeper, _STEEPEST_RAD), pitch)
    pitch = pitch + raised[short] * (steeper - pitch)
    pitches[short] = pitch
    ankles[short] = toe + heel_from_toe(pitch, heading, foot)


def _lower(root: Floats, hips: Floats, ankles: Floats, build: Build) -> tuple[Floats, Floats]:
    """Bring the hips down until both legs reach their feet."""
    legs = hips - ankles
    reach = REACH * build.leg_m[:, None]
    level2 = np.minimum(legs[..., 0] ** 2 + legs[..., 1] ** 2, reach**2)
    drop = np.maximum(legs[..., 2] - np.sqrt(reach**2 - level2), 0.0).max(axis=1)
    down = np.zeros_like(root)
    down[:, 2] = -drop
    return root + down, hips + down[:, None]


def _facing(q: Floats) -> Floats:
    """Where the forward axis of rotations (N, 4) points on the map, (N, 2), unit."""
    w, x, y, z = q.T
    forward = np.stack([1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z)], axis=1)
    return normalise(forward)


def _knees(hips: Floats, ankles: Floats, facing: Floats, headings: Floats, build: Build) -> Floats:
    """Knees (N, 2, 3) by the cosine law, bent forward: midway between pelvis and foot."""
    leg_m = build.leg_m[:, None]
    line = ankles - hips
    distance = np.maximum(np.linalg.norm(line, axis=2), 1e-9 * leg_m)
    line = line / distance[..., None]
    distance = np.minimum(distance, REACH * leg_m)
    along = (distance**2 + (THIGH**2 - SHIN**2) * leg_m**2) / (2.0 * distance)
    aside = np.sqrt(np.maximum((THIGH * leg_m) ** 2 - along**2, 0.0))
    forward = np.zeros_like(line)
    forward[..., 0] = facing[:, None, 0] + np.cos(headings)
    forward[..., 1] = facing[:, None, 1] + np.sin(headings)
    forward -= np.einsum("nsd,nsd->ns", forward, line)[..., None] * line
    return np.asarray(hips + along[..., None] * line + aside[..., None] * normalise(forward))


def _aside(half_m: Floats, up_m: Floats) -> Floats:
    """Points to the left and right of N bodies' middle, in their axes: (N, 2, 3)."""
    out = np.zeros((len(half_m), 2, 3))
    out[:, 0, 1], out[:, 1, 1] = half_m, -half_m
    out[:, :, 2] = up_m[:, None]
    return out


def _upper_body(
    root: Floats, pelvis: Floats, chest: Floats, key: Floats, build: Build
) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
    """Lumbar, neck, head (N, 3), shoulders, elbows, hands (N, 2, 3)."""
    size = build.trunk_m
    up = np.zeros_like(root)
    up[:, 2] = size
    lumbar = root + rotate(pelvis, HIP_DEPTH * up)
    shoulders = lumbar[:, None] + rotate(
        chest[:, None], _aside(SHOULDER_ASIDE * size, SHOULDER_UP * size)
    )
    flexed = key[:, SHOULDERS]
    upper = rotate(chest[:, None], _arm(flexed))
    fore = rotate(chest[:, None], _arm(flexed + key[:, ELBOWS]))
    elbows = shoulders + UPPER_ARM * size[:, None, None] * upper
    hands = elbows + FOREARM * size[:, None, None] * fore
    return (
        lumbar,
        lumbar + rotate(chest, SHOULDER_UP * up),
        lumbar + rotate(chest, HEAD_TOP * up),
        shoulders,
        elbows,
        hands,
    )


def _arm(flexion: Floats) -> Floats:
    """Directions (N, 2, 3) of arms flexed so, in the chest's axes: hanging a little outwards."""
    out = np.empty((*flexion.shape, 3))
    out[..., 0] = np.sin(flexion)
    out[..., 1] = np.array([np.sin(ARMS_OUT), -np.sin(ARMS_OUT)]) * np.cos(flexion)
    out[..., 2] = -np.cos(ARMS_OUT) * np.cos(flexion)
    return out
