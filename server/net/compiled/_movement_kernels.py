"""Chunks of whole frames that are movements of this version, read without a parser."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import kernel

Bytes = NDArray[np.uint8]

FINAL_BINARY = 0x82
MASKED = 0x80
HEAD_BYTES = 6
"""Bytes of a masked frame before a payload of less than 126 bytes."""
LONGEST = 125

NOT_ALL = -1
"""Something in the chunk is no whole movement."""

PAIR = 0x92
THREE_FIELDS = 0x83
SEQ, DIRECTION, SPEED = 1, 2, 4
MOST_RAD, MOST_MPS = 1000.0, 100.0
"""Limits of the fields, as messages have them."""


@kernel
def named(text: Bytes, at: int, name: Bytes) -> bool:
    """Whether a short string stands there, with something behind it."""
    if at + 1 + len(name) >= len(text) or text[at] != 0xA0 | len(name):
        return False
    same = True
    for k in range(len(name)):
        same &= text[at + 1 + k] == name[k]
    return same


@kernel
def unsigned(text: Bytes, at: int, size: int) -> int:
    """A big-endian number of so many bytes."""
    value = 0
    for k in range(size):
        value = value << 8 | int(np.int64(text[at + k]))
    return value


@kernel
def whole_number(text: Bytes, at: int) -> tuple[int, int]:
    """A number of 32 bits at most without a sign, and where it ends; 0 if there is none."""
    mark, left = int(np.int64(text[at])), len(text) - at - 1
    if mark < 0x80:
        return mark, at + 1
    if 0xCC <= mark <= 0xCE:
        size = 1 << (mark - 0xCC)
        if left >= size:
            return unsigned(text, at + 1, size), at + 1 + size
    return 0, 0


@kernel
def real_number(text: Bytes, at: int) -> tuple[float, int]:
    """A number of any kind that a client writes, and where it ends; 0 if there is none."""
    mark, left = int(np.int64(text[at])), len(text) - at - 1
    if mark == 0xCB and left >= 8:
        wide = np.empty(1, dtype=np.uint64)
        wide[0] = 0
        for k in range(8):
            wide[0] = wide[0] << np.uint64(8) | np.uint64(text[at + 1 + k])
        return wide.view(np.float64)[0], at + 9
    if mark == 0xCA and left >= 4:
        narrow = np.empty(1, dtype=np.uint32)
        narrow[0] = unsigned(text, at + 1, 4)
        return np.float64(narrow.view(np.float32)[0]), at + 5
    if mark >= 0xE0:
        return np.float64(mark - 0x100), at + 1
    if 0xD0 <= mark <= 0xD2:
        size = 1 << (mark - 0xD0)
        if left < size:
            return 0.0, 0
        value = unsigned(text, at + 1, size)
        if value >> (8 * size - 1):
            value -= 1 << (8 * size)
        return np.float64(value), at + 1 + size
    value, end = whole_number(text, at)
    return np.float64(value), end


@kernel
def movement(
    text: Bytes, code: int, seq: Bytes, direction: Bytes, speed: Bytes
) -> tuple[bool, int, float, float]:
    """Whether a payload is a good movement; its number, direction in radians, speed in m/s.

    The last three arguments but the code are the names of its fields. Whatever is refused here may
    be a movement all the same, which is for the parser to say.
    """
    number, direction_rad, speed_mps, seen = 0, 0.0, 0.0, 0
    bad = (False, 0, 0.0, 0.0)
    if len(text) < 3 or text[0] != PAIR or text[1] != code or text[2] != THREE_FIELDS:
        return bad
    at = 3
    for _ in range(3):
        if named(text, at, seq):
            seen |= SEQ
            number, at = whole_number(text, at + 1 + len(seq))
        elif named(text, at, direction):
            seen |= DIRECTION
            direction_rad, at = real_number(text, at + 1 + len(direction))
        elif named(text, at, speed):
            seen |= SPEED
            speed_mps, at = real_number(text, at + 1 + len(speed))
        else:
            return bad
        if not at:
            return bad
    if at != len(text) or seen != SEQ | DIRECTION | SPEED:
        return bad
    # No number that is none passes these either.
    if not (abs(direction_rad) <= MOST_RAD and 0.0 <= speed_mps <= MOST_MPS):
        return bad
    return True, number, direction_rad, speed_mps


@kernel
def movements(
    chunk: Bytes, code: int, seq: Bytes, direction: Bytes, speed: Bytes
) -> tuple[int, int, float, float]:
    """Number of movements that a chunk consists of, and the latest of them; or `NOT_ALL`.

    The chunk has to begin where a frame begins, and nothing that came before may wait.
    """
    count, number, direction_rad, speed_mps = 0, 0, 0.0, 0.0
    at = 0
    payload = np.empty(LONGEST, dtype=np.uint8)
    while at < len(chunk):
        if at + HEAD_BYTES > len(chunk) or chunk[at] != FINAL_BINARY:
            return NOT_ALL, 0, 0.0, 0.0
        size = int(np.int64(chunk[at + 1])) - MASKED
        begin = at + HEAD_BYTES
        if not 0 <= size <= LONGEST or begin + size > len(chunk):
            return NOT_ALL, 0, 0.0, 0.0
        for k in range(size):
            payload[k] = chunk[begin + k] ^ chunk[at + 2 + (k & 3)]
        good, number, direction_rad, speed_mps = movement(
            payload[:size], code, seq, direction, speed
        )
        if not good:
            return NOT_ALL, 0, 0.0, 0.0
        count += 1
        at = begin + size
    return count, number, direction_rad, speed_mps
