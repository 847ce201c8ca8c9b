"""Records that compiled code writes and reads, against those of the protocol itself."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from esplanade.actors.locomotion.motion import key_poses as motion
from esplanade.actors.locomotion.motion.key_poses import CHEST, PELVIS, Steps
from esplanade.protocol import keys_between
from esplanade.protocol import steps as wire
from esplanade.protocol.steps import pack_steps, unpack_steps
from esplanade.server.world.compiled import _keys_between_kernels as kernels
from esplanade.server.world.step_records import from_records, to_records
from tests.naive.steps import align
from tests.protocol.steps import made_up_steps

COARSEST = 1 << 9
"""The most that differences of made-up steps are multiples of."""


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
        steps.flights,
        keys,
    )


def as_wire(steps: Steps, ids: NDArray[np.int64]) -> wire.Steps:
    """The same steps, with keys in the world."""
    standing, landing = steps.standing, steps.landing
    return wire.Steps(
        ids,
        steps.on_right,
        steps.re_aimed,
        steps.start,
        steps.ticks,
        wire.Footprints(standing[:, :3], standing[:, 3]),
        wire.Footprints(landing[:, :3], landing[:, 3]),
        steps.lift,
        steps.flight,
        wire.Keys(
            steps.keys[..., motion.ROOT] + standing[:, None, :3],
            steps.keys[..., motion.PELVIS],
            steps.keys[..., motion.ANKLE] + landing[:, None, :3],
            steps.keys[..., motion.SWING_PITCH],
            steps.keys[..., motion.STANDING_PITCH],
            steps.keys[..., motion.SWING_HEADING] + landing[:, None, 3],
            steps.keys[..., motion.CHEST],
            steps.keys[..., motion.ARMS],
        ),
    )


@given(st.integers(0, 2**32 - 1))
def test_records_are_those_of_the_protocol(seed: int) -> None:
    made_up = made_up_steps(6, seed)
    expected = pack_steps(made_up)
    known, read = from_records(expected), as_motion(unpack_steps(expected))
    align(read.keys)
    for one, other in zip(known, read, strict=True):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-15)

    records = to_records(as_motion(made_up), made_up.ids)
    for name in records.dtype.names or ():
        if name not in {"first", "last", "ankle", "swing_heading", "shifts", "between"}:
            np.testing.assert_array_equal(records[name], expected[name])
    # Sums with a footprint and without may round to either side of half a quantum.
    for end in ("first", "last"):
        for name in records[end].dtype.names:
            apart = records[end][name].astype(np.int64) - expected[end][name]
            assert np.abs(apart).max() <= (name in {"root", "swing_pitch", "standing_pitch"})
    keys = from_records(records).keys
    np.testing.assert_allclose(keys, known.keys, rtol=0.0, atol=2 * COARSEST * wire.KEY_M)


def test_steps_that_were_read_are_written_to_the_same_bytes() -> None:
    """Sums with footprints are exact there, so nothing is left to rounding."""
    known = from_records(pack_steps(made_up_steps(2000, 7)))
    ids = np.arange(2000)
    records = to_records(known, ids)
    expected = pack_steps(as_wire(known, ids))
    np.testing.assert_array_equal(records, expected)
    for name in ("standing", "landing", "first", "last", "ankle", "swing_heading"):
        again = to_records(from_records(records), ids)
        np.testing.assert_array_equal(records[name], again[name])


def test_neighbouring_quaternions_get_one_sign() -> None:
    keys = from_records(pack_steps(made_up_steps(50, 1))).keys
    for part in (PELVIS, CHEST):
        assert (np.einsum("nkd,nkd->nk", keys[:, 1:, part], keys[:, :-1, part]) >= 0.0).all()


def test_compiled_code_has_the_constants_of_the_protocol() -> None:
    assert tuple(kernels.FAR[1:-1]) == keys_between.FAR
    assert (kernels.NUMBERS, kernels.BYTES) == (keys_between.NUMBERS, keys_between.BYTES)
    assert keys_between.GROUPS[-1] + 1 == kernels.GROUPS
