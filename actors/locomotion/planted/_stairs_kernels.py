"""Steps between footprints of different height: where the hips are, and how a foot gets over.

Lengths are shares of the leg's.
"""

from __future__ import annotations

from esplanade.actors.locomotion.body.skeleton import FOOT
from esplanade.actors.locomotion.gait._curve_kernels import mix, smooth
from esplanade.actors.locomotion.planted.footprints import Footprint
from esplanade.planning.compiled.jit import inlined

CLEARANCE = 0.09
"""Height of the swing foot over the highest of the three footprints as it passes."""

_LEVEL_BELOW = 0.08
"""From this rise on a step is walked wholly as on stairs."""
_HIGHEST_HEEL = 0.92 * FOOT


@inlined
def unevenness(rise: float) -> float:
    """Weight of the gait on stairs against the level one, 0 to 1, for a rise between footprints."""
    return smooth(abs(rise) / _LEVEL_BELOW)


@inlined
def ground_height(rear: float, front: float) -> float:
    """Height that stands for level ground in double support.

    Upstairs it is midway between both feet, downstairs a little above the lower one.
    """
    rise = front - rear
    return rear + 0.5 * rise if rise > 0.0 else front - 0.15 * rise


@inlined
def heel_height(raised: float, ground: float, rear: float) -> float:
    """Height of the rear heel above its footprint: as on level ground, and more when going up."""
    return min(raised + max(ground - rear, 0.0), _HIGHEST_HEEL)


@inlined
def ground_during_step(before: float, after: float, u: float) -> float:
    """Height of the ground at share u: the body rises or sinks only once it is over its foot."""
    return mix(before, after, smooth((u - 0.3) / 0.7))


@inlined
def swing_over(
    pinned: tuple[float, float, float],
    landing: Footprint,
    top: float,
    x: float,
) -> tuple[float, float, float]:
    """Ankle of a swing foot that goes up, over and down, clear of every edge between footprints.

    `pinned` is the ankle as if the toe stayed down, `top` the height of the highest footprint, and
    `x` the share of the swing. Upstairs the foot is over the next tread before it moves ahead.
    Downstairs it is past the edge of the tread that the other foot stands on before it sinks.
    """
    down = smooth((top - landing.z) / _LEVEL_BELOW)
    off, arrived = 0.3 - 0.2 * down, 0.97 - 0.2 * down
    over = smooth((x - off) / (arrived - off))
    height = mix(pinned[2], top + CLEARANCE, smooth(x / 0.34))
    height = mix(height, landing.z, smooth((x - 0.55) / 0.45))
    return mix(pinned[0], landing.x, over), mix(pinned[1], landing.y, over), height
