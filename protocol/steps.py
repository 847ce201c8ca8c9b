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

from esplanade.protocol.quaternions import (
    Floats,
    pack_near_identity,
    pack_smallest_three,
    unpack_near_identity,
    unpack_smallest_three,
)

KEYS: Final = 6
"""Keys of a step, at the shares 0, 0.2, 0.4, 0.6, 0.8 and 1 of its duration."""

FOOTPRINT = np.dtype([("position", "<i4", 3), ("heading", "<u2")])
"""A footprint, 14 bytes: the place in 0.1 mm, the heading in 1/65536 turns from +x."""

KEY = np.dtype(
    [
        ("root", "<i2", 3),
        ("pelvis", "<u2", 3),
        ("ankle", "<i2", 3),
        ("swing_pitch", "<i2"),
        ("standing_pitch", "<i2"),
        ("swing_heading", "<i2"),
        ("chest", "i1", 3),
        ("arms", "i1", 4),
    ]
)
"""A key, 31 bytes: root and ankle in 0.1 mm from the standing and from the landing footprint."""

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
        ("standing", FOOTPRINT),
        ("landing", FOOTPRINT),
        ("lift", "u1"),
        ("keys", KEY, KEYS),
    ]
)
"""A walking step, 228 bytes."""

_STEP_HEAD: Final = [bytes([byte]) for byte in _HEAD.pack(WALKING, STEP.itemsize)]

STANDS_ON_RIGHT: Final = 1
"""Flag of a step during which the right foot stands."""
RE_AIMED: Final = 2
"""Flag of a step that takes the place of the rest of one under way."""

# Quanta of the fields.
FOOTPRINT_M: Final = 1e-4
FOOTPRINT_RAD: Final = 2.0 * np.pi / 65536.0
KEY_M: Final = 1e-4
FOOT_RAD: Final = 1e-4
ARM_RAD: Final = 1.0 / 40.0
MAX_TICKS: Final = 255

StepRecords = npt.NDArray[np.void]
Integers = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]


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
    """(N, K, 3): ankle of the swing foot, metres in the world."""
    swing_pitches_rad: Floats
    """(N, K): pitch of the swing foot, positive with the toe up."""
    standing_pitches_rad: Floats
    """(N, K): pitch of the standing foot, positive with the toe up."""
    swing_headings_rad: Floats
    """(N, K): heading of the swing foot, within half a turn of the landing footprint's."""
    chests: Floats
    """(N, K, 4): from the pelvis to the chest; none of x, y, z is beyond 0.5."""
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
        Values outside the range of a field are clamped to its edge. The pose is off by at most
        0.05 mm and 0.01 degrees in root, pelvis and feet, and by less than 1 degree in chest and
        arms.
    """
    keys = steps.keys
    records = new_step_records(len(steps.ids))
    records["id"] = steps.ids
    records["flags"] = STANDS_ON_RIGHT * steps.on_right + RE_AIMED * steps.re_aimed
    records["tick"] = steps.begin_ticks & 0xFFFF_FFFF
    records["ticks"] = np.clip(steps.durations_ticks, 0, MAX_TICKS)
    records["lift"] = np.rint(np.clip(steps.lifts, 0.0, 1.0) * 0xFF)
    _pack_footprints(records["standing"], steps.standing)
    _pack_footprints(records["landing"], steps.landing)
    # Keys are relative to the quantised footprints, which readers add to them.
    standing, landing = _footprints(records["standing"]), _footprints(records["landing"])
    packed = records["keys"]
    packed["root"] = _short(keys.roots_m - standing.positions_m[:, None], KEY_M)
    packed["pelvis"] = pack_smallest_three(keys.pelvises)
    packed["ankle"] = _short(keys.ankles_m - landing.positions_m[:, None], KEY_M)
    packed["swing_pitch"] = _short(keys.swing_pitches_rad, FOOT_RAD)
    packed["standing_pitch"] = _short(keys.standing_pitches_rad, FOOT_RAD)
    turned = keys.swing_headings_rad - landing.headings_rad[:, None]
    packed["swing_heading"] = _short(np.remainder(turned + np.pi, 2.0 * np.pi) - np.pi, FOOT_RAD)
    packed["chest"] = pack_near_identity(keys.chests)
    packed["arms"] = np.clip(np.rint(keys.arms_rad / ARM_RAD), -0x7F, 0x7F)
    return records


def unpack_steps(records: StepRecords) -> Steps:
    """The steps of records (N,), in world coordinates."""
    standing, landing = _footprints(records["standing"]), _footprints(records["landing"])
    packed = records["keys"]
    return Steps(
        ids=records["id"].astype(np.int64),
        on_right=records["flags"] & STANDS_ON_RIGHT != 0,
        re_aimed=records["flags"] & RE_AIMED != 0,
        begin_ticks=records["tick"].astype(np.int64),
        durations_ticks=records["ticks"].astype(np.int64),
        standing=standing,
        landing=landing,
        lifts=records["lift"] / 0xFF,
        keys=Keys(
            roots_m=packed["root"] * KEY_M + standing.positions_m[:, None],
            pelvises=unpack_smallest_three(packed["pelvis"]),
            ankles_m=packed["ankle"] * KEY_M + landing.positions_m[:, None],
            swing_pitches_rad=packed["swing_pitch"] * FOOT_RAD,
            standing_pitches_rad=packed["standing_pitch"] * FOOT_RAD,
            swing_headings_rad=packed["swing_heading"] * FOOT_RAD + landing.headings_rad[:, None],
            chests=unpack_near_identity(packed["chest"]),
            arms_rad=packed["arms"] * ARM_RAD,
        ),
    )


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


def _pack_footprints(packed: StepRecords, footprints: Footprints) -> None:
    packed["position"] = np.rint(footprints.positions_m / FOOTPRINT_M)
    packed["heading"] = np.rint(footprints.headings_rad / FOOTPRINT_RAD).astype(np.int64) & 0xFFFF


def _footprints(packed: StepRecords) -> Footprints:
    return Footprints(packed["position"] * FOOTPRINT_M, packed["heading"] * FOOTPRINT_RAD)


def _short(values: Floats, quantum: float) -> Floats:
    """Multiples of a quantum, clamped to 16 bits."""
    rounded: Floats = np.clip(np.rint(values / quantum), -0x7FFF, 0x7FFF)
    return rounded
