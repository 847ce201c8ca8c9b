"""The packed block of steps: layout, bounds of quantisation, clamping at the edges."""

from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.protocol.steps import (
    ARM_RAD,
    FOOT_RAD,
    FOOTPRINT_M,
    FOOTPRINT_RAD,
    KEY,
    KEY_M,
    KEYS,
    STEP,
    WALKING,
    Floats,
    Footprints,
    Keys,
    Steps,
    new_step_records,
    pack_steps,
    step_records,
    unpack_steps,
)
from tests.protocol.steps import made_up_steps, mixed_block

LEGS_M = 0.3e-3
LEGS_RAD = np.radians(0.05)
TRUNK_RAD = np.radians(1.0)


def turned_rad(one: Floats, other: Floats) -> Floats:
    """Angle between rotations, whatever the signs of their quaternions."""
    apart = np.minimum(np.linalg.norm(one - other, axis=-1), np.linalg.norm(one + other, axis=-1))
    angles: Floats = 4.0 * np.arcsin(apart / 2.0)
    return angles


def off(one: Floats, other: Floats) -> float:
    return float(np.abs(one - other).max())


@given(st.integers(0, 2**32 - 1))
def test_what_comes_back_is_as_near_as_a_pose_needs(seed: int) -> None:
    steps = made_up_steps(8, seed)
    read = unpack_steps(step_records(pack_steps(steps).tobytes()))
    for name in ("ids", "on_right", "re_aimed", "begin_ticks", "durations_ticks"):
        np.testing.assert_array_equal(getattr(read, name), getattr(steps, name))
    assert off(read.lifts, steps.lifts) <= 0.5 / 255 + 1e-9
    for before, after in ((steps.standing, read.standing), (steps.landing, read.landing)):
        assert off(after.positions_m, before.positions_m) <= FOOTPRINT_M / 2 + 1e-9
        turned = np.angle(np.exp(1j * (after.headings_rad - before.headings_rad)))
        assert np.abs(turned).max() <= FOOTPRINT_RAD / 2 + 1e-9
    keys, known = read.keys, steps.keys
    assert off(keys.roots_m, known.roots_m) <= KEY_M / 2 + 1e-9 < LEGS_M
    assert off(keys.ankles_m, known.ankles_m) <= KEY_M / 2 + 1e-9 < LEGS_M
    assert off(keys.swing_pitches_rad, known.swing_pitches_rad) <= FOOT_RAD / 2 + 1e-9 < LEGS_RAD
    assert off(keys.standing_pitches_rad, known.standing_pitches_rad) <= FOOT_RAD / 2 + 1e-9
    turned = np.angle(np.exp(1j * (keys.swing_headings_rad - known.swing_headings_rad)))
    assert np.abs(turned).max() <= FOOT_RAD / 2 + 1e-9
    assert turned_rad(keys.pelvises, known.pelvises).max() < np.radians(0.01) < LEGS_RAD
    assert turned_rad(keys.chests, known.chests).max() < TRUNK_RAD
    assert off(keys.arms_rad, known.arms_rad) <= ARM_RAD / 2 + 1e-9 < TRUNK_RAD


@given(st.integers(0, 2**32 - 1))
def test_what_was_read_is_packed_to_the_same_bytes(seed: int) -> None:
    """Packing the values of a record again changes nothing."""
    records = pack_steps(made_up_steps(4, seed))
    again = pack_steps(unpack_steps(records))
    assert again["standing"].tobytes() == records["standing"].tobytes()
    assert again["landing"].tobytes() == records["landing"].tobytes()
    for name in KEY.names or ():
        if name != "pelvis":  # of two components that are nearly the largest, either may be
            np.testing.assert_array_equal(again["keys"][name], records["keys"][name], name)


def test_a_swing_heading_stays_whole_over_the_keys() -> None:
    """Interpolating between keys must not run the long way around."""
    steps = made_up_steps(1)
    headings = np.linspace(np.pi - 0.3, np.pi + 0.3, KEYS)[None]
    landing = Footprints(steps.landing.positions_m, np.array([-np.pi + 0.3]))
    keys = replace(steps.keys, swing_headings_rad=headings)
    read = unpack_steps(pack_steps(replace(steps, landing=landing, keys=keys)))
    np.testing.assert_allclose(np.diff(read.keys.swing_headings_rad), 0.12, atol=FOOT_RAD)


def test_what_lies_outside_is_clamped_to_the_edge() -> None:
    steps = made_up_steps(2)
    far = np.zeros((2, KEYS, 3)) + np.array([1e3, -1e3])[:, None, None]
    keys = replace(
        steps.keys,
        roots_m=far,
        ankles_m=far,
        arms_rad=np.full((2, KEYS, 4), -9.0),
        standing_pitches_rad=np.full((2, KEYS), 9.0),
    )
    wide = replace(steps, keys=keys, lifts=np.array([-1.0, 2.0]), durations_ticks=np.full(2, 300))
    records = pack_steps(wide)
    assert set(records["keys"]["root"].ravel().tolist()) == {32767, -32767}
    assert set(records["keys"]["ankle"].ravel().tolist()) == {32767, -32767}
    assert set(records["keys"]["arms"].ravel().tolist()) == {-127}
    assert set(records["keys"]["standing_pitch"].ravel().tolist()) == {32767}
    assert records["lift"].tolist() == [0, 255]
    assert records["ticks"].tolist() == [255, 255]


def test_the_layout_byte_by_byte() -> None:
    upright = np.broadcast_to([1.0, 0.0, 0.0, 0.0], (1, KEYS, 4))
    angles = np.zeros((1, KEYS))
    steps = Steps(
        ids=np.array([0x01020304]),
        on_right=np.array([True]),
        re_aimed=np.array([True]),
        begin_ticks=np.array([0x05060708]),
        durations_ticks=np.array([9]),
        standing=Footprints(np.array([[1.0, -1.0, 0.25]]), np.array([np.pi / 2])),
        landing=Footprints(np.array([[1.5, -1.0, 0.25]]), np.array([-np.pi / 2])),
        lifts=np.array([1.0]),
        keys=Keys(
            roots_m=np.broadcast_to([1.25, -1.0, 1.125], (1, KEYS, 3)),
            pelvises=upright,
            ankles_m=np.broadcast_to([1.0, -1.0, 0.25], (1, KEYS, 3)),
            swing_pitches_rad=angles + 0.1,
            standing_pitches_rad=angles - 0.1,
            swing_headings_rad=angles - np.pi / 2 + 0.01,
            chests=upright,
            arms_rad=np.full((1, KEYS, 4), 0.5),
        ),
    )
    block = pack_steps(steps).tobytes()
    assert len(block) == STEP.itemsize == 228
    assert block[:42].hex(" ") == (
        "01 e4 00 04 03 02 01 03 08 07 06 05 09 "
        "10 27 00 00 f0 d8 ff ff c4 09 00 00 00 40 "
        "98 3a 00 00 f0 d8 ff ff c4 09 00 00 00 c0 ff"
    )
    assert block[42:73].hex(" ") == (
        "c4 09 00 00 2e 22 00 40 00 40 00 40 78 ec 00 00 00 00 e8 03 18 fc 64 00 "
        "00 00 00 14 14 14 14"
    )
    assert block[42:] == block[42:73] * KEYS


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
    assert len(step_records(b"\x02\xe4\x00" + bytes(STEP.itemsize - 3))) == 0


def test_a_walking_step_of_a_later_version_may_be_twice_as_long() -> None:
    longer = new_step_records(1)
    longer["id"], longer["length"] = 12, 2 * STEP.itemsize
    assert step_records(longer.tobytes() + bytes(STEP.itemsize))["id"].tolist() == [12]


WALK = new_step_records(1).tobytes()


@pytest.mark.parametrize(
    ("block", "fault"),
    [
        (b"\x01", "record 0 at byte 0 of a block of steps ends after 1 of the 3 bytes of its head"),
        (WALK + b"\x02\x03", "record 1 at byte 228 .* ends after 2 of the 3 bytes of its head"),
        (bytes(228), "record 0 at byte 0 .* length of 0 bytes, one of kind 0 has at least 3"),
        (WALK + b"\x02\x00\x00", "record 1 at byte 228 .* length of 0 bytes, .* at least 3"),
        (WALK + b"\x02\x02\x00", "record 1 at byte 228 .* length of 2 bytes, .* at least 3"),
        (
            b"\x02\x04\x00\x00\x01\xe3\x00" + WALK[3:-1],
            "record 1 at byte 4 .* length of 227 bytes, one of kind 1 has at least 228",
        ),
        (WALK[:-1], "record 0 at byte 0 .* length of 228 bytes, 227 are left"),
        (WALK + b"\x02\xff\xff", "record 1 at byte 228 .* length of 65535 bytes, 3 are left"),
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
