"""How the legs of a body in a step stand: feet on their footprints, hips within reach of them."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from actors.locomotion.motion import (
    ANKLE,
    PELVIS,
    ROOT,
    SETTLE,
    STANDING_PITCH,
    SWING_HEADING,
    SWING_PITCH,
    Floats,
    Steps,
    heel_from_toe,
    smooth,
    standing_ankles,
)
from actors.locomotion.rotations import rotate
from actors.locomotion.skeleton import FOOT, HEAD_TOP, HIP_DEPTH, TRACK_HALF_WIDTH

REACH: Final = 0.9995
"""A leg is not stretched further: knees that lock straighten with a jerk."""
STATURE: Final = 1.0 + HIP_DEPTH + HEAD_TOP
"""Of a body whose trunk fits its legs, in leg lengths."""

_STEEPEST_RAD: Final = -1.3
"""A heel is raised no further on its toe."""
_EASE_RAD: Final = 0.1
"""A foot on the ground with its heel up by as much rises on its toe where the leg is short."""


class Build(NamedTuple):
    """Sizes of N bodies, metres."""

    leg_m: Floats
    """(N,): from hip joint to ankle, the leg straight."""
    stature_m: Floats
    """(N,): from the ground to the top of the head."""

    def take(self, rows: NDArray[np.int64]) -> Build:
        """Some of the bodies."""
        return Build(self.leg_m[rows], self.stature_m[rows])

    @property
    def foot_m(self) -> Floats:
        """(N,): from heel to toe."""
        return self.leg_m * FOOT

    @property
    def trunk_m(self) -> Floats:
        """(N,): what lengths of the trunk and of arms are shares of."""
        return (self.stature_m - self.leg_m) / (STATURE - 1.0)


class Legs(NamedTuple):
    """Legs of N bodies in the world but for the knees; left, right."""

    root: Floats
    """(N, 3): hip centre."""
    hips: Floats
    """(N, 2, 3)."""
    ankles: Floats
    """(N, 2, 3)."""
    pitches: Floats
    """(N, 2): of the feet, radians, toe up positive."""
    headings: Floats
    """(N, 2): of the feet, radians from +x."""


def stance(steps: Steps, u: Floats, key: Floats, build: Build) -> Legs:
    """The legs of N steps at shares u (N,), where `under_way` has given keys (N, WIDTH)."""
    root = steps.standing[:, :3] + key[:, ROOT]
    ankles, pitches, headings, raised = _feet(steps, u, key, build)
    hips = root[:, None] + rotate(
        key[:, None, PELVIS],
        both_sides(TRACK_HALF_WIDTH * build.leg_m, np.zeros_like(build.leg_m)),
    )
    _raise_heels(hips, ankles, pitches, headings, raised, build)
    root, hips = _lower(root, hips, ankles, build)
    return Legs(root, hips, ankles, pitches, headings)


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
    on_toe = np.where(steps.lift > 0.0, 1.0 - smooth((u - steps.lift) / SETTLE), 0.0)
    raised[rows, 1 - right] = on_toe * smooth(-key[:, SWING_PITCH] / _EASE_RAD)
    return ankles, pitches, headings, raised


def heels_from_toes(pitches: Floats, headings: Floats, foot_m: Floats) -> Floats:
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


def both_sides(half_m: Floats, up_m: Floats) -> Floats:
    """Points to the left and right of N bodies' middle, in their axes: (N, 2, 3)."""
    out = np.zeros((len(half_m), 2, 3))
    out[:, 0, 1], out[:, 1, 1] = half_m, -half_m
    out[:, :, 2] = up_m[:, None]
    return out
