"""Steps of feet, quantised into records of the wire and read back, one step after the other."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion.motion._key_pose_kernels import (
    ANKLE,
    ARMS,
    CHEST,
    KEYS,
    PELVIS,
    STANDING_PITCH,
    SWING_HEADING,
    SWING_PITCH,
)
from esplanade.actors.locomotion.motion.key_poses import Steps
from esplanade.actors.locomotion.planted.footprints import HEADING
from esplanade.planning.compiled.arrays import Floats, Ints
from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.server.world.compiled._keys_between_kernels import (
    ANKLE_N,
    ARMS_N,
    LEAN_N,
    NUMBERS,
    ROLL_N,
    STANDING_PITCH_N,
    SWING_HEADING_N,
    SWING_PITCH_N,
    TWIST_N,
    YAW_N,
    code_keys_between,
    read_keys_between,
)

_TURN = 2.0 * math.pi
_SHORT = 0x7FFF
_BYTE = 0x7F


class Layout(NamedTuple):
    """Flags and quanta of the records, as in `esplanade.protocol.steps`."""

    stands_on_right: int
    re_aimed: int
    flight_shift: int
    most_flight: int
    flight: float
    most_ticks: int
    footprint_m: float
    footprint_rad: float
    key_m: float
    foot_rad: float
    trunk_rad: float
    arm_rad: float


@inlined
def _quantised(value: float, quantum: float, most: int) -> int:
    """The multiple of a quantum nearest to a value, clamped to `most` on both sides."""
    return int(min(max(np.rint(value / quantum), -float(most)), float(most)))


@inlined
def _quantise_trunk(key: Floats, layout: Layout, out: Ints) -> None:
    """Write yaw, lean, roll and twist of a key (WIDTH,) to numbers (NUMBERS,)."""
    w, x, y, z = key[PELVIS], key[PELVIS + 1], key[PELVIS + 2], key[PELVIS + 3]
    yaw = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    lean = math.asin(min(max(2.0 * (w * y - z * x), -1.0), 1.0))
    roll = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    out[YAW_N] = int(np.rint(yaw / layout.footprint_rad)) & 0xFFFF
    out[LEAN_N] = _quantised(lean, layout.trunk_rad, _BYTE)
    out[ROLL_N] = _quantised(roll, layout.trunk_rad, _BYTE)
    c, s = math.cos(0.5 * roll), math.sin(0.5 * roll)
    along = c * key[CHEST] - s * key[CHEST + 1]
    across = c * key[CHEST + 3] + s * key[CHEST + 2]
    sign = -1.0 if along < 0.0 else 1.0
    twist = 2.0 * math.atan2(sign * across, sign * along)
    out[TWIST_N] = _quantised(twist, layout.trunk_rad, _BYTE)


@inlined
def _read_trunk(numbers: Ints, layout: Layout, key: Floats) -> None:
    """Write the rotations of pelvis and chest to a key (WIDTH,) from numbers (NUMBERS,)."""
    yaw = numbers[YAW_N] * layout.footprint_rad
    lean, roll = numbers[LEAN_N] * layout.trunk_rad, numbers[ROLL_N] * layout.trunk_rad
    twist = numbers[TWIST_N] * layout.trunk_rad
    cz, cy, cx = math.cos(0.5 * yaw), math.cos(0.5 * lean), math.cos(0.5 * roll)
    sz, sy, sx = math.sin(0.5 * yaw), math.sin(0.5 * lean), math.sin(0.5 * roll)
    key[PELVIS] = cz * cy * cx + sz * sy * sx
    key[PELVIS + 1] = cz * cy * sx - sz * sy * cx
    key[PELVIS + 2] = cz * sy * cx + sz * cy * sx
    key[PELVIS + 3] = sz * cy * cx - cz * sy * sx
    ct, st = math.cos(0.5 * twist), math.sin(0.5 * twist)
    key[CHEST], key[CHEST + 1] = cx * ct, -(sx * ct)
    key[CHEST + 2], key[CHEST + 3] = sx * st, cx * st


@kernel
def write_records(
    steps: Steps,
    ids: Ints,
    layout: Layout,
    records: NDArray[np.void],
    multiples: NDArray[np.int8],
) -> None:
    """Quantise N steps of the avatars with ids (N,) into records, STEP (N,).

    Keys are relative to the quantised footprints, which readers add to them. `multiples`
    (N, KEYS - 2, BYTES) are those bytes of the records.
    """
    numbers = np.empty((KEYS, NUMBERS), np.int64)
    for i in range(len(records)):
        record = records[i]
        record.id = ids[i]
        record.flags = layout.stands_on_right * steps.on_right[i] + (
            layout.re_aimed * steps.re_aimed[i]
        )
        flown = int(np.rint(max(steps.flight[i], 0.0) / layout.flight))
        record.flags |= min(flown, layout.most_flight) << layout.flight_shift
        record.tick = steps.start[i] & 0xFFFF_FFFF
        record.ticks = min(max(steps.ticks[i], 0), layout.most_ticks)
        record.lift = int(np.rint(min(max(steps.lift[i], 0.0), 1.0) * 0xFF))
        for d in range(3):
            stands = int(np.rint(steps.standing[i, d] / layout.footprint_m))
            lands = int(np.rint(steps.landing[i, d] / layout.footprint_m))
            record.standing.position[d] = stands
            record.landing.offset[d] = min(max(lands - stands, -_SHORT), _SHORT)
        turned = int(np.rint(steps.standing[i, HEADING] / layout.footprint_rad))
        record.standing.heading = turned & 0xFFFF
        turned = int(np.rint(steps.landing[i, HEADING] / layout.footprint_rad))
        record.landing.heading = turned & 0xFFFF
        _quantise_keys(steps, i, layout, record, numbers)
        _write_end(numbers[0], record.first)
        _write_end(numbers[KEYS - 1], record.last)
        for d in range(3):
            record.ankle[d] = numbers[0, ANKLE_N + d]
        record.swing_heading = numbers[0, SWING_HEADING_N]
        code_keys_between(numbers, steps.re_aimed[i], record, multiples[i])


@inlined
def _quantise_keys(steps: Steps, i: int, layout: Layout, record: Any, numbers: Ints) -> None:
    """Write the keys of step i to numbers (KEYS, NUMBERS), from the footprints of its record."""
    landing_heading = record.landing.heading * layout.footprint_rad
    for k in range(KEYS):
        key, out = steps.keys[i, k], numbers[k]
        for d in range(3):
            stands = int(record.standing.position[d])
            place = key[d] + steps.standing[i, d]
            out[d] = _quantised(place - stands * layout.footprint_m, layout.key_m, _SHORT)
            lands = stands + int(record.landing.offset[d])
            place = key[ANKLE + d] + steps.landing[i, d]
            ankle = _quantised(place - lands * layout.footprint_m, layout.key_m, _SHORT)
            # The swing foot lands on its footprint.
            out[ANKLE_N + d] = ankle if k < KEYS - 1 else 0
        _quantise_trunk(key, layout, out)
        out[SWING_PITCH_N] = _quantised(key[SWING_PITCH], layout.foot_rad, _SHORT)
        out[STANDING_PITCH_N] = _quantised(key[STANDING_PITCH], layout.foot_rad, _SHORT)
        apart = key[SWING_HEADING] + steps.landing[i, HEADING] - landing_heading
        apart = (apart + math.pi) % _TURN - math.pi
        heading = _quantised(apart, layout.foot_rad, _SHORT)
        out[SWING_HEADING_N] = heading if k < KEYS - 1 else 0
        for d in range(4):
            out[ARMS_N + d] = _quantised(key[ARMS + d], layout.arm_rad, _BYTE)


@inlined
def _write_end(numbers: Ints, end: Any) -> None:
    for d in range(3):
        end.root[d] = numbers[d]
    end.yaw = numbers[YAW_N]
    end.swing_pitch, end.standing_pitch = numbers[SWING_PITCH_N], numbers[STANDING_PITCH_N]
    end.lean, end.roll, end.twist = numbers[LEAN_N], numbers[ROLL_N], numbers[TWIST_N]
    for d in range(4):
        end.arms[d] = numbers[ARMS_N + d]


@inlined
def _read_end(end: Any, numbers: Ints) -> None:
    for d in range(3):
        numbers[d] = end.root[d]
        numbers[ANKLE_N + d] = 0
    numbers[YAW_N], numbers[SWING_HEADING_N] = end.yaw, 0
    numbers[SWING_PITCH_N], numbers[STANDING_PITCH_N] = end.swing_pitch, end.standing_pitch
    numbers[LEAN_N], numbers[ROLL_N], numbers[TWIST_N] = end.lean, end.roll, end.twist
    for d in range(4):
        numbers[ARMS_N + d] = end.arms[d]


@kernel
def read_records(
    records: NDArray[np.void], multiples: NDArray[np.int8], layout: Layout, out: Steps
) -> None:
    """Write N steps as readers of records, STEP (N,), know them.

    Quaternions of keys get the sign nearest to the key before. `multiples` (N, KEYS - 2, BYTES)
    are those bytes of the records.
    """
    numbers = np.empty((KEYS, NUMBERS), np.int64)
    for i in range(len(records)):
        record = records[i]
        out.on_right[i] = record.flags & layout.stands_on_right != 0
        out.re_aimed[i] = record.flags & layout.re_aimed != 0
        out.start[i], out.ticks[i] = record.tick, record.ticks
        out.lift[i] = record.lift / 0xFF
        out.flight[i] = (record.flags >> layout.flight_shift) * layout.flight
        for d in range(3):
            stands = int(record.standing.position[d])
            out.standing[i, d] = stands * layout.footprint_m
            lands = stands + int(record.landing.offset[d])
            out.landing[i, d] = lands * layout.footprint_m
        out.standing[i, HEADING] = record.standing.heading * layout.footprint_rad
        out.landing[i, HEADING] = record.landing.heading * layout.footprint_rad
        _read_end(record.first, numbers[0])
        _read_end(record.last, numbers[KEYS - 1])
        for d in range(3):
            numbers[0, ANKLE_N + d] = record.ankle[d]
        numbers[0, SWING_HEADING_N] = record.swing_heading
        read_keys_between(record, multiples[i], out.re_aimed[i], numbers)
        for k in range(KEYS):
            _read_key(numbers[k], layout, out.standing[i], out.landing[i], out.keys[i, k])
            if k > 0:
                _align(out.keys[i, k - 1], out.keys[i, k], PELVIS)
                _align(out.keys[i, k - 1], out.keys[i, k], CHEST)


@inlined
def _read_key(
    numbers: Ints, layout: Layout, standing: Floats, landing: Floats, key: Floats
) -> None:
    """Write a key (WIDTH,) as readers know it from its numbers (NUMBERS,)."""
    for d in range(3):
        # Sums and differences as readers make them who know places in the world.
        place = numbers[d] * layout.key_m + standing[d]
        key[d] = place - standing[d]
        place = numbers[ANKLE_N + d] * layout.key_m + landing[d]
        key[ANKLE + d] = place - landing[d]
    _read_trunk(numbers, layout, key)
    key[SWING_PITCH] = numbers[SWING_PITCH_N] * layout.foot_rad
    key[STANDING_PITCH] = numbers[STANDING_PITCH_N] * layout.foot_rad
    heading = numbers[SWING_HEADING_N] * layout.foot_rad + landing[HEADING]
    key[SWING_HEADING] = heading - landing[HEADING]
    for d in range(4):
        key[ARMS + d] = numbers[ARMS_N + d] * layout.arm_rad


@inlined
def _align(before: Floats, key: Floats, first: int) -> None:
    """Give the quaternion from a column on the sign nearest to that of the key before."""
    dot = 0.0
    for d in range(first, first + 4):
        dot += key[d] * before[d]
    if dot < 0.0:
        for d in range(first, first + 4):
            key[d] *= -1.0
