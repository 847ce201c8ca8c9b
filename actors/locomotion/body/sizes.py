"""Sizes of many bodies at once."""

from __future__ import annotations

from typing import Final, NamedTuple

from esplanade.actors.locomotion.body.skeleton import FOOT, HEAD_TOP, HIP_DEPTH
from esplanade.planning.compiled.arrays import Floats, Ints

STATURE: Final = 1.0 + HIP_DEPTH + HEAD_TOP
"""Stature of a body whose trunk fits its legs, in leg lengths."""


class BodySizes(NamedTuple):
    """Sizes of N bodies, metres. `WalkerTraits` has those of one avatar."""

    leg_m: Floats
    """(N,): from the hip joint to the ankle of a straight leg."""
    stature_m: Floats
    """(N,): from the ground to the top of the head."""

    def take(self, rows: Ints) -> BodySizes:
        """The sizes of some of the bodies."""
        return BodySizes(self.leg_m[rows], self.stature_m[rows])

    @property
    def foot_m(self) -> Floats:
        """(N,): from heel to toe."""
        return self.leg_m * FOOT

    @property
    def trunk_m(self) -> Floats:
        """(N,): the scale of the trunk, of which lengths of trunk and arms are shares."""
        return (self.stature_m - self.leg_m) / (STATURE - 1.0)
