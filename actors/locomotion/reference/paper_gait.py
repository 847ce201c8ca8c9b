"""Walking as published (Jing et al. 2015): the reference for the planted step.

The length of a step decides its relative velocity (eq. (10), algorithm 1). Poses change from one
step to the next by Bezier weights (eq. (14)). The root moves so that the heel, later the toe, of
the standing foot stays where it is (eqs. (6), (9)). Because of two flaws nobody walks so in the
world: where the feet change parts, the new heel is some hundredths of a leg length off the ground;
and the toe of the foot behind slides until it leaves the ground. Steps of next to no length make
the gait jitter.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from esplanade.actors.locomotion.body.skeleton import leg_points
from esplanade.actors.locomotion.gait.curves import joint_angles
from esplanade.actors.locomotion.gait.step_length import RV_LONGEST
from esplanade.actors.locomotion.reference.bezier import blend_level
from esplanade.actors.locomotion.reference.published_lengths import sl_noslide
from esplanade.planning.compiled.arrays import Bools, Floats, Ints

FLAT: Final = 0.004
"""A foot whose heel and toe are closer in height is flat, leg lengths (eq. (6))."""
FRAMES_A_STEP: Final = 40
"""Frames in half of a cycle of 1.346 s at 60 frames a second."""
TOLERANCE: Final = 1e-6
"""The paper stops at .01, but a hundredth of a leg length adds up from step to step."""

_MOST_HALVINGS: Final = 60


class PaperWalk(NamedTuple):
    """N walkers over F frames; the first frame is the pose that the first step begins with."""

    root: Floats
    """(N, F, 2), leg lengths: hips forward and up from the first standing heel."""
    angles: Floats
    """(N, F, 2, 3), radians: hip, knee, ankle of the left and the right leg."""
    on_toe: Bools
    """(N, F): whether the foot stands on its toe, not on its heel."""
    on_right: Bools
    """(F,): whether the right foot stands."""
    ends: Ints
    """(S,): the frames between steps, with both feet down."""

    def feet(self) -> tuple[Floats, Floats]:
        """Heels and toes of both feet, each float64 (N, F, 2 feet, 2), forward and up."""
        _, heels, toes = leg_points(self.angles)
        return self.root[:, :, None] + heels, self.root[:, :, None] + toes


def halve(
    length_of: Callable[[Floats], Floats],
    lengths: ArrayLike,
    tolerance: float,
    *,
    high: float = RV_LONGEST,
) -> tuple[Floats, Ints]:
    """Solve for relative velocities by halving intervals: Jing et al. 2015, algorithm 1.

    Parameters
    ----------
    length_of : any growing function of the relative velocity
    lengths : float64 (N,), leg lengths
    tolerance : leg lengths, at which a length counts as met
    high : upper end of the first interval

    Returns
    -------
    float64 (N,), relative velocities
        A length without a solution gives the nearer end of the interval.
    int64 (N,), how often each interval was halved
    """
    wanted = np.asarray(lengths, dtype=np.float64)
    low, top = np.zeros_like(wanted), np.full_like(wanted, high)
    rv = 0.5 * top
    halvings = np.zeros(wanted.shape, dtype=np.int64)
    for _ in range(_MOST_HALVINGS):
        off = length_of(rv) - wanted
        going_on = np.abs(off) > tolerance
        if not going_on.any():
            break
        top = np.where(going_on & (off > 0.0), rv, top)
        low = np.where(going_on & (off <= 0.0), rv, low)
        rv = np.where(going_on, 0.5 * (low + top), rv)
        halvings += going_on
    return rv, halvings


def walk(step_lengths: ArrayLike, frames: int = FRAMES_A_STEP) -> PaperWalk:
    """Walk steps of given lengths as published.

    Parameters
    ----------
    step_lengths : float64 (N, S), leg lengths, in [0, .76]
        The first is that of the pose to begin with: S - 1 steps are walked.
    frames : frames of each step, at least 2

    Returns
    -------
    PaperWalk of (S - 1) x frames + 1 frames

    Raises
    ------
    ValueError
        There are fewer than two lengths or frames, or no step has such a length.
    """
    lengths = np.asarray(step_lengths, dtype=np.float64)
    if lengths.ndim != 2 or lengths.shape[1] < 2 or frames < 2:
        raise ValueError(
            f"a walk needs at least two lengths and two frames a step, got {lengths.shape}"
        )
    longest = float(sl_noslide(RV_LONGEST))
    if not np.all((lengths >= 0.0) & (lengths <= longest)):
        raise ValueError(f"step lengths must lie between 0 and {longest:.4f} leg lengths")
    rv, _ = halve(sl_noslide, lengths, TOLERANCE)
    count, steps = lengths.shape[0], lengths.shape[1] - 1
    total = steps * frames + 1
    made = PaperWalk(
        np.empty((count, total, 2)),
        np.empty((count, total, 2, 3)),
        np.zeros((count, total), dtype=np.bool_),
        np.empty(total, dtype=np.bool_),
        np.arange(steps + 1) * frames,
    )
    _, heel, _ = leg_points(joint_angles(rv[:, 0], np.zeros(count), faded=False))
    root = -heel
    for step in range(steps):
        root = _walk_step(made, step, frames, rv[:, step], rv[:, step + 1], root)
    made.on_right[-1] = steps % 2 == 1
    return made


def _walk_step(
    made: PaperWalk, step: int, frames: int, before: Floats, after: Floats, root: Floats
) -> Floats:
    """Write one step that begins with the root at (N, 2); the result is the root at its end."""
    first = step * frames
    right = step % 2 == 1
    on_toe = np.zeros(len(root), dtype=np.bool_)
    heel = toe = np.zeros_like(root)
    for frame in range(frames + 1):
        share = frame / frames
        angles = _blended(before, after, share, right)
        _, new_heel, new_toe = leg_points(angles[:, int(right)])
        if frame:
            moved = np.where(on_toe[:, None], toe - new_toe, heel - new_heel)
            root = root + moved
        heel, toe = new_heel, new_toe
        on_toe |= toe[:, 1] - heel[:, 1] < FLAT
        made.root[:, first + frame] = root
        made.angles[:, first + frame] = angles
        if frame < frames:
            made.on_toe[:, first + frame] = on_toe
            made.on_right[first + frame] = right
    return root


def _blended(before: Floats, after: Floats, share: float, right: bool) -> Floats:
    """Angles (N, 2, 3) of both legs at a share of a step on the left or right foot."""
    u = np.full(len(before), share)
    legs = []
    for stands in (not right, right):
        phase = 0.5 * u + (0.0 if stands else 0.5)
        legs.append(
            blend_level(
                joint_angles(before, phase, faded=False), joint_angles(after, phase, faded=False), u
            )
        )
    return np.stack(legs, axis=1)
