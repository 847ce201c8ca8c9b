"""The packed block of steps: layout, bounds of quantisation, clamping at the edges."""

from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.protocol.keys_between import KEYS
from esplanade.protocol.quaternions import Floats, from_angles, from_twist
from esplanade.protocol.steps import (
    ARM_RAD,
    FOOT_RAD,
    FOOTPRINT_M,
    FOOTPRINT_RAD,
    KEY_M,
    RE_AIMED,
    STEP,
    TRUNK_RAD,
    WALKING,
    Footprints,
    Keys,
    Steps,
    landing_footprints,
    new_step_records,
    pack_steps,
    step_records,
    unpack_steps,
)
from tests.protocol.steps import made_up_steps, mixed_block

LEGS_M = 0.3e-3
LEGS_RAD = np.radians(0.05)
TURNED_RAD = np.radians(0.1)


def turned_rad(one: Floats, other: Floats) -> Floats:
    """Angle between rotations, whatever the signs of their quaternions."""
    apart = np.minimum(np.linalg.norm(one - other, axis=-1), np.linalg.norm(one + other, axis=-1))
    angles: Floats = 4.0 * np.arcsin(apart / 2.0)
    return angles


def off(one: Floats, other: Floats) -> float:
    return float(np.abs(one - other).max())


def of_ends(keys: Keys) -> Keys:
    """The first key and the last."""
    return Keys(*(getattr(keys, field.name)[:, [0, -1]] for field in fields(keys)))


@given(st.integers(0, 2**32 - 1))
def test_the_ends_come_back_as_near_as_a_pose_needs(seed: int) -> None:
    steps = made_up_steps(8, seed)
    read = unpack_steps(step_records(pack_steps(steps).tobytes()))
    for name in ("ids", "on_right", "re_aimed", "begin_ticks", "durations_ticks"):
        np.testing.assert_array_equal(getattr(read, name), getattr(steps, name))
    assert off(read.lifts, steps.lifts) <= 0.5 / 255 + 1e-9
    for before, after in ((steps.standing, read.standing), (steps.landing, read.landing)):
        assert off(after.positions_m, before.positions_m) <= FOOTPRINT_M / 2 + 1e-9
        turned = np.angle(np.exp(1j * (after.headings_rad - before.headings_rad)))
        assert np.abs(turned).max() <= FOOTPRINT_RAD / 2 + 1e-9
    keys, known = of_ends(read.keys), of_ends(steps.keys)
    assert off(keys.roots_m, known.roots_m) <= KEY_M / 2 + 1e-9 < LEGS_M
    assert off(keys.ankles_m, known.ankles_m) <= KEY_M / 2 + 1e-9 < LEGS_M
    assert off(keys.swing_pitches_rad, known.swing_pitches_rad) <= FOOT_RAD / 2 + 1e-9 < LEGS_RAD
    assert off(keys.standing_pitches_rad, known.standing_pitches_rad) <= FOOT_RAD / 2 + 1e-9
    turned = np.angle(np.exp(1j * (keys.swing_headings_rad - known.swing_headings_rad)))
    assert np.abs(turned).max() <= FOOT_RAD / 2 + 1e-9
    assert turned_rad(keys.pelvises, known.pelvises).max() < TURNED_RAD
    assert turned_rad(keys.chests, known.chests).max() < TURNED_RAD
    assert off(keys.arms_rad, known.arms_rad) <= ARM_RAD / 2 + 1e-9


@given(st.integers(0, 2**32 - 1))
def test_between_nothing_is_further_off_than_half_a_multiple(seed: int) -> None:
    steps = made_up_steps(8, seed)
    records = pack_steps(steps)
    read, known = unpack_steps(records).keys, steps.keys
    multiple = 1 << ((records["shifts"].astype(np.int64)[:, None] >> 4 * np.arange(8)) & 0xF)

    def within(group: int, quantum: float, apart: Floats) -> bool:
        room = quantum * (0.5 * multiple[:, group] + 0.5) + 1e-9
        return bool((np.abs(apart).reshape(8, -1).max(axis=1) <= room).all())

    assert within(0, KEY_M, read.roots_m - known.roots_m)
    assert within(1, KEY_M, read.ankles_m - known.ankles_m)
    assert within(3, FOOT_RAD, read.swing_pitches_rad - known.swing_pitches_rad)
    assert within(4, FOOT_RAD, read.standing_pitches_rad - known.standing_pitches_rad)
    turned = np.angle(np.exp(1j * (read.swing_headings_rad - known.swing_headings_rad)))
    assert within(5, FOOT_RAD, turned)
    assert within(7, ARM_RAD, read.arms_rad - known.arms_rad)
    # A rotation is off by no more than its yaw, lean and roll together.
    room = FOOTPRINT_RAD * (multiple[:, 2] + 1) + 2 * TRUNK_RAD * (multiple[:, 6] + 1)
    assert (turned_rad(read.pelvises, known.pelvises).max(axis=1) <= 0.5 * room + 1e-9).all()
    assert (
        turned_rad(read.chests, known.chests).max(axis=1) <= TRUNK_RAD * (multiple[:, 6] + 1)
    ).all()


@given(st.integers(0, 2**32 - 1))
def test_what_was_read_is_packed_to_the_same_bytes(seed: int) -> None:
    """Packing the ends of a record again changes nothing."""
    records = pack_steps(made_up_steps(4, seed))
    again = pack_steps(unpack_steps(records))
    for name in ("standing", "landing", "first", "last", "ankle", "swing_heading"):
        assert again[name].tobytes() == records[name].tobytes(), name


def test_a_landing_footprint_has_the_numbers_of_a_standing_one() -> None:
    steps = made_up_steps(50)
    records = pack_steps(steps)
    onward = pack_steps(replace(steps, standing=unpack_steps(records).landing))
    np.testing.assert_array_equal(onward["standing"], landing_footprints(records))


def test_the_swing_foot_lands_on_its_footprint_whatever_is_packed() -> None:
    steps = made_up_steps(5)
    steps.keys.ankles_m[:, -1] += 0.01
    steps.keys.swing_headings_rad[:, -1] += 0.01
    read = unpack_steps(pack_steps(steps))
    np.testing.assert_array_equal(read.keys.ankles_m[:, -1], read.landing.positions_m)
    np.testing.assert_array_equal(read.keys.swing_headings_rad[:, -1], read.landing.headings_rad)


def test_a_flat_foot_stays_flat() -> None:
    steps = made_up_steps(5)
    steps.keys.standing_pitches_rad[:, 1:3] = 0.0
    read = unpack_steps(pack_steps(steps))
    assert not read.keys.standing_pitches_rad[:, 1:3].any()


def test_turns_stay_whole_over_the_keys() -> None:
    """Interpolating between keys must not run the long way around."""
    steps = made_up_steps(1)
    headings = np.linspace(np.pi - 0.3, np.pi + 0.3, KEYS)[None]
    landing = Footprints(steps.landing.positions_m, np.array([-np.pi + 0.3]))
    yaws = from_angles(np.stack([headings, 0.0 * headings, 0.0 * headings], axis=-1))
    keys = replace(steps.keys, swing_headings_rad=headings, pelvises=yaws)
    records = pack_steps(replace(steps, landing=landing, keys=keys))
    read = unpack_steps(records).keys
    np.testing.assert_allclose(np.diff(read.swing_headings_rad), 0.12, atol=2 * FOOT_RAD)
    np.testing.assert_allclose(turned_rad(read.pelvises, yaws), 0.0, atol=FOOTPRINT_RAD)


def test_what_lies_outside_is_clamped_to_the_edge() -> None:
    steps = made_up_steps(2)
    far = np.zeros((2, KEYS, 3)) + np.array([1e3, -1e3])[:, None, None]
    lying = np.stack([0.0 * far[..., 0], far[..., 1] * 1e-3, far[..., 2] * 1e-3], axis=-1)
    keys = replace(
        steps.keys,
        roots_m=far,
        pelvises=from_angles(lying),
        ankles_m=far,
        arms_rad=np.full((2, KEYS, 4), -9.0),
        standing_pitches_rad=np.full((2, KEYS), 9.0),
    )
    wide = replace(steps, keys=keys, lifts=np.array([-1.0, 2.0]), durations_ticks=np.full(2, 300))
    records = pack_steps(wide)
    for end in ("first", "last"):
        assert set(records[end]["root"].ravel().tolist()) == {32767, -32767}
        assert set(records[end]["arms"].ravel().tolist()) == {-127}
        assert set(records[end]["standing_pitch"].ravel().tolist()) == {32767}
        assert set(records[end]["lean"].ravel().tolist()) == {127, -127}
    assert set(records["ankle"].ravel().tolist()) == {32767, -32767}
    assert records["lift"].tolist() == [0, 255]
    assert records["ticks"].tolist() == [255, 255]
    clamped = unpack_steps(records).keys
    assert np.abs(clamped.roots_m - steps.standing.positions_m[:, None]).max() < 3.3


def a_step_of_known_bytes(*, re_aimed: bool) -> Steps:
    level = np.zeros((1, KEYS))
    share = np.linspace(0.0, 1.0, KEYS)
    landing = np.array([[1.5, -1.0, 0.25]])
    return Steps(
        ids=np.array([0x01020304]),
        on_right=np.array([True]),
        re_aimed=np.array([re_aimed]),
        begin_ticks=np.array([0x05060708]),
        durations_ticks=np.array([9]),
        standing=Footprints(np.array([[1.0, -1.0, 0.25]]), np.array([np.pi / 2])),
        landing=Footprints(landing, np.array([-np.pi / 2])),
        lifts=np.array([1.0]),
        flights=np.array([0.25]),
        keys=Keys(
            roots_m=np.stack([0.75 + 0.5 * share, level[0] - 1.0, level[0] + 1.125], axis=1)[None],
            pelvises=from_angles(np.stack([level, level + 0.125, level - 0.0625], axis=-1)),
            ankles_m=landing[:, None] + (1.0 - share)[None, :, None] * np.array([-1.0, 0.0, 0.0]),
            swing_pitches_rad=level + 0.1,
            standing_pitches_rad=level - 0.1,
            swing_headings_rad=-np.pi / 2 + 0.01 * (1.0 - share)[None],
            chests=from_twist(level + 0.03125, level - 0.0625),
            arms_rad=0.25 + 0.0125 * np.array([0, 1, -1, 7, 0, 0])[None, :, None] * np.ones(4),
        ),
    )


def test_the_layout_byte_by_byte() -> None:
    block = pack_steps(a_step_of_known_bytes(re_aimed=True)).tobytes()
    assert len(block) == STEP.itemsize == 140
    assert block[:36].hex(" ") == (
        "01 8c 00 04 03 02 01 83 08 07 06 05 09 ff "
        "10 27 00 00 f0 d8 ff ff c4 09 00 00 00 40 "
        "88 13 00 00 00 00 00 c0"
    )
    assert block[36:55].hex(" ") == "3c f6 00 00 2e 22 00 00 e8 03 18 fc 40 e0 10 14 14 14 14"
    assert block[55:74].hex(" ") == "c4 09 00 00 2e 22 00 00 e8 03 18 fc 40 e0 10 14 14 14 14"
    assert block[74:86].hex(" ") == "f0 d8 00 00 00 00 64 00 00 00 03 00"
    # The standing pitch of -1000 is -125 multiples of eight, and all else is foretold.
    assert block[86:96].hex(" ") == "00 00 00 00 00 00 00 00 83 00"
    assert block[86:126] == block[86:96] * 4
    assert block[126:].hex(" ") == "00 00 00 00 00 00 f1 07 f1 07 f1 07 f1 07"


def test_a_swing_foot_is_foretold_by_whether_the_step_is_aimed_anew() -> None:
    one, other = (pack_steps(a_step_of_known_bytes(re_aimed=flag)) for flag in (True, False))
    assert other["flags"] == one["flags"] - RE_AIMED
    assert not one["between"]["ankle"].any()
    assert other["between"]["ankle"][0, :, 0].all()
    for records in (one, other):
        ankles = unpack_steps(records).keys.ankles_m[0, :, 0]
        np.testing.assert_allclose(ankles, 1.5 - np.linspace(1.0, 0.0, KEYS), atol=2e-3)


def test_every_field_has_a_row_for_each_step() -> None:
    read = unpack_steps(pack_steps(made_up_steps(3)))
    for part in (read, read.standing, read.landing, read.keys):
        values = [getattr(part, field.name) for field in fields(part)]
        assert {len(value) for value in values if isinstance(value, np.ndarray)} == {3}


def test_nobody_near_is_an_empty_block() -> None:
    assert len(step_records(b"")) == 0
    assert unpack_steps(step_records(b"")).keys.roots_m.shape == (0, KEYS, 3)


def test_records_of_other_kinds_and_of_later_versions_are_passed_over() -> None:
    records = pack_steps(made_up_steps(7))
    read = step_records(mixed_block(records))
    known = [name for name in STEP.names or () if name != "length"]
    np.testing.assert_array_equal(read[known], records[known])


def test_a_block_of_another_kind_alone_holds_no_steps() -> None:
    assert len(step_records(b"\x02\x03\x00")) == 0
    # As long as a walking step, which must not make it one.
    assert len(step_records(b"\x02\x8c\x00" + bytes(STEP.itemsize - 3))) == 0


def test_a_walking_step_of_a_later_version_may_be_twice_as_long() -> None:
    longer = new_step_records(1)
    longer["id"], longer["length"] = 12, 2 * STEP.itemsize
    assert step_records(longer.tobytes() + bytes(STEP.itemsize))["id"].tolist() == [12]


WALK = new_step_records(1).tobytes()


@pytest.mark.parametrize(
    ("block", "fault"),
    [
        (b"\x01", "record 0 at byte 0 of a block of steps ends after 1 of the 3 bytes of its head"),
        (WALK + b"\x02\x03", "record 1 at byte 140 .* ends after 2 of the 3 bytes of its head"),
        (bytes(140), "record 0 at byte 0 .* length of 0 bytes, one of kind 0 has at least 3"),
        (WALK + b"\x02\x00\x00", "record 1 at byte 140 .* length of 0 bytes, .* at least 3"),
        (WALK + b"\x02\x02\x00", "record 1 at byte 140 .* length of 2 bytes, .* at least 3"),
        (
            b"\x02\x04\x00\x00\x01\x8b\x00" + WALK[3:-1],
            "record 1 at byte 4 .* length of 139 bytes, one of kind 1 has at least 140",
        ),
        (WALK[:-1], "record 0 at byte 0 .* length of 140 bytes, 139 are left"),
        (WALK + b"\x02\xff\xff", "record 1 at byte 140 .* length of 65535 bytes, 3 are left"),
    ],
    ids=["one", "head", "zeros", "zero", "short head", "short step", "cut", "runs over"],
)
def test_a_record_that_does_not_fit_is_named_with_its_place(block: bytes, fault: str) -> None:
    with pytest.raises(ValueError, match=f"^{fault}$"):
        step_records(block)


@given(st.binary(max_size=2 * STEP.itemsize))
def test_whatever_the_block_it_is_read_or_named(block: bytes) -> None:
    try:
        records = step_records(block)
    except ValueError as fault:
        assert "of a block of steps" in str(fault)  # noqa: PT017 (any other outcome is right)
    else:
        assert (records["kind"] == WALKING).all()


@given(st.binary(min_size=STEP.itemsize - 3, max_size=STEP.itemsize - 3))
def test_whatever_the_bytes_the_values_are_finite(fields_of_a_step: bytes) -> None:
    keys = unpack_steps(step_records(WALK[:3] + fields_of_a_step)).keys
    for field in fields(keys):
        assert np.isfinite(getattr(keys, field.name)).all(), field.name
    np.testing.assert_allclose(np.linalg.norm(keys.pelvises, axis=-1), 1.0)
    np.testing.assert_allclose(np.linalg.norm(keys.chests, axis=-1), 1.0)
