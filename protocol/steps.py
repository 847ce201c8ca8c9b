"""The packed block of a `steps` message: one fixed record for each step of a foot, little-endian.

During a step the standing foot stays on its footprint while the other one, the swing foot, goes to
its landing footprint, on which it stands during the next step. A footprint is the place of the
heel on the ground, with the heading of the toe. Between the six keys, at even shares of the step's
duration, the pose is interpolated.

The server quantises a step once and goes on from what the record holds: the landing footprint of
one step is the standing footprint of the next, bit for bit.
"""

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

STEP = np.dtype(
    [
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
"""A step, 225 bytes."""

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
    records = np.zeros(len(steps.ids), dtype=STEP)
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
    """The records of a block, as a read-only view.

    Raises
    ------
    ValueError
        The length of the block is no multiple of that of a record.
    """
    if len(block) % STEP.itemsize:
        size = STEP.itemsize
        raise ValueError(f"a block of steps must be a multiple of {size} bytes, got {len(block)}")
    return np.frombuffer(block, dtype=STEP)


def _pack_footprints(packed: StepRecords, footprints: Footprints) -> None:
    packed["position"] = np.rint(footprints.positions_m / FOOTPRINT_M)
    packed["heading"] = np.rint(footprints.headings_rad / FOOTPRINT_RAD).astype(np.int64) & 0xFFFF


def _footprints(packed: StepRecords) -> Footprints:
    return Footprints(packed["position"] * FOOTPRINT_M, packed["heading"] * FOOTPRINT_RAD)


def _short(values: Floats, quantum: float) -> Floats:
    """Multiples of a quantum, clamped to 16 bits."""
    rounded: Floats = np.clip(np.rint(values / quantum), -0x7FFF, 0x7FFF)
    return rounded
