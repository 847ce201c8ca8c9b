"""The keys between the ends of a step, in few bits: `esplanade.protocol.keys_between`, compiled.

A key is a row of 17 whole numbers here too, in the same order and the same quanta.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion.motion._key_pose_kernels import KEYS
from esplanade.planning.compiled.arrays import Ints
from esplanade.planning.compiled.jit import inlined, kernel

NUMBERS = 17
BYTES = 10
GROUPS = 8

# First columns of the parts of a row. The root is first.
ANKLE_N = 3
YAW_N = 6
SWING_PITCH_N = 7
STANDING_PITCH_N = 8
SWING_HEADING_N = 9
LEAN_N = 10
ROLL_N = 11
TWIST_N = 12
ARMS_N = 13

_FIRST_OF_GROUP = np.array([0, 3, 6, 7, 8, 9, 10, 13, 17])
FAR = np.array([256, 250, 229, 169, 41, 0])
"""The share of its way, in 1/256, that a swing foot has before it at each key."""


@inlined
def within_half_a_turn(yaw: int) -> int:
    """The same angle, in 1/65536 turns, at least -0x8000 and less than 0x8000."""
    return int(((yaw + 0x8000) & 0xFFFF) - 0x8000)


@inlined
def _foretold(numbers: Ints, k: int, c: int, re_aimed: bool) -> int:
    """The number in column c of key k that readers expect after the first row and the last."""
    first = numbers[0, c]
    if c == STANDING_PITCH_N:
        return 0
    if ANKLE_N <= c < YAW_N and not re_aimed:
        return int((first * FAR[k]) >> 8)
    change = numbers[KEYS - 1, c] - first
    if c == YAW_N:
        change = within_half_a_turn(change)
    return int(first + change * k // (KEYS - 1))


@kernel
def code_keys_between(
    numbers: Ints, re_aimed: bool, record: Any, multiples: NDArray[np.int8]
) -> None:
    """Write all but the ends of numbers (KEYS, NUMBERS) to a record, and change them.

    They become the multiples, of which those that have a byte go to `multiples` (KEYS - 2, BYTES).
    """
    shifts = 0
    for k in range(1, KEYS - 1):
        for c in range(NUMBERS):
            apart = numbers[k, c] - _foretold(numbers, k, c, re_aimed)
            numbers[k, c] = within_half_a_turn(apart) if c == YAW_N else apart
    for group in range(GROUPS):
        begin, end = _FIRST_OF_GROUP[group], _FIRST_OF_GROUP[group + 1]
        largest = 0
        for k in range(1, KEYS - 1):
            for c in range(begin, end):
                largest = max(largest, abs(numbers[k, c]))
        most = 0x7F if begin < BYTES else 7
        exponent = 0
        while largest > most << exponent:
            exponent += 1
        shifts |= exponent << (4 * group)
        half = (1 << exponent) >> 1
        for c in range(begin, end):
            word = 0
            for k in range(1, KEYS - 1):
                multiple = (numbers[k, c] + half) >> exponent
                if c < BYTES:
                    multiples[k - 1, c] = multiple
                else:
                    word |= (multiple & 0xF) << (4 * (k - 1))
            if c >= ARMS_N:
                record.arms[c - ARMS_N] = word
            elif c >= BYTES:
                record.trunk[c - BYTES] = word
    record.shifts = shifts


@kernel
def read_keys_between(
    record: Any, multiples: NDArray[np.int8], re_aimed: bool, numbers: Ints
) -> None:
    """Fill the rows between the first and the last of numbers (KEYS, NUMBERS) from a record."""
    for group in range(GROUPS):
        exponent = (int(record.shifts) >> (4 * group)) & 0xF
        for c in range(_FIRST_OF_GROUP[group], _FIRST_OF_GROUP[group + 1]):
            word = 0
            if c >= ARMS_N:
                word = int(record.arms[c - ARMS_N])
            elif c >= BYTES:
                word = int(record.trunk[c - BYTES])
            for k in range(1, KEYS - 1):
                if c < BYTES:
                    multiple = int(multiples[k - 1, c])
                else:
                    multiple = (((word >> (4 * (k - 1))) & 0xF) ^ 8) - 8
                foretold = _foretold(numbers, k, c, re_aimed)
                numbers[k, c] = foretold + (multiple << exponent)
