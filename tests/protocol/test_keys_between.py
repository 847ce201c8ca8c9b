"""The keys between the ends of a step: they are off by half a multiple at most."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from esplanade.protocol.keys_between import (
    ANKLE,
    BYTES,
    FAR,
    GROUPS,
    KEYS,
    NUMBERS,
    STANDING_PITCH,
    YAW,
    Flags,
    Integers,
    pack_between,
    unpack_between,
)


def made_up(seed: int, within: int) -> tuple[Integers, Flags]:
    """Numbers (9, KEYS, NUMBERS) of steps of which some are re-aimed."""
    random = np.random.default_rng(seed)
    numbers = random.integers(-within, within + 1, (9, KEYS, NUMBERS))
    numbers[..., BYTES:] = np.clip(numbers[..., BYTES:], -0x7F, 0x7F)
    numbers[..., YAW] &= 0xFFFF
    numbers[:, -1, ANKLE] = 0
    return numbers, np.arange(9) % 2 == 0


@given(st.integers(0, 2**32 - 1), st.sampled_from([0, 1, 5, 90, 3000, 0x7FFF]))
def test_nothing_is_further_off_than_half_a_multiple(seed: int, within: int) -> None:
    numbers, re_aimed = made_up(seed, within)
    packed = pack_between(numbers, re_aimed)
    shifts, bytes_, words = packed
    assert shifts.max() < 2**32
    assert np.abs(bytes_).max() <= 0x7F
    assert words.min() >= 0
    assert words.max() <= 0xFFFF
    read = unpack_between(numbers[:, 0], numbers[:, -1], re_aimed, packed)
    apart = read - numbers
    apart[..., YAW] = (apart[..., YAW] + 0x8000 & 0xFFFF) - 0x8000
    multiple = 1 << ((shifts[:, None] >> 4 * GROUPS) & 0xF)
    assert (2 * np.abs(apart) <= np.where(multiple > 1, multiple, 0)[:, None]).all()
    np.testing.assert_array_equal(read[:, [0, -1]], numbers[:, [0, -1]])


def test_the_multiple_is_the_smallest_with_room() -> None:
    numbers = np.zeros((4, KEYS, NUMBERS), dtype=np.int64)
    numbers[:, 2, 0] = [127, 128, 254, -255]
    numbers[:, 3, NUMBERS - 1] = [7, 8, -14, 15]
    shifts = pack_between(numbers, np.zeros(4, dtype=np.bool_))[0]
    assert (shifts & 0xF).tolist() == [0, 1, 1, 2]
    assert (shifts >> 28).tolist() == [0, 1, 1, 2]


def test_what_was_foretold_needs_no_differences() -> None:
    numbers = np.zeros((2, KEYS, NUMBERS), dtype=np.int64)
    numbers[:] = 10 * np.arange(KEYS)[:, None]
    numbers[..., YAW] = (0xFFE0 + 10 * np.arange(KEYS)) & 0xFFFF
    numbers[:, 1:-1, STANDING_PITCH] = 0
    numbers[0, :, ANKLE] = 2560 - 512 * np.arange(KEYS)[:, None]
    numbers[1, :, ANKLE] = 10 * np.array([256, *FAR, 0])[:, None]
    shifts, bytes_, words = pack_between(numbers, np.array([True, False]))
    assert not shifts.any()
    assert not bytes_.any()
    assert not words.any()
