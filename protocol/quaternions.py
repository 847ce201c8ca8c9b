"""Rotations of a walking body as few angles. Quaternions are w, x, y, z in the last axis.

They have length 1. q and -q are the same rotation: what comes back may have the other sign.
"""

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def to_angles(quaternions: Floats) -> Floats:
    """Yaw, lean and roll (..., 3), radians, of rotations (..., 4).

    The rotation turns about the axis forward by roll, then about left by lean, then about up by
    yaw. Lean is within a quarter turn, the others within half a turn.
    """
    w, x, y, z = np.moveaxis(quaternions, -1, 0)
    return np.stack(
        [
            np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
            np.arcsin(np.clip(2.0 * (w * y - z * x), -1.0, 1.0)),
            np.arctan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
        ],
        axis=-1,
    )


def from_angles(angles: Floats) -> Floats:
    """The rotations (..., 4) of yaw, lean and roll (..., 3), radians."""
    cz, cy, cx = np.moveaxis(np.cos(0.5 * angles), -1, 0)
    sz, sy, sx = np.moveaxis(np.sin(0.5 * angles), -1, 0)
    return np.stack(
        [
            cz * cy * cx + sz * sy * sx,
            cz * cy * sx - sz * sy * cx,
            cz * sy * cx + sz * cy * sx,
            sz * cy * cx - cz * sy * sx,
        ],
        axis=-1,
    )


def to_twist(chests: Floats, roll: Floats) -> Floats:
    """The twist (...), radians, nearest to chests (..., 4) on pelvises with that roll (...)."""
    w, x, y, z = np.moveaxis(chests, -1, 0)
    c, s = np.cos(0.5 * roll), np.sin(0.5 * roll)
    along, across = c * w - s * x, c * z + s * y
    sign = np.where(along < 0.0, -1.0, 1.0)
    twists: Floats = 2.0 * np.arctan2(sign * across, sign * along)
    return twists


def from_twist(twist: Floats, roll: Floats) -> Floats:
    """Rotations (..., 4) from pelvis to chest, which undo the roll (...) and twist the spine."""
    c, s = np.cos(0.5 * roll), np.sin(0.5 * roll)
    ct, st = np.cos(0.5 * twist), np.sin(0.5 * twist)
    return np.stack([c * ct, -(s * ct), s * st, c * st], axis=-1)
