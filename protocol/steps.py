"""The packed block of a `steps` message: a record for each step of a foot, little-endian.

Every record begins with its kind and its length, so that a reader passes over kinds that it does
not know. The one kind so far is the walking step; what follows is about that.

During a step the standing foot stays on its footprint while the other one, the swing foot, goes to
its landing footprint, on which it stands during the next step. A footprint is the place of the
heel on the ground, with the heading of the toe. Between the six keys, at even shares of the step's
duration, the pose is interpolated.

The server quantises a step once and goes on from what the record holds: the landing footprint of
one step is the standing footprint of the next, bit for bit.
"""

import operator
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from esplanade.protocol.keys_between import (
    ANKLE,
    BETWEEN,
    BYTES,
    NUMBERS,
    STANDING_PITCH,
    YAW,
    Flags,
    Integers,
    pack_between,
    unpack_between,
)
from esplanade.protocol.quaternions import Floats, from_angles, from_twist, to_angles, to_twist

FOOTPRINT = np.dtype([("position", "<i4", 3), ("heading", "<u2")])
"""A footprint, 14 bytes: the place in 0.1 mm, the heading in 1/65536 turns from +x."""

LANDING = np.dtype([("offset", "<i2", 3), ("heading", "<u2")])
"""A footprint by its offset from another one, 8 bytes."""

END = np.dtype(
    [
        ("root", "<i2", 3),
        ("yaw", "<u2"),
        ("swing_pitch", "<i2"),
        ("standing_pitch", "<i2"),
        ("lean", "i1"),
        ("roll", "i1"),
        ("twist", "i1"),
        ("arms", "i1", 4),
    ]
)
"""The first or the last key in a record, 19 bytes."""

DIFFERENCES = np.dtype(
    [
        ("root", "i1", 3),
        ("ankle", "i1", 3),
        ("yaw", "i1"),
        ("swing_pitch", "i1"),
        ("standing_pitch", "i1"),
        ("swing_heading", "i1"),
    ]
)
"""Differences of one of the keys between, 10 bytes; see `esplanade.protocol.keys_between`."""

HEAD = np.dtype([("kind", "u1"), ("length", "<u2")])
"""The beginning of every record, 3 bytes; the length is that of the whole record in bytes."""

_HEAD: Final = struct.Struct("<BH")

WALKING: Final = 1
"""Kind of a walking step."""

STEP = np.dtype(
    [
        *((name, HEAD[name]) for name in ("kind", "length")),
        ("id", "<u4"),
        ("flags", "u1"),
        ("tick", "<u4"),
        ("ticks", "u1"),
        ("lift", "u1"),
        ("standing", FOOTPRINT),
        ("landing", LANDING),
        ("first", END),
        ("last", END),
        ("ankle", "<i2", 3),
        ("swing_heading", "<i2"),
        ("shifts", "<u4"),
        ("between", DIFFERENCES, BETWEEN),
        ("trunk", "<u2", 3),
        ("arms", "<u2", 4),
    ]
)
"""A walking step, 140 bytes."""

_STEP_HEAD: Final = [bytes([byte]) for byte in _HEAD.pack(WALKING, STEP.itemsize)]

STANDS_ON_RIGHT: Final = 1
"""Flag of a step during which the right foot stands."""
RE_AIMED: Final = 2
"""Flag of a step that takes the place of the rest of one under way."""

FLIGHT_SHIFT: Final = 2
"""The flags above the lowest bits are the share of the step that is flown, a number of 6 bits."""
MOST_FLIGHT: Final = 0x3F

# Quanta of the fields.
FLIGHT: Final = 1.0 / 128.0
FOOTPRINT_M: Final = 1e-4
FOOTPRINT_RAD: Final = 2.0 * np.pi / 65536.0
KEY_M: Final = 1e-4
FOOT_RAD: Final = 1e-4
TRUNK_RAD: Final = 1.0 / 512.0
ARM_RAD: Final = 1.0 / 80.0
MAX_TICKS: Final = 255

# Columns of the numbers of a key, beside those that are known already.
_ROOT: Final = slice(0, 3)
_SWING_PITCH: Final = 7
_SWING_HEADING: Final = 9
_LEAN_AND_ROLL: Final = slice(10, 12)
_TWIST: Final = 12
_ARMS: Final = slice(13, 17)
_OF_END: Final[dict[str, int | slice]] = {
    "root": _ROOT,
    "yaw": YAW,
    "swing_pitch": _SWING_PITCH,
    "standing_pitch": STANDING_PITCH,
    "lean": 10,
    "roll": 11,
    "twist": _TWIST,
    "arms": _ARMS,
}

StepRecords = npt.NDArray[np.void]


@dataclass(frozen=True)
class Footprints:
    """N footprints: places (N, 3), metres in the world, and headings (N,), radians from +x."""

    positions_m: Floats
    headings_rad: Floats


@dataclass(frozen=True)
class Keys:
    """Poses of N walkers at the K keys of a step, in world axes. Quaternions are w, x, y, z."""

    roots_m: Floats
    """(N, K, 3): the middle between the hip joints, metres in the world."""
    pelvises: Floats
    """(N, K, 4): from the axes forward, left, up of a body with heading 0 to the pelvis."""
    ankles_m: Floats
    """(N, K, 3): ankle of the swing foot, metres in the world; at the end on its footprint."""
    swing_pitches_rad: Floats
    """(N, K): pitch of the swing foot, positive with the toe up."""
    standing_pitches_rad: Floats
    """(N, K): pitch of the standing foot, positive with the toe up."""
    swing_headings_rad: Floats
    """(N, K): heading of the swing foot, within half a turn of the landing footprint's; at the end
    it is that."""
    chests: Floats
    """(N, K, 4): from the pelvis to the chest. The spine undoes the roll of the pelvis, so that the
    shoulders stay level, and twists about its length."""
    arms_rad: Floats
    """(N, K, 4): flexion of shoulder left, shoulder right, elbow left, elbow right."""


@dataclass(frozen=True)
class Steps:
    """N steps, a row each."""

    ids: Integers
    on_right: Flags
    """(N,): whether the standing foot is the right one."""
    re_aimed: Flags
    """(N,): whether the step takes the place of the rest of one that is under way."""
    begin_ticks: Integers
    durations_ticks: Integers
    """(N,): 0 for a walker that just stands, in the pose of all its keys."""
    standing: Footprints
    landing: Footprints
    lifts: Floats
    """(N,): toe-off, the share of the duration until which the swing foot's toe stays where key 0
    has it."""
    flights: Floats
    """(N,): the share of the duration, at its end, in which the standing foot is in the air."""
    keys: Keys


def new_step_records(count: int) -> StepRecords:
    """STEP (count,): records of walking steps that say their kind and length, and are else zero."""
    records = np.zeros(count, dtype=STEP)
    records["kind"] = WALKING
    records["length"] = STEP.itemsize
    return records


def pack_steps(steps: Steps) -> StepRecords:
    """Quantise N steps into records.

    Returns
    -------
    STEP (N,)
        Values outside the range of a field are clamped to its edge. At the ends, the pose is off by
        at most 0.05 mm and 0.003 degrees in root, yaw and feet, by 0.06 degrees in the trunk, and
        by 0.4 degrees in the arms. Between, it is off by half a multiple; docs/protocol.md has the
        figures of walks.
    """
    keys = steps.keys
    records = new_step_records(len(steps.ids))
    records["id"] = steps.ids
    flown = np.clip(np.rint(steps.flights / FLIGHT), 0, MOST_FLIGHT).astype(np.int64)
    records["flags"] = STANDS_ON_RIGHT * steps.on_right + RE_AIMED * steps.re_aimed
    records["flags"] |= (flown << FLIGHT_SHIFT).astype(np.uint8)
    records["tick"] = steps.begin_ticks & 0xFFFF_FFFF
    records["ticks"] = np.clip(steps.durations_ticks, 0, MAX_TICKS)
    records["lift"] = np.rint(np.clip(steps.lifts, 0.0, 1.0) * 0xFF)
    _pack_footprints(records, steps.standing, steps.landing)
    # Keys are relative to the quantised footprints, which readers add to them.
    standing, landing = _footprints(records["standing"]), _footprints(landing_footprints(records))
    numbers = _quantised(keys, standing, landing)
    for end, row in (("first", 0), ("last", -1)):
        for name, columns in _OF_END.items():
            records[end][name] = numbers[:, row, columns]
    records["ankle"] = numbers[:, 0, ANKLE]
    records["swing_heading"] = numbers[:, 0, _SWING_HEADING]
    shifts, bytes_, words = pack_between(numbers, steps.re_aimed)
    records["shifts"] = shifts
    differences(records)[:] = bytes_
    records["trunk"], records["arms"] = words[:, :3], words[:, 3:]
    return records


def unpack_steps(records: StepRecords) -> Steps:
    """The steps of records (N,), in world coordinates."""
    standing, landing = _footprints(records["standing"]), _footprints(landing_footprints(records))
    ends = np.zeros((2, len(records), NUMBERS), dtype=np.int64)
    for end, numbers in zip(("first", "last"), ends, strict=True):
        for name, columns in _OF_END.items():
            numbers[:, columns] = records[end][name]
    ends[0, :, ANKLE] = records["ankle"]
    ends[0, :, _SWING_HEADING] = records["swing_heading"]
    re_aimed = records["flags"] & RE_AIMED != 0
    words = np.concatenate([records["trunk"], records["arms"]], axis=1).astype(np.int64)
    packed = (records["shifts"].astype(np.int64), differences(records).astype(np.int64), words)
    return Steps(
        ids=records["id"].astype(np.int64),
        on_right=records["flags"] & STANDS_ON_RIGHT != 0,
        re_aimed=re_aimed,
        begin_ticks=records["tick"].astype(np.int64),
        durations_ticks=records["ticks"].astype(np.int64),
        standing=standing,
        landing=landing,
        lifts=records["lift"] / 0xFF,
        flights=(records["flags"] >> FLIGHT_SHIFT).astype(np.float64) * FLIGHT,
        keys=_keys(unpack_between(ends[0], ends[1], re_aimed, packed), standing, landing),
    )


def landing_footprints(records: StepRecords) -> StepRecords:
    """The landing footprints of steps, FOOTPRINT (N,), with the numbers of standing ones."""
    landing = records["standing"].copy()
    landing["position"] += records["landing"]["offset"]
    landing["heading"] = records["landing"]["heading"]
    return landing


def differences(records: StepRecords) -> npt.NDArray[np.int8]:
    """The differences of bytes in records, as a view (N, BETWEEN, BYTES) of them."""
    return records["between"].view(np.int8).reshape(len(records), BETWEEN, BYTES)


def step_records(block: bytes) -> StepRecords:
    """The walking steps of a block, in their order, as a read-only array.

    Records of other kinds are passed over, and so are bytes that a walking step has beyond those
    of STEP.

    Raises
    ------
    ValueError
        A record runs over the end of the block, or its length is too small for its kind.
    """
    count, rest = divmod(len(block), STEP.itemsize)
    heads = (block[place :: STEP.itemsize] for place in range(HEAD.itemsize))
    expected = (count * byte for byte in _STEP_HEAD)
    if rest == 0 and all(map(operator.eq, heads, expected)):
        return np.frombuffer(block, dtype=STEP)
    return np.frombuffer(b"".join(_walking_records(block)), dtype=STEP)


def _walking_records(block: bytes) -> Iterator[bytes]:
    """The bytes of every walking step, without those that later versions add at its end."""
    number = at = 0
    while at < len(block):
        left = len(block) - at
        where = f"record {number} at byte {at} of a block of steps"
        if left < HEAD.itemsize:
            raise ValueError(f"{where} ends after {left} of the {HEAD.itemsize} bytes of its head")
        kind, length = _HEAD.unpack_from(block, at)
        least = STEP.itemsize if kind == WALKING else HEAD.itemsize
        if length < least:
            raise ValueError(
                f"{where} says a length of {length} bytes, one of kind {kind} has at least {least}"
            )
        if length > left:
            raise ValueError(f"{where} says a length of {length} bytes, {left} are left")
        if kind == WALKING:
            yield block[at : at + STEP.itemsize]
        number, at = number + 1, at + length


def _pack_footprints(packed: StepRecords, standing: Footprints, landing: Footprints) -> None:
    for name, footprints in (("standing", standing), ("landing", landing)):
        turned = np.rint(footprints.headings_rad / FOOTPRINT_RAD).astype(np.int64)
        packed[name]["heading"] = turned & 0xFFFF
    packed["standing"]["position"] = np.rint(standing.positions_m / FOOTPRINT_M)
    places = np.rint(landing.positions_m / FOOTPRINT_M)
    packed["landing"]["offset"] = _short(places - packed["standing"]["position"])


def _footprints(packed: StepRecords) -> Footprints:
    return Footprints(packed["position"] * FOOTPRINT_M, packed["heading"] * FOOTPRINT_RAD)


def _quantised(keys: Keys, standing: Footprints, landing: Footprints) -> Integers:
    """The numbers of keys, (N, KEYS, NUMBERS); see `esplanade.protocol.keys_between`."""
    numbers = np.zeros((*keys.swing_pitches_rad.shape, NUMBERS), dtype=np.int64)
    numbers[..., _ROOT] = _short((keys.roots_m - standing.positions_m[:, None]) / KEY_M)
    numbers[..., ANKLE] = _short((keys.ankles_m - landing.positions_m[:, None]) / KEY_M)
    angles = to_angles(keys.pelvises)
    numbers[..., YAW] = np.rint(angles[..., 0] / FOOTPRINT_RAD).astype(np.int64) & 0xFFFF
    numbers[..., _SWING_PITCH] = _short(keys.swing_pitches_rad / FOOT_RAD)
    numbers[..., STANDING_PITCH] = _short(keys.standing_pitches_rad / FOOT_RAD)
    turned = keys.swing_headings_rad - landing.headings_rad[:, None]
    turned = np.remainder(turned + np.pi, 2.0 * np.pi) - np.pi
    numbers[..., _SWING_HEADING] = _short(turned / FOOT_RAD)
    numbers[..., _LEAN_AND_ROLL] = _byte(angles[..., 1:] / TRUNK_RAD)
    numbers[..., _TWIST] = _byte(to_twist(keys.chests, angles[..., 2]) / TRUNK_RAD)
    numbers[..., _ARMS] = _byte(keys.arms_rad / ARM_RAD)
    # The swing foot lands on its footprint.
    numbers[:, -1, ANKLE] = numbers[:, -1, _SWING_HEADING] = 0
    return numbers


def _keys(numbers: Integers, standing: Footprints, landing: Footprints) -> Keys:
    multiples = numbers.astype(np.float64)
    lean_and_roll = multiples[..., _LEAN_AND_ROLL] * TRUNK_RAD
    angles = np.concatenate([multiples[..., YAW, None] * FOOTPRINT_RAD, lean_and_roll], axis=-1)
    turned = multiples[..., _SWING_HEADING] * FOOT_RAD
    return Keys(
        roots_m=multiples[..., _ROOT] * KEY_M + standing.positions_m[:, None],
        pelvises=from_angles(angles),
        ankles_m=multiples[..., ANKLE] * KEY_M + landing.positions_m[:, None],
        swing_pitches_rad=multiples[..., _SWING_PITCH] * FOOT_RAD,
        standing_pitches_rad=multiples[..., STANDING_PITCH] * FOOT_RAD,
        swing_headings_rad=turned + landing.headings_rad[:, None],
        chests=from_twist(multiples[..., _TWIST] * TRUNK_RAD, angles[..., 2]),
        arms_rad=multiples[..., _ARMS] * ARM_RAD,
    )


def _short(multiples: Floats) -> Floats:
    """Multiples of a quantum, rounded and clamped to 16 bits."""
    return np.clip(np.rint(multiples), -0x7FFF, 0x7FFF)


def _byte(multiples: Floats) -> Floats:
    """Multiples of a quantum, rounded and clamped to 8 bits."""
    return np.clip(np.rint(multiples), -0x7F, 0x7F)
