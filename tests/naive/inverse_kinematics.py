"""Twin of `esplanade.actors.locomotion._hinge_kernels`: CCD by quaternions over all the chain."""

import math

import numpy as np

from esplanade.actors.locomotion.reference import rotations


def hinges_and_tip(chain, angles):
    """World axes (J, 3) and places (J, 3) of the hinges, and the effector."""
    turned, at = rotations.IDENTITY, np.zeros(3)
    axes, places = [], []
    for axis, offset, angle in zip(chain.axes, chain.offsets, angles, strict=True):
        axes.append(rotations.rotate(turned, axis))
        places.append(at)
        turned = rotations.multiply(turned, rotations.about(axis, angle))
        at = at + rotations.rotate(turned, offset)
    return np.array(axes), np.array(places), at


def ccd(chain, start, target, tolerance, sweeps):
    """Angles after so many sweeps from the outermost hinge inwards, and how many were turned."""
    angles = np.array(start, dtype=float)
    turned = 0
    for _ in range(sweeps):
        for k in reversed(range(len(angles))):
            axes, places, tip = hinges_and_tip(chain, angles)
            if np.linalg.norm(target - tip) <= tolerance:
                return angles, turned
            a, v, t = axes[k], tip - places[k], target - places[k]
            change = math.atan2(a @ np.cross(v, t), v @ t - (a @ v) * (a @ t))
            angles[k] = np.clip(angles[k] + change, chain.lows[k], chain.highs[k])
            turned += 1
    return angles, turned
