"""The four keys between the ends of a walking step, as small differences from what ends foretell.

All of it is arithmetic of integers, in the quanta of `esplanade.protocol.steps`, so every reader
gets the same numbers. A key is a row of 17 of them, in the order of the groups:

* root (3), ankle (3), yaw, swing pitch, standing pitch and swing heading, a byte each;
* lean, roll and twist (3), and arms (4), half a byte each.

From the ends a reader foretells each number by the straight line from the first key to the last,
rounded down, but for two groups. Standing pitches are foretold to be 0, and so the sole of a flat
foot stays flat. The ankle of a step that is not re-aimed has the share `FAR` of its way before it.
The difference is kept as a multiple of a power of two, the smallest with which the largest of its
group in the step has room; so nothing is ever clamped.
"""

from typing import Final

import numpy as np
import numpy.typing as npt

Integers = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]

KEYS: Final = 6
"""Keys of a step, at the shares 0, 0.2, 0.4, 0.6, 0.8 and 1 of its duration."""
BETWEEN: Final = KEYS - 2
NUMBERS: Final = 17
BYTES: Final = 10
"""Numbers of a key whose differences have a byte each; they are the first."""

ANKLE: Final = slice(3, 6)
YAW: Final = 6
STANDING_PITCH: Final = 8
GROUPS: Final = np.array([0, 0, 0, 1, 1, 1, 2, 3, 4, 5, 6, 6, 6, 7, 7, 7, 7])
"""The group of each number; four bits of the shifts are the exponent of each group."""
MOST: Final = np.where(np.arange(NUMBERS) < BYTES, 0x7F, 7)
"""The largest difference that there is room for, in multiples."""
FAR: Final = (250, 229, 169, 41)
"""The share of its way, in 1/256, that a swing foot has before it at each key; medians of walks."""

_EXPONENTS: Final = 16


def pack_between(numbers: Integers, re_aimed: Flags) -> tuple[Integers, Integers, Integers]:
    """The differences of N steps, whose keys are numbers (N, KEYS, NUMBERS).

    Returns
    -------
    shifts (N,), unsigned with 32 bits
    bytes (N, BETWEEN, BYTES), with a sign
    words (N, NUMBERS - BYTES), unsigned with 16 bits: four differences, the first key's lowest
    """
    apart = numbers[:, 1:-1] - _foretold(numbers[:, 0], numbers[:, -1], re_aimed)
    apart[..., YAW] = _within_half_a_turn(apart[..., YAW])
    largest = np.abs(apart).max(axis=1)
    shifts = np.zeros(len(numbers), dtype=np.int64)
    exponents = np.zeros((len(numbers), NUMBERS), dtype=np.int64)
    for group in range(GROUPS[-1] + 1):
        of_group = np.flatnonzero(group == GROUPS)
        room = MOST[of_group[0]] << np.arange(_EXPONENTS)
        exponent = np.searchsorted(room, largest[:, of_group].max(axis=1))
        exponents[:, of_group] = exponent[:, None]
        shifts |= exponent << 4 * group
    half = (1 << exponents) >> 1
    multiples = (apart + half[:, None]) >> exponents[:, None]
    words = (multiples[..., BYTES:] & 0xF) << 4 * np.arange(BETWEEN)[:, None]
    return shifts, multiples[..., :BYTES], words.sum(axis=1)


def unpack_between(
    first: Integers, last: Integers, re_aimed: Flags, packed: tuple[Integers, Integers, Integers]
) -> Integers:
    """The numbers (N, KEYS, NUMBERS) of N steps from those of their ends (N, NUMBERS)."""
    shifts, bytes_, words = packed
    exponents = (shifts[:, None] >> 4 * GROUPS) & 0xF
    small = (words[:, None, :] >> 4 * np.arange(BETWEEN)[:, None]) & 0xF
    multiples = np.concatenate([bytes_, (small ^ 8) - 8], axis=2)
    between = _foretold(first, last, re_aimed) + (multiples << exponents[:, None])
    return np.concatenate([first[:, None], between, last[:, None]], axis=1)


def _foretold(first: Integers, last: Integers, re_aimed: Flags) -> Integers:
    """The numbers (N, BETWEEN, NUMBERS) that readers expect after the ends (N, NUMBERS)."""
    change = last - first
    change[:, YAW] = _within_half_a_turn(change[:, YAW])
    gone = np.arange(1, KEYS - 1)[:, None]
    between: Integers = first[:, None] + change[:, None] * gone // (KEYS - 1)
    between[..., STANDING_PITCH] = 0
    far = first[:, None, ANKLE] * np.array(FAR)[:, None] >> 8
    between[..., ANKLE] = np.where(re_aimed[:, None, None], between[..., ANKLE], far)
    return between


def _within_half_a_turn(yaws: Integers) -> Integers:
    return (yaws + 0x8000 & 0xFFFF) - 0x8000
