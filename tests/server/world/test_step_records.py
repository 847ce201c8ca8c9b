"""Records that compiled code writes and reads, against those of the protocol itself."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from esplanade.actors.locomotion.motion import key_poses as motion
from esplanade.actors.locomotion.motion.key_poses import CHEST, PELVIS, Steps
from esplanade.protocol import steps as wire
from esplanade.protocol.steps import pack_steps, unpack_steps
from esplanade.server.world.step_records import from_records, to_records
from tests.naive.steps import align
from tests.protocol.steps import made_up_steps


def as_motion(steps: wire.Steps) -> Steps:
    """The same steps, with keys from their footprints."""
    standing = np.column_stack([steps.standing.positions_m, steps.standing.headings_rad])
    landing = np.column_stack([steps.landing.positions_m, steps.landing.headings_rad])
    keys = np.empty((len(steps.ids), motion.KEYS, motion.WIDTH))
    keys[..., motion.ROOT] = steps.keys.roots_m - standing[:, None, :3]
    keys[..., motion.PELVIS] = steps.keys.pelvises
    keys[..., motion.ANKLE] = steps.keys.ankles_m - landing[:, None, :3]
    keys[..., motion.SWING_PITCH] = steps.keys.swing_pitches_rad
    keys[..., motion.STANDING_PITCH] = steps.keys.standing_pitches_rad
    keys[..., motion.SWING_HEADING] = steps.keys.swing_headings_rad - landing[:, None, 3]
    keys[..., motion.CHEST] = steps.keys.chests
    keys[..., motion.ARMS] = steps.keys.arms_rad
    return Steps(
        steps.on_right,
        steps.re_aimed,
        steps.begin_ticks,
        steps.durations_ticks,
        standing,
        landing,
        steps.lifts,
        keys,
    )


@given(st.integers(0, 2**32 - 1))
def test_records_are_those_of_the_protocol(seed: int) -> None:
    made_up = made_up_steps(6, seed)
    records = to_records(as_motion(made_up), made_up.ids)
    expected = pack_steps(made_up)
    for name in ("kind", "length", "id", "flags", "tick", "ticks", "standing", "landing", "lift"):
        np.testing.assert_array_equal(records[name], expected[name])
    for name in expected["keys"].dtype.names:
        # Sums with a footprint and without may round to either side of half a quantum.
        apart = records["keys"][name].astype(np.int64) - expected["keys"][name]
        assert np.abs(apart).max() <= (0 if name in {"pelvis", "chest", "arms"} else 1)

    known, read = from_records(expected), as_motion(unpack_steps(expected))
    align(read.keys)
    for one, other in zip(known, read, strict=True):
        np.testing.assert_array_equal(one, other)


def test_neighbouring_quaternions_get_one_sign() -> None:
    keys = from_records(pack_steps(made_up_steps(50, 1))).keys
    for part in (PELVIS, CHEST):
        assert (np.einsum("nkd,nkd->nk", keys[:, 1:, part], keys[:, :-1, part]) >= 0.0).all()


def test_rotations_by_quarter_turns_are_packed_alike_again() -> None:
    steps = made_up_steps(2000, 4)
    angles = np.pi / 4.0 + np.random.default_rng(5).normal(0.0, 2e-5, (2000, motion.KEYS))
    steps.keys.pelvises[:] = 0.0
    steps.keys.pelvises[..., 0] = np.cos(angles)
    steps.keys.pelvises[..., 3] = np.sin(angles)
    once = to_records(as_motion(steps), steps.ids)
    again = to_records(from_records(once), steps.ids)
    np.testing.assert_array_equal(once["keys"]["pelvis"], again["keys"]["pelvis"])
    np.testing.assert_array_equal(once["keys"]["pelvis"], pack_steps(steps)["keys"]["pelvis"])
