"""Targets of N steps at K shares of each."""

import numpy as np

from esplanade.actors.locomotion.curves import upper_angles
from esplanade.actors.locomotion.footfalls import Footfalls, Targets
from esplanade.actors.locomotion.skeleton import Floats
from tests.naive.planted.feet import clearance, lowered_to, standing_foot, swinging_foot
from tests.naive.planted.hips import hips_at
from tests.naive.planted.turning import BothDown, both_down, forward_and_left


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
