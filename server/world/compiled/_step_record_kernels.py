"""Steps of feet, quantised into records of the wire and read back, one step after the other."""

from __future__ import annotations

import math
from typing import NamedTuple

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

_TURN = 2.0 * math.pi
_ZERO = 0x4000
_VALUE_BITS = 0x7FFF
_SHORT = 0x7FFF
_BYTE = 0x7F

EXACT = 1e-6
"""A component is a multiple of its quantum if it is no more of them away from one."""
LARGE = 0.49
"""A component that is left out is larger than this."""


class Layout(NamedTuple):
    """Flags and quanta of the records, as in `esplanade.protocol.steps`."""

    stands_on_right: int
    re_aimed: int
    most_ticks: int
    footprint_m: float
    footprint_rad: float
    key_m: float
    foot_rad: float
    arm_rad: float
    smallest_three: float
    near_identity: float


@inlined
def _quantised(value: float, quantum: float, most: int) -> int:
    """The multiple of a quantum nearest to a value, clamped to `most` on both sides."""
    return int(min(max(np.rint(value / quantum), -float(most)), float(most)))


@inlined
def _make_unit(rotation: Floats) -> None:
    square = 0.0
    for d in range(4):
        square += rotation[d] * rotation[d]
    length = math.sqrt(square)
    for d in range(4):
        rotation[d] /= length


@kernel
def _read_rotation(words: NDArray[np.uint16], quantum: float, out: Floats) -> None:
    """Read a quaternion (4,) from its smallest three, as `unpack_smallest_three` does."""
    place = (words[0] >> 15) | (words[1] >> 15 << 1)
    word, square = 0, 0.0
    for d in range(4):
        if d != place:
            out[d] = (int(words[word] & _VALUE_BITS) - _ZERO) * quantum
            square += out[d] * out[d]
            word += 1
    out[place] = math.sqrt(max(1.0 - square, 0.0))
    _make_unit(out)


@inlined
def _left_out(rotation: Floats, quantum: float) -> int:
    """The place of the component that is left out, as `esplanade.protocol.quaternions` has it."""
    largest = 0
    for place in range(4):
        if abs(rotation[place]) > abs(rotation[largest]):
            largest = place
    for place in range(4):
        exact = abs(rotation[place]) > LARGE
        for d in range(4):
            if d != place:
                multiple = rotation[d] / quantum
                near = abs(multiple - np.rint(multiple)) < EXACT
                exact = exact and near and abs(multiple) < _ZERO - 0.5
        if exact:
            return place
    return largest


@kernel
def _write_rotation(
    rotation: Floats, words: NDArray[np.uint16], quantum: float, known: Floats
) -> None:
    """Write a quaternion (4,) as its smallest three, as `pack_smallest_three` does.

    `known` (4,) becomes the rotation that readers know.
    """
    for d in range(4):
        known[d] = rotation[d]
    for _ in range(2):
        place = _left_out(known, quantum)
        word = 0
        for d in range(4):
            if d != place:
                signed = math.copysign(known[d], known[d] * known[place])
                value = _quantised(signed, quantum, _ZERO - 1) + _ZERO
                if word < 2:
                    value |= ((place >> word) & 1) << 15
                words[word] = value
                word += 1
        _read_rotation(words, quantum, known)


@kernel
def write_records(steps: Steps, ids: Ints, layout: Layout, records: NDArray[np.void]) -> None:
    """Quantise N steps of the avatars with ids (N,) into records, STEP (N,).

    Keys are relative to the quantised footprints, which readers add to them.
    """
    known = np.empty(4)
    for i in range(len(records)):
        record = records[i]
        record.id = ids[i]
        record.flags = layout.stands_on_right * steps.on_right[i] + (
            layout.re_aimed * steps.re_aimed[i]
        )
        record.tick = steps.start[i] & 0xFFFF_FFFF
        record.ticks = min(max(steps.ticks[i], 0), layout.most_ticks)
        record.lift = int(np.rint(min(max(steps.lift[i], 0.0), 1.0) * 0xFF))
        for d in range(3):
            record.standing.position[d] = int(np.rint(steps.standing[i, d] / layout.footprint_m))
            record.landing.position[d] = int(np.rint(steps.landing[i, d] / layout.footprint_m))
        turned = int(np.rint(steps.standing[i, HEADING] / layout.footprint_rad))
        record.standing.heading = turned & 0xFFFF
        turned = int(np.rint(steps.landing[i, HEADING] / layout.footprint_rad))
        record.landing.heading = turned & 0xFFFF
        landing_heading = record.landing.heading * layout.footprint_rad
        for k in range(KEYS):
            key, out = steps.keys[i, k], record.keys[k]
            for d in range(3):
                place = key[d] + steps.standing[i, d]
                from_m = record.standing.position[d] * layout.footprint_m
                out.root[d] = _quantised(place - from_m, layout.key_m, _SHORT)
                place = key[ANKLE + d] + steps.landing[i, d]
                from_m = record.landing.position[d] * layout.footprint_m
                out.ankle[d] = _quantised(place - from_m, layout.key_m, _SHORT)
            _write_rotation(key[PELVIS : PELVIS + 4], out.pelvis, layout.smallest_three, known)
            out.swing_pitch = _quantised(key[SWING_PITCH], layout.foot_rad, _SHORT)
            out.standing_pitch = _quantised(key[STANDING_PITCH], layout.foot_rad, _SHORT)
            apart = key[SWING_HEADING] + steps.landing[i, HEADING] - landing_heading
            apart = (apart + math.pi) % _TURN - math.pi
            out.swing_heading = _quantised(apart, layout.foot_rad, _SHORT)
            sign = -1.0 if key[CHEST] < 0.0 else 1.0
            for d in range(3):
                upward = sign * key[CHEST + 1 + d]
                out.chest[d] = _quantised(upward, layout.near_identity, _BYTE)
            for d in range(4):
                out.arms[d] = _quantised(key[ARMS + d], layout.arm_rad, _BYTE)


@kernel
def read_records(records: NDArray[np.void], layout: Layout, out: Steps) -> None:
    """Write N steps as readers of records, STEP (N,), know them.

    Quaternions of keys get the sign nearest to the key before.
    """
    for i in range(len(records)):
        record = records[i]
        out.on_right[i] = record.flags & layout.stands_on_right != 0
        out.re_aimed[i] = record.flags & layout.re_aimed != 0
        out.start[i], out.ticks[i] = record.tick, record.ticks
        out.lift[i] = record.lift / 0xFF
        for d in range(3):
            out.standing[i, d] = record.standing.position[d] * layout.footprint_m
            out.landing[i, d] = record.landing.position[d] * layout.footprint_m
        out.standing[i, HEADING] = record.standing.heading * layout.footprint_rad
        out.landing[i, HEADING] = record.landing.heading * layout.footprint_rad
        for k in range(KEYS):
            packed, key = record.keys[k], out.keys[i, k]
            for d in range(3):
                # Sums and differences as readers make them who know places in the world.
                place = packed.root[d] * layout.key_m + out.standing[i, d]
                key[d] = place - out.standing[i, d]
                place = packed.ankle[d] * layout.key_m + out.landing[i, d]
                key[ANKLE + d] = place - out.landing[i, d]
                key[CHEST + 1 + d] = packed.chest[d] * layout.near_identity
            _read_rotation(packed.pelvis, layout.smallest_three, key[PELVIS : PELVIS + 4])
            square = 0.0
            for d in range(1, 4):
                square += key[CHEST + d] * key[CHEST + d]
            key[CHEST] = math.sqrt(max(1.0 - square, 0.0))
            _make_unit(key[CHEST : CHEST + 4])
            key[SWING_PITCH] = packed.swing_pitch * layout.foot_rad
            key[STANDING_PITCH] = packed.standing_pitch * layout.foot_rad
            heading = packed.swing_heading * layout.foot_rad + out.landing[i, HEADING]
            key[SWING_HEADING] = heading - out.landing[i, HEADING]
            for d in range(4):
                key[ARMS + d] = packed.arms[d] * layout.arm_rad
            if k > 0:
                _align(out.keys[i, k - 1], key, PELVIS)
                _align(out.keys[i, k - 1], key, CHEST)


@inlined
def _align(before: Floats, key: Floats, first: int) -> None:
    """Give the quaternion from a column on the sign nearest to that of the key before."""
    dot = 0.0
    for d in range(first, first + 4):
        dot += key[d] * before[d]
    if dot < 0.0:
        for d in range(first, first + 4):
            key[d] *= -1.0
