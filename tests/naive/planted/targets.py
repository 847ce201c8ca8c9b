"""Targets of N steps at K shares of each."""

import numpy as np

from esplanade.actors.locomotion.planted.footprints import StepFootprints
from esplanade.actors.locomotion.planted.targets import Targets
from esplanade.actors.locomotion.reference.body_curves import upper_angles
from esplanade.planning.compiled.arrays import Floats
from tests.naive.planted.double_support import (
    DoubleSupportPose,
    double_support_pose,
    forward_and_left,
)
from tests.naive.planted.feet import clearance, lowered_to, standing_foot, swing_foot
from tests.naive.planted.hips import hips_at


def step_targets(footprints: StepFootprints, u: Floats) -> Targets:
    """Targets of N steps at shares u in [0, 1]: float64 (K,) for all, or (N, K)."""
    u = np.broadcast_to(u, (len(footprints.on_right), np.shape(u)[-1]))
    lifted, landing = _from_standing_foot(footprints)
    here = np.zeros_like(lifted)
    poses = double_support_pose(
        np.stack([lifted, here]), np.stack([here, landing]), np.array([[1.0], [-1.0]])
    )
    before = DoubleSupportPose._make(part[0][:, None] for part in poses)
    after = DoubleSupportPose._make(part[1][:, None] for part in poses)
    lifted, landing = lifted[:, None], landing[:, None]

    hips = hips_at(before, after, u)
    standing = standing_foot(before, after, hips, u)
    swing = swing_foot(
        before, after, lifted, landing, hips, u, clearance(before, after, lifted, landing)
    )
    swing_of_arms = 0.35 * hips.runs * np.cos(np.pi * u)
    near, far = upper_angles(hips.pace, 0.5 * u), upper_angles(hips.pace, 0.5 + 0.5 * u)
    found = Targets(
        root=lowered_to(hips, standing, swing),
        yaw=hips.yaw,
        lean=hips.lean,
        roll=hips.roll,
        swing_ankle=swing.ankle,
        swing_pitch=swing.pitch,
        swing_heading=swing.heading,
        standing_pitch=standing.pitch,
        torsion=near.torsion,
        shoulders=np.stack([near.shoulder - swing_of_arms, far.shoulder + swing_of_arms], axis=-1),
        elbows=np.stack([near.elbow, far.elbow], axis=-1) + 1.05 * hips.runs[..., None],
        lift=hips.lift[:, 0],
        flight=after.flight[:, 0],
    )
    return _into_world(found, footprints)


def _from_standing_foot(footprints: StepFootprints) -> tuple[Floats, Floats]:
    """Footprints lifted and landing, (N, 4), in leg lengths from a standing foot that is left."""
    forward, left = forward_and_left(footprints.standing[:, 3])
    mirror = np.where(footprints.on_right, -1.0, 1.0)

    def seen(footprint: Floats) -> Floats:
        apart = (footprint[:, :3] - footprints.standing[:, :3]) / footprints.leg_m[:, None]
        turned = footprint[:, 3] - footprints.standing[:, 3]
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

    return seen(footprints.lifted), seen(footprints.landing)


def _into_world(found: Targets, footprints: StepFootprints) -> Targets:
    """Back from the frame of the standing foot."""
    forward, left = (axis[:, None] for axis in forward_and_left(footprints.standing[:, 3]))
    heading = footprints.standing[:, 3, None]
    mirror = np.where(footprints.on_right, -1.0, 1.0)[:, None]
    leg = footprints.leg_m[:, None, None]

    def place(local: Floats) -> Floats:
        level = local[..., :1] * forward + (mirror * local[..., 1])[..., None] * left
        offset = leg * np.concatenate([level, local[..., 2:]], axis=-1)
        world: Floats = footprints.standing[:, None, :3] + offset
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
