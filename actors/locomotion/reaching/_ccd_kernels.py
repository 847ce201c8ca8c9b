"""Inverse kinematics of a limb on a trunk, one target after the other.

Two solvers are here: cyclic coordinate descent (CCD) alone, and CCD of the trunk with the two bones
of the limb bent in closed form.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from esplanade.actors.locomotion.reaching._hinge_kernels import (
    ChainState,
    Hinges,
    Vector,
    ccd_sweep,
    clamped,
    distance_left,
    dot,
    new_state,
    place_hinges,
)
from esplanade.planning.compiled.arrays import Floats, Ints
from esplanade.planning.compiled.jit import kernel

LIMB = 4
"""Number of hinges of a limb: about Y, Z and X at its root, and about X at the knee or elbow."""
_YAWS = 8
"""Number of other turns of the limb about its Y axis that are tried when the present one breaks a
limit, from the nearest outwards."""
_PATIENCE = 2
"""Number of sweeps after which the distance left must have shrunk to `_SHRUNK`."""
_SHRUNK = 0.5
"""Share of the distance left; if more is left, the limits are in the way."""


class Effort(NamedTuple):
    """The limits at which a solver stops."""

    tolerance: float
    """Leg lengths between effector and target that count as reached."""
    sweeps: int
    """Largest number of sweeps over the hinges."""
    limb_sweeps: int
    """Number of hinges, the first ones, that are of the limb alone (CCD only)."""


@kernel
def _bent_at(
    hinges: Hinges, yaw: float, local: Vector
) -> tuple[float, tuple[float, float, float, float]]:
    """Distance between a target and the tip of a limb turned by a yaw, and the limb's best pose.

    `local` is the target in the frame of the limb's root. Chen et al. 2012, eqs. (2) to (4): the
    law of cosines gives the knee, and the direction of the target the two angles above it.
    """
    first = len(hinges.lows) - LIMB
    low, high = hinges.lows[first:], hinges.highs[first:]
    upper, lower = -hinges.offsets[first + 2, 1], -hinges.offsets[first + 3, 1]
    bends = hinges.axes[first + 3, 0]
    cosine = (dot(local, local) - upper * upper - lower * lower) / (2.0 * upper * lower)
    knee = clamped(math.acos(clamped(cosine, -1.0, 1.0)), low[3], high[3])
    along, behind = upper + lower * math.cos(knee), bends * lower * math.sin(knee)
    reach = math.hypot(along, behind)
    x = math.cos(yaw) * local[0] - math.sin(yaw) * local[2]
    y = local[1]
    z = math.sin(yaw) * local[0] + math.cos(yaw) * local[2]
    aside = math.atan2(x, -y)
    if abs(aside) > 0.5 * math.pi:  # the same plane, with the limb raised beyond the horizontal
        aside -= math.copysign(math.pi, aside)
    aside = clamped(aside, low[1], high[1])
    # `down` lies in the limb's plane, so that flexion is best for the clamped angle aside too.
    down = math.sin(aside) * x - math.cos(aside) * y
    lag = math.atan2(behind, along)
    flexion = clamped(math.atan2(z, down) + lag, low[2], high[2])
    out = reach * math.cos(flexion - lag)
    off = (
        out * math.sin(aside) - x,
        -out * math.cos(aside) - y,
        reach * math.sin(flexion - lag) - z,
    )
    return math.sqrt(dot(off, off)), (yaw, aside, flexion, knee)


@kernel
def _within_reach(hinges: Hinges, local: Vector) -> bool:
    """Whether some angle of the knee or elbow makes the limb as long as the target is far."""
    upper, lower = -hinges.offsets[-2, 1], -hinges.offsets[-1, 1]
    far = upper * upper + lower * lower + 2.0 * upper * lower * math.cos(hinges.lows[-1])
    near = upper * upper + lower * lower + 2.0 * upper * lower * math.cos(hinges.highs[-1])
    return bool(near <= dot(local, local) <= far)


@kernel
def _bend_limb(
    hinges: Hinges,
    angles: Floats,
    target: Floats,
    tolerance: float,
    search: bool,
    state: ChainState,
) -> int:
    """Bring the limb's tip as near to the target as its limits allow, its root at rest.

    The result is the number of hinges set. One of the four angles is free, the yaw. The present
    one is kept if it serves. Else, if `search` is set and the target is within the limb's length,
    it is the first of some others that serves, or the best of them.
    """
    first = len(angles) - LIMB
    f, p = state.frames[first], state.pivots[first]
    x, y, z = target[0] - p[0], target[1] - p[1], target[2] - p[2]
    local = (
        f[0, 0] * x + f[1, 0] * y + f[2, 0] * z,
        f[0, 1] * x + f[1, 1] * y + f[2, 1] * z,
        f[0, 2] * x + f[1, 2] * y + f[2, 2] * z,
    )
    now, low, high = angles[first], hinges.lows[first], hinges.highs[first]
    least, best = _bent_at(hinges, now, local)
    tried = 1
    if search and _within_reach(hinges, local):
        while least > tolerance and tried <= _YAWS:
            aside = (high - low) * (2.0 / _YAWS) * ((tried + 1) // 2)
            yaw = clamped(now + (aside if tried % 2 else -aside), low, high)
            left, pose = _bent_at(hinges, yaw, local)
            tried += 1
            if left < least:
                least, best = left, pose
    for k in range(LIMB):
        angles[first + k] = best[k]
    place_hinges(hinges, angles, state)
    return LIMB * tried


@kernel
def _solve_ccd(
    hinges: Hinges, angles: Floats, target: Floats, effort: Effort, state: ChainState
) -> tuple[int, int]:
    """CCD of the limb alone for some sweeps, then of the whole chain.

    The result is the number of sweeps and that of hinges turned.
    """
    count = len(angles)
    turned = 0
    place_hinges(hinges, angles, state)
    for sweep in range(effort.sweeps):
        if distance_left(state, target) <= effort.tolerance:
            return sweep, turned
        first = count - LIMB if sweep < effort.limb_sweeps else 0
        turned += ccd_sweep(hinges, angles, target, effort.tolerance, (first, count), state)
        place_hinges(hinges, angles, state)
    return effort.sweeps, turned


@kernel
def _solve_two_stage(
    hinges: Hinges,
    angles: Floats,
    target: Floats,
    effort: Effort,
    starts: Floats,
    state: ChainState,
) -> tuple[int, int]:
    """Bend the limb in closed form and turn the trunk by CCD, in turn, until the target is reached.

    Where limits are in the way, the pose starts anew from the next one of starts (R, J). The result
    is the number of sweeps and that of hinges turned.
    """
    trunk = len(angles) - LIMB
    turned, age, restarts = 0, 0, 0
    marked = math.inf
    place_hinges(hinges, angles, state)
    for sweep in range(effort.sweeps):
        turned += _bend_limb(hinges, angles, target, effort.tolerance, age == 0, state)
        left = distance_left(state, target)
        if left <= effort.tolerance:
            return sweep + 1, turned
        age += 1
        if age % _PATIENCE == 0:
            if left > _SHRUNK * marked and restarts < len(starts):
                angles[:] = starts[restarts]
                place_hinges(hinges, angles, state)
                restarts += 1
                turned += len(angles)
                age, marked = 0, math.inf
                continue
            marked = left
        turned += ccd_sweep(hinges, angles, target, effort.tolerance, (0, trunk), state)
        place_hinges(hinges, angles, state)
        if distance_left(state, target) <= effort.tolerance:
            return sweep + 1, turned
    return effort.sweeps, turned


@kernel
def solve_all(
    hinges: Hinges,
    angles: Floats,
    targets: Floats,
    effort: Effort,
    starts: Floats,
    two_stage: bool,
    left: Floats,
    sweeps: Ints,
    turned: Ints,
) -> None:
    """Move poses (N, J) towards targets (N, 3).

    Distances left, sweeps done and hinges turned are written to arrays (N,).
    """
    state = new_state(angles.shape[1])
    for n in range(len(targets)):
        if two_stage:
            done = _solve_two_stage(hinges, angles[n], targets[n], effort, starts, state)
        else:
            done = _solve_ccd(hinges, angles[n], targets[n], effort, state)
        sweeps[n], turned[n] = done
        left[n] = distance_left(state, targets[n])
