"""The packed block: layout, bounds of quantisation, clamping at the edges."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.protocol.snapshot import (
    HEADING_RAD,
    MAX_EXTENT_M,
    POSITION_M,
    RECORD,
    SPEED_MPS,
    Records,
    find_position_m,
    headings_rad,
    heights_m,
    pack_records,
    positions_m,
    speeds_mps,
    unpack_block,
)

ORIGIN = (-10.0, -5.0)

Row = tuple[int, int, int, float, float, float, float, float]


def pack(
    avatars: list[Row],
    origin_m: tuple[float, float] = ORIGIN,
) -> Records:
    """Rows of (id, layer, reason, x, y, z, heading, speed)."""
    ids, layers, reasons, xs, ys, zs, headings, speeds = np.array(avatars, dtype=np.float64).T
    return pack_records(
        ids.astype(np.int64),
        layers.astype(np.int64),
        reasons.astype(np.int64),
        np.stack([xs, ys], axis=1),
        zs,
        headings,
        speeds,
        origin_m,
    )


avatars = st.lists(
    st.tuples(
        st.integers(0, 2**32 - 1),
        st.integers(0, 255),
        st.integers(0, 6),
        st.floats(0, MAX_EXTENT_M),
        st.floats(0, MAX_EXTENT_M),
        st.floats(-327.68, 327.67),
        st.floats(-100, 100),
        st.floats(0, 255 * SPEED_MPS),
    ),
    min_size=1,
    max_size=20,
)


@given(avatars, st.tuples(st.floats(-1e5, 1e5), st.floats(-1e5, 1e5)))
def test_what_comes_back_is_as_near_as_the_steps_allow(
    rows: list[Row], origin: tuple[float, float]
) -> None:
    placed = [(i, f, r, x + origin[0], y + origin[1], z, h, s) for i, f, r, x, y, z, h, s in rows]
    records = unpack_block(pack(placed, origin).tobytes())
    ids, layers, reasons, xs, ys, zs, headings, speeds = np.array(placed).T
    np.testing.assert_array_equal(records["id"], ids)
    np.testing.assert_array_equal(records["layer"], layers)
    np.testing.assert_array_equal(records["reason"], reasons)
    off_m = np.abs(positions_m(records, origin) - np.stack([xs, ys], axis=1))
    assert off_m.max() <= POSITION_M / 2 + 1e-9
    assert np.abs(heights_m(records) - zs).max() <= POSITION_M / 2 + 1e-9
    turned = np.abs(np.angle(np.exp(1j * (headings_rad(records) - headings))))
    assert turned.max() <= HEADING_RAD / 2 + 1e-9
    assert np.abs(speeds_mps(records) - speeds).max() <= SPEED_MPS / 2 + 1e-9


def test_the_layout_byte_by_byte() -> None:
    block = pack([(0x01020304, 2, 3, 1.5, -2.0, -0.5, math.pi / 2, 1.26)]).tobytes()
    assert block.hex(" ") == "04 03 02 01 02 03 7e 04 2c 01 ce ff 40 3f"
    assert RECORD.itemsize == 14


def test_what_lies_outside_is_clamped_to_the_edge() -> None:
    records = pack([(1, 0, 0, -1e6, 1e6, 1e6, -7.0, 99.0), (2, 0, 0, 1e6, -1e6, -1e6, 7.0, -1.0)])
    assert records["x"].tolist() == [0, 65535]
    assert records["y"].tolist() == [65535, 0]
    assert records["z"].tolist() == [32767, -32768]
    assert records["speed"].tolist() == [255, 0]


def test_a_heading_just_below_a_full_turn_is_a_full_turn() -> None:
    assert pack([(1, 0, 0, 0.0, 0.0, 0.0, 2 * math.pi - 1e-6, 0.0)])["heading"].tolist() == [0]


def test_nobody_in_view_is_an_empty_block() -> None:
    assert len(unpack_block(b"")) == 0
    assert positions_m(unpack_block(b""), ORIGIN).shape == (0, 2)


@pytest.mark.parametrize("length", [1, 13, 15, 29])
def test_a_block_cut_short_is_refused(length: int) -> None:
    with pytest.raises(ValueError, match=f"block of {length} bytes is no multiple of 14"):
        unpack_block(bytes(length))


tricky = st.sampled_from([0, 1, 255, 256, 0x0101_0101, 0x0100_0000, 0x0001_0000, 2**32 - 1])


@given(
    st.lists(
        st.tuples(tricky, st.just(1), st.just(1), *[st.integers(0, 65535)] * 2, *[st.just(0)] * 3),
        max_size=8,
        unique_by=lambda row: row[0],
    ),
    tricky,
)
def test_one_position_is_found_without_unpacking(rows: list[tuple[int, ...]], wanted: int) -> None:
    """Ids made of few bytes, so that they also show up across other fields."""
    records = np.array(rows, dtype=RECORD)
    found = find_position_m(records.tobytes(), wanted, ORIGIN)
    expected = [
        tuple(place)
        for record, place in zip(records, positions_m(records, ORIGIN).tolist(), strict=True)
        if record["id"] == wanted
    ]
    assert found == (pytest.approx(expected[0]) if expected else None)
