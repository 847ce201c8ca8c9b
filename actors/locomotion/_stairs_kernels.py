"""Steps between footprints of different height: where the hips are, and how a foot gets over.

Lengths are shares of the leg's; heights are those of footprints.
"""

from __future__ import annotations

from esplanade.actors.locomotion._gait_kernels import mix, smooth
from esplanade.actors.locomotion.skeleton import FOOT
from esplanade.planning.compiled.jit import inlined

CLEARANCE = 0.09
"""A foot passes so far over the highest of the three footprints."""

_LEVEL_BELOW = 0.08
_HIGHEST_HEEL = 0.92 * FOOT


@inlined
def unevenness(rise: float) -> float:
    """How far a rise calls for stairs rather than the level gait: 0 to 1."""
    return smooth(abs(rise) / _LEVEL_BELOW)


@inlined
def ground_height(rear: float, front: float) -> float:
    """What stands for level ground when both feet are down.

    Going up, the middle between both feet; going down, a little above the lower one.
    """
    rise = front - rear
    return rear + 0.5 * rise if rise > 0.0 else front - 0.15 * rise


@inlined
def heel_height(raised: float, ground: float, rear: float) -> float:
    """Height of the rear heel above its footprint: raised as on the level, more when going up."""
    return min(raised + max(ground - rear, 0.0), _HIGHEST_HEEL)


@inlined
def ground_under_way(before: float, after: float, u: float) -> float:
    """Ground height during a step: the body rises or sinks only once it comes over its foot."""
    return mix(before, after, smooth((u - 0.3) / 0.7))


@inlined
def swing_over(
    pinned: tuple[float, float, float],
    landing: tuple[float, float, float, float],
    top: float,
    x: float,
) -> tuple[float, float, float]:
    """Ankle of a foot that goes up, over and down, and passes every edge between the footprints.

    pinned is where the ankle would be if the toe stayed down, top the height of the highest
    footprint, x the share of the swing. Going up the foot is over the next tread before it moves
    ahead; going down it is past the edge of the tread that the other foot stands on before it
    sinks.
    """
    down = smooth((top - landing[2]) / _LEVEL_BELOW)
    off, arrived = 0.3 - 0.2 * down, 0.97 - 0.2 * down
    over = smooth((x - off) / (arrived - off))
    height = mix(pinned[2], top + CLEARANCE, smooth(x / 0.34))
    height = mix(height, landing[2], smooth((x - 0.55) / 0.45))
    return mix(pinned[0], landing[0], over), mix(pinned[1], landing[1], over), height
