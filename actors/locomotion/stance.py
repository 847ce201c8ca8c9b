"""How the legs of a body in a step stand: feet on their footprints, hips within reach of them."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion import _stance_kernels as kernels
from esplanade.actors.locomotion.motion import Floats, Steps, heel_from_toe
from esplanade.actors.locomotion.skeleton import FOOT, HEAD_TOP, HIP_DEPTH

REACH: Final = kernels.REACH
"""A leg is not stretched further: knees that lock straighten with a jerk."""
STATURE: Final = 1.0 + HIP_DEPTH + HEAD_TOP
"""Of a body whose trunk fits its legs, in leg lengths."""


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
    """The legs of N steps at shares u (N,), where `under_way` has given keys (N, WIDTH).

    A standing foot is on its heel while its toe is up, else on its toe. Where a leg is too short,
    a foot that is on its toe raises its heel; then the hips come down until both feet are in reach.
    """
    count = len(u)
    legs = Legs(
        np.empty((count, 3)),
        np.empty((count, 2, 3)),
        np.empty((count, 2, 3)),
        np.empty((count, 2)),
        np.empty((count, 2)),
    )
    s = steps
    kernels.fill_stances(s.right, s.standing, s.landing, s.lift, u, key, build.leg_m, *legs)
    return legs


def heels_from_toes(pitches: Floats, headings: Floats, foot_m: Floats) -> Floats:
    count = len(pitches)
    feet = heel_from_toe(pitches.ravel(), headings.ravel(), np.repeat(foot_m, 2))
    return feet.reshape(count, 2, 3)


def both_sides(half_m: Floats, up_m: Floats) -> Floats:
    """Points to the left and right of N bodies' middle, in their axes: (N, 2, 3)."""
    out = np.zeros((len(half_m), 2, 3))
    out[:, 0, 1], out[:, 1, 1] = half_m, -half_m
    out[:, :, 2] = up_m[:, None]
    return out
