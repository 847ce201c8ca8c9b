"""Steps of feet as records of the wire, and back."""

import numpy as np

from esplanade.actors.locomotion.motion import key_poses as motion
from esplanade.protocol import steps as wire
from esplanade.protocol.steps import Footprints, Keys, StepRecords, pack_steps, unpack_steps
from esplanade.server.world.state import Slots


def to_records(steps: motion.Steps, ids: Slots) -> StepRecords:
    """Quantise N steps of the avatars with these ids (N,)."""
    keys = steps.keys
    return pack_steps(
        wire.Steps(
            ids=ids,
            on_right=steps.on_right,
            re_aimed=steps.re_aimed,
            begin_ticks=steps.start,
            durations_ticks=steps.ticks,
            standing=Footprints(steps.standing[:, :3], steps.standing[:, 3]),
            landing=Footprints(steps.landing[:, :3], steps.landing[:, 3]),
            lifts=steps.lift,
            keys=Keys(
                roots_m=keys[..., motion.ROOT] + steps.standing[:, None, :3],
                pelvises=keys[..., motion.PELVIS],
                ankles_m=keys[..., motion.ANKLE] + steps.landing[:, None, :3],
                swing_pitches_rad=keys[..., motion.SWING_PITCH],
                standing_pitches_rad=keys[..., motion.STANDING_PITCH],
                swing_headings_rad=keys[..., motion.SWING_HEADING] + steps.landing[:, None, 3],
                chests=keys[..., motion.CHEST],
                arms_rad=keys[..., motion.ARMS],
            ),
        )
    )


def from_records(records: StepRecords) -> motion.Steps:
    """The steps as readers of these records know them."""
    known = unpack_steps(records)
    standing = np.column_stack([known.standing.positions_m, known.standing.headings_rad])
    landing = np.column_stack([known.landing.positions_m, known.landing.headings_rad])
    keys = np.empty((len(records), motion.KEYS, motion.WIDTH))
    keys[..., motion.ROOT] = known.keys.roots_m - standing[:, None, :3]
    keys[..., motion.PELVIS] = known.keys.pelvises
    keys[..., motion.ANKLE] = known.keys.ankles_m - landing[:, None, :3]
    keys[..., motion.SWING_PITCH] = known.keys.swing_pitches_rad
    keys[..., motion.STANDING_PITCH] = known.keys.standing_pitches_rad
    keys[..., motion.SWING_HEADING] = known.keys.swing_headings_rad - landing[:, None, 3]
    keys[..., motion.CHEST] = known.keys.chests
    keys[..., motion.ARMS] = known.keys.arms_rad
    motion.align(keys)
    return motion.Steps(
        known.on_right,
        known.re_aimed,
        known.begin_ticks,
        known.durations_ticks,
        standing,
        landing,
        known.lifts,
        keys,
    )
