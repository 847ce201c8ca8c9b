"""Steps between footprints of different height: where the hips are, and how a foot gets over.

Lengths are shares of the leg's; heights are those of footprints.
"""

import numpy as np

from esplanade.actors.locomotion.body.skeleton import FOOT
from esplanade.actors.locomotion.gait.curves import smooth
from esplanade.planning.compiled.arrays import Floats

CLEARANCE = 0.09
"""Height of the swing foot over the highest of the three footprints as it passes."""

_LEVEL_BELOW = 0.08
_HIGHEST_HEEL = 0.92 * FOOT


def unevenness(rise: Floats) -> Floats:
    """Weight of the gait on stairs against the level one, 0 to 1, for a rise between footprints."""
    return smooth(np.abs(rise) / _LEVEL_BELOW)


def ground_height(rear: Floats, front: Floats) -> Floats:
    """Height that stands for level ground in double support.

    Upstairs it is midway between both feet, downstairs a little above the lower one.
    """
    rise = front - rear
    height: Floats = np.where(rise > 0.0, rear + 0.5 * rise, front - 0.15 * rise)
    return height


def heel_height(raised: Floats, ground: Floats, rear: Floats) -> Floats:
    """Height of the rear heel above its footprint: as on level ground, and more when going up."""
    return np.minimum(raised + np.maximum(ground - rear, 0.0), _HIGHEST_HEEL)


def ground_during_step(before: Floats, after: Floats, u: Floats) -> Floats:
    """Ground height during a step: the body rises or sinks only once it comes over its foot."""
    height: Floats = before + (after - before) * smooth((u - 0.3) / 0.7)
    return height


def swing_over(pinned: Floats, landing: Floats, top: Floats, x: Floats) -> Floats:
    """Ankle of a foot that goes up, over and down, and passes every edge between the footprints.

    Going up it is over the next tread before it moves ahead; going down it is past the edge of
    the tread that the other foot stands on before it sinks.

    Parameters
    ----------
    pinned : float64 (..., 3)
        Where the ankle would be if the toe stayed on the ground.
    landing : float64 (..., 3)
    top : float64 (...,)
        Height of the highest footprint.
    x : float64 (...,), in [0, 1]
        Share of the swing.
    """
    down = smooth((top - landing[..., 2]) / _LEVEL_BELOW)
    off, arrived = 0.3 - 0.2 * down, 0.97 - 0.2 * down
    over = smooth((x - off) / (arrived - off))[..., None]
    level = pinned[..., :2] + (landing[..., :2] - pinned[..., :2]) * over
    height = pinned[..., 2] + (top + CLEARANCE - pinned[..., 2]) * smooth(x / 0.34)
    height = height + (landing[..., 2] - height) * smooth((x - 0.55) / 0.45)
    return np.concatenate([level, height[..., None]], axis=-1)
