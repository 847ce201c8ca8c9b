"""The step that avatars take: feet stay where they are put, and a step ends as the next begins.

Jing et al. move the body by whichever foot bears it, which leaves legs of unequal height and a
trailing toe that slides. Here feet and hips are given paths first and legs are bent to fit. Within,
the standing foot is the left one, its heel the origin, and it points along x; leg lengths.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from actors.locomotion._feet import clearance, lowered_to, standing_foot, swinging_foot
from actors.locomotion._hips import hips_at
from actors.locomotion.curves import upper_angles
from actors.locomotion.skeleton import Floats
from actors.locomotion.turning import BothDown, both_down, forward_and_left


class Footfalls(NamedTuple):
    """N steps by their footprints: x, y, z of the heel on the ground (metres), heading (radians).

    World axes, headings from +x counter-clockwise.
    """

    right: NDArray[np.bool_]
    """(N,): the standing foot is the right one."""
    lifted: Floats
    """(N, 4): where the other foot comes from."""
    standing: Floats
    """(N, 4)."""
    landing: Floats
    """(N, 4): where the other foot comes down."""
    leg_m: Floats
    """(N,)."""


class Targets(NamedTuple):
    """Where body and feet are at K shares of N steps; metres and radians, world axes."""

    root: Floats
    """(N, K, 3): the middle between the hip joints."""
    yaw: Floats
    """(N, K): where the pelvis faces; its frame forward, left, up is Rz(yaw) Ry(lean) Rx(roll)."""
    lean: Floats
    """(N, K): forward bow."""
    roll: Floats
    """(N, K): positive with the left hip higher."""
    swing_ankle: Floats
    """(N, K, 3)."""
    swing_pitch: Floats
    """(N, K): toe up positive."""
    swing_heading: Floats
    """(N, K)."""
    standing_pitch: Floats
    """(N, K): turns about the heel with the toe up, about the toe with the heel up (negative)."""
    torsion: Floats
    """(N, K): of the chest against the pelvis, counter-clockwise."""
    shoulders: Floats
    """(N, K, 2): flexion left, right."""
    elbows: Floats
    """(N, K, 2): flexion left, right."""
    lift: Floats
    """(N,): share of the step until which the swinging foot's toe stays on its old footprint."""


def step_targets(falls: Footfalls, u: Floats) -> Targets:
    """What N steps aim at, at shares u in [0, 1]: float64 (K,) for all, or (N, K)."""
    u = np.broadcast_to(u, (len(falls.right), np.shape(u)[-1]))
    lifted, landing = _from_standing_foot(falls)
    here = np.zeros_like(lifted)
    poses = both_down(
        np.stack([lifted, here]), np.stack([here, landing]), np.array([[1.0], [-1.0]])
    )
    before = BothDown._make(part[0][:, None] for part in poses)
    after = BothDown._make(part[1][:, None] for part in poses)
    lifted, landing = lifted[:, None], landing[:, None]

    hips = hips_at(before, after, u)
    standing = standing_foot(before, after, hips, u)
    swinging = swinging_foot(
        before, after, lifted, landing, hips, u, clearance(before, after, lifted, landing)
    )
    near, far = upper_angles(hips.pace, 0.5 * u), upper_angles(hips.pace, 0.5 + 0.5 * u)
    found = Targets(
        root=lowered_to(hips, standing, swinging),
        yaw=hips.yaw,
        lean=hips.lean,
        roll=hips.roll,
        swing_ankle=swinging.ankle,
        swing_pitch=swinging.pitch,
        swing_heading=swinging.heading,
        standing_pitch=standing.pitch,
        torsion=near.torsion,
        shoulders=np.stack([near.shoulder, far.shoulder], axis=-1),
        elbows=np.stack([near.elbow, far.elbow], axis=-1),
        lift=hips.lift[:, 0],
    )
    return _into_world(found, falls)


def _from_standing_foot(falls: Footfalls) -> tuple[Floats, Floats]:
    """Footprints lifted and landing, (N, 4), in leg lengths from a standing foot that is left."""
    forward, left = forward_and_left(falls.standing[:, 3])
    mirror = np.where(falls.right, -1.0, 1.0)

    def seen(footprint: Floats) -> Floats:
        apart = (footprint[:, :3] - falls.standing[:, :3]) / falls.leg_m[:, None]
        turned = footprint[:, 3] - falls.standing[:, 3]
        turned = (turned + np.pi) % (2.0 * np.pi) - np.pi
        return np.stack(
            [
                np.sum(apart[:, :2] * forward, axis=1),
                mirror * np.sum(apart[:, :2] * left, axis=1),
                apart[:, 2],
                mirror * turned,
            ],
            axis=1,
        )

    return seen(falls.lifted), seen(falls.landing)


def _into_world(found: Targets, falls: Footfalls) -> Targets:
    """Back from the frame of the standing foot."""
    forward, left = (axis[:, None] for axis in forward_and_left(falls.standing[:, 3]))
    heading = falls.standing[:, 3, None]
    mirror = np.where(falls.right, -1.0, 1.0)[:, None]
    leg = falls.leg_m[:, None, None]

    def place(local: Floats) -> Floats:
        level = local[..., :1] * forward + (mirror * local[..., 1])[..., None] * left
        offset = leg * np.concatenate([level, local[..., 2:]], axis=-1)
        world: Floats = falls.standing[:, None, :3] + offset
        return world

    def sides(standing_first: Floats) -> Floats:
        return np.where(mirror[..., None] < 0.0, standing_first[..., ::-1], standing_first)

    return found._replace(
        root=place(found.root),
        yaw=heading + mirror * found.yaw,
        roll=mirror * found.roll,
        swing_ankle=place(found.swing_ankle),
        swing_heading=heading + mirror * found.swing_heading,
        torsion=mirror * found.torsion,
        shoulders=sides(found.shoulders),
        elbows=sides(found.elbows),
    )
