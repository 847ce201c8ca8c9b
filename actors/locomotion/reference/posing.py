"""From a step to the joints of a body that is taking it: what a client draws, once more here.

All of it is closed form in what a step holds; nothing depends on the frame before. The client does
the same in `client_web/src/world/steps.ts`, and shared vectors hold both together.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from esplanade.actors.locomotion.motion import (
    CHEST,
    ELBOWS,
    PELVIS,
    SHOULDERS,
    Floats,
    Steps,
    under_way,
)
from esplanade.actors.locomotion.reference.rotations import multiply, normalise, rotate
from esplanade.actors.locomotion.skeleton import HEAD_TOP, HIP_DEPTH, SHIN, THIGH
from esplanade.actors.locomotion.stance import (
    REACH,
    Build,
    Legs,
    both_sides,
    heels_from_toes,
    stance,
)

# Shoulders and arms of measured people (Drillis & Contini), in shares of the trunk's scale: those
# of the gait's source are broad, high and long.
SHOULDER_UP: Final = 0.35
"""Above where the spine bends, along the chest."""
SHOULDER_ASIDE: Final = 0.215
UPPER_ARM: Final = 0.345
FOREARM: Final = 0.27
ARMS_OUT: Final = 0.12
"""Arms hang so far from the body, radians."""


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
    legs = stance(steps, u, key, build)
    pelvis = key[:, PELVIS]
    chest = multiply(pelvis, key[:, CHEST])
    return Pose(
        legs.root,
        pelvis,
        chest,
        legs.hips,
        _knees(legs, _facing(pelvis), build),
        legs.ankles,
        legs.ankles - heels_from_toes(legs.pitches, legs.headings, build.foot_m),
        legs.pitches,
        legs.headings,
        *_upper_body(legs.root, pelvis, chest, key, build),
    )


def _facing(q: Floats) -> Floats:
    """Where the forward axis of rotations (N, 4) points on the map, (N, 2), unit."""
    w, x, y, z = q.T
    forward = np.stack([1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z)], axis=1)
    return normalise(forward)


def _knees(legs: Legs, facing: Floats, build: Build) -> Floats:
    """Knees (N, 2, 3) by the cosine law, bent forward: midway between pelvis and foot."""
    leg_m = build.leg_m[:, None]
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
    root: Floats, pelvis: Floats, chest: Floats, key: Floats, build: Build
) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
    """Lumbar, neck, head (N, 3), shoulders, elbows, hands (N, 2, 3)."""
    size = build.trunk_m
    up = np.zeros_like(root)
    up[:, 2] = size
    lumbar = root + rotate(pelvis, HIP_DEPTH * up)
    shoulders = lumbar[:, None] + rotate(
        chest[:, None], both_sides(SHOULDER_ASIDE * size, SHOULDER_UP * size)
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
