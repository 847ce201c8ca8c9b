"""The social force model of people who react: its parameters, where they come from, and units."""

import math
from dataclasses import dataclass, fields
from typing import Final

from esplanade.pedestrians.compiled.records import Numbers

LIMITS: Final = {
    "relaxation_s": (0.1, 5.0),
    "return_s": (0.1, 60.0),
    "hurry": (1.0, 2.0),
    "usual_speed_mps": (0.1, 3.0),
    "strength_mps2": (0.0, 100.0),
    "strength_spread": (0.0, 1.0),
    "velocity_share_s": (0.0, 10.0),
    "reach_m": (0.01, 5.0),
    "slowing": (0.0, 50.0),
    "turning": (0.0, 50.0),
    "side_bias": (-0.5, 0.5),
    "sight_deg": (1.0, 360.0),
    "unseen": (0.0, 1.0),
    "range_m": (1.0, 30.0),
    "wall_strength_mps2": (0.0, 100.0),
    "wall_reach_m": (0.01, 2.0),
    "wall_margin_m": (0.001, 0.5),
}
"""The least and the greatest value of each parameter."""
WALL_RANGE: Final = 10.0
"""Walls farther than this many times their reach push nobody."""


@dataclass(frozen=True)
class SocialForce:
    """A model of how people evade others and walls; by default as was measured on people.

    Notes
    -----
    Evasion is the interaction of M. Moussaïd, D. Helbing, S. Garnier, A. Johansson, M. Combe and
    G. Theraulaz, *Experimental study of the behavioural mechanisms underlying self-organization in
    human crowds*, Proc. R. Soc. B 276 (2009), 2755-2762. Its A, λ, γ, n, n', ε and τ were fitted
    to people who evaded a standing and an oncoming person; its walls are a exp(-d/b).
    The drive (v0 - v) / τ, sight, and the greatest speed of 1.3 times the wanted one are those of
    D. Helbing and P. Molnár, *Social force model for pedestrian dynamics*, Phys. Rev. E 51 (1995),
    4282-4286.

    Our departure: instead of the goal alone, a person wants the recorded path and its timing; and
    a force acts only as far as it is not in the recording already (`ReactingCrowd`).

    Raises
    ------
    ValueError
        A value is out of range (`LIMITS`).
    """

    relaxation_s: float = 0.54
    """τ: a velocity becomes the wanted one in about this time, seconds."""
    return_s: float = 2.0
    """Time within which a person who was driven off the recorded path wants to be back, seconds.
    Ours: about four times τ, the quickest return that does not overshoot."""
    hurry: float = 1.3
    """Greatest speed of somebody who is late, in recorded speeds; evading, nobody is faster than
    this many times the recorded or the usual speed, whichever is higher."""
    usual_speed_mps: float = 1.29
    """Speed of walking, m/s; it limits how fast somebody who was recorded standing evades."""
    strength_mps2: float = 4.5
    """A: the strength of evasion, m/s²."""
    strength_spread: float = 0.3 / 4.5
    """The standard deviation of A among people, as a part of it; drawn by the seed."""
    velocity_share_s: float = 2.0
    """λ: what a relative velocity of 1 m/s counts against the direction to the other."""
    reach_m: float = 0.35
    """γ: an evasion fades over this distance times |D|, metres."""
    slowing: float = 3.0
    """n': the greater, the more nearly ahead another must be to make a person slow down, 1/m."""
    turning: float = 2.0
    """n: the same for turning aside, 1/m."""
    side_bias: float = 0.005
    """ε: who meets somebody exactly ahead evades to the right; negative means to the left, 1/m."""
    sight_deg: float = 200.0
    """Angle around the direction of walking that is seen, degrees."""
    unseen: float = 0.5
    """Weight of a body that is not seen; one that is seen counts 1."""
    range_m: float = 8.0
    """Bodies farther away than this are left out, metres. Ours, to bound the search."""
    wall_strength_mps2: float = 3.0
    """a: the push of a wall that is touched, m/s²."""
    wall_reach_m: float = 0.1
    """b: it fades over this distance, metres."""
    wall_margin_m: float = 0.05
    """Least distance to a wall ahead, metres. Ours: a push alone does not stop everyone."""

    def __post_init__(self) -> None:
        for field in fields(self):
            value, (low, high) = getattr(self, field.name), LIMITS[field.name]
            if not low <= value <= high:
                raise ValueError(f"{field.name}: {value} is not from {low:g} to {high:g}")

    def numbers(self, tick_s: float) -> Numbers:
        """The parameters as the kernels take them."""
        return Numbers(
            tick_s=tick_s,
            relaxation_s=self.relaxation_s,
            return_s=self.return_s,
            hurry=self.hurry,
            usual_speed_mps=self.usual_speed_mps,
            velocity_share_s=self.velocity_share_s,
            reach_m=self.reach_m,
            slowing_per_m=self.slowing,
            turning_per_m=self.turning,
            side_bias_per_m=self.side_bias,
            sight_cosine=math.cos(math.radians(0.5 * self.sight_deg)),
            unseen=self.unseen,
            range_m=self.range_m,
            wall_strength_mps2=self.wall_strength_mps2,
            wall_reach_m=self.wall_reach_m,
            wall_range_m=WALL_RANGE * self.wall_reach_m,
            wall_margin_m=self.wall_margin_m,
        )
