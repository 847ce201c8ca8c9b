"""The packed block inside a snapshot: one fixed record an avatar, little-endian.

Positions are whole centimetres from the `origin` that `welcome` gave, so a zone may measure up
to 655 m a side. Heights are those of the feet, from the scene's ground.
"""

import struct

import numpy as np
import numpy.typing as npt

RECORD = np.dtype(
    [
        ("id", "<u4"),
        ("layer", "u1"),
        ("reason", "u1"),
        ("x", "<u2"),
        ("y", "<u2"),
        ("z", "<i2"),
        ("heading", "u1"),
        ("speed", "u1"),
    ]
)
"""14 bytes. x, y, z in cm; heading in 1/256 turns from +x; speed in 2 cm/s, up to 5.1 m/s."""

POSITION_M = 0.01
HEADING_RAD = 2.0 * np.pi / 256.0
SPEED_MPS = 0.02
MAX_EXTENT_M = 0xFFFF * POSITION_M

_POSITION = struct.Struct("<HH")
_POSITION_OFFSET = 6

Records = npt.NDArray[np.void]
Floats = npt.NDArray[np.float64]


def pack_records(
    ids: npt.NDArray[np.integer],
    layers: npt.NDArray[np.integer],
    reasons: npt.NDArray[np.integer],
    positions_m: npt.NDArray[np.floating],
    heights_m: npt.NDArray[np.floating],
    headings_rad: npt.NDArray[np.floating],
    speeds_mps: npt.NDArray[np.floating],
    origin_m: tuple[float, float],
) -> Records:
    """Quantise N avatars into records.

    Parameters
    ----------
    ids, layers, reasons : integer (N,)
    positions_m : float (N, 2), metres, world frame, finite
    heights_m : float (N,), metres above the scene's ground, finite
    headings_rad : float (N,), radians from +x, any turn, finite
    speeds_mps : float (N,), metres a second, finite
    origin_m : the zone's lower corner

    Returns
    -------
    RECORD (N,). Values outside the range are clamped to its edge.
    """
    records = np.empty(len(ids), dtype=RECORD)
    records["id"] = ids
    records["layer"] = layers
    records["reason"] = reasons
    cm = np.clip(np.rint((positions_m - np.asarray(origin_m)) / POSITION_M), 0, 0xFFFF)
    records["x"] = cm[:, 0]
    records["y"] = cm[:, 1]
    records["z"] = np.clip(np.rint(heights_m / POSITION_M), -0x8000, 0x7FFF)
    records["heading"] = np.rint(headings_rad / HEADING_RAD).astype(np.int64) & 0xFF
    records["speed"] = np.clip(np.rint(speeds_mps / SPEED_MPS), 0, 0xFF)
    return records


def unpack_block(block: bytes) -> Records:
    """Records of a block, as a read-only view.

    Raises
    ------
    ValueError
        The block's length is no multiple of the record's.
    """
    if len(block) % RECORD.itemsize:
        raise ValueError(
            f"snapshot block of {len(block)} bytes is no multiple of {RECORD.itemsize}"
        )
    return np.frombuffer(block, dtype=RECORD)


def find_position_m(
    block: bytes, entity_id: int, origin_m: tuple[float, float]
) -> tuple[float, float] | None:
    """World position (x, y), metres, of one avatar; None when it is not in the block.

    Cheaper than unpacking where nothing else of the block is wanted.
    """
    wanted = entity_id.to_bytes(4, "little")
    start = block.find(wanted)
    while start % RECORD.itemsize:  # not found is -1, which is no start of a record either
        if start < 0:
            return None
        start = block.find(wanted, start + 1)
    x_cm, y_cm = _POSITION.unpack_from(block, start + _POSITION_OFFSET)
    return origin_m[0] + x_cm * POSITION_M, origin_m[1] + y_cm * POSITION_M


def positions_m(records: Records, origin_m: tuple[float, float]) -> Floats:
    """World positions of records, float64 (N, 2), metres."""
    positions: Floats = np.stack([records["x"], records["y"]], axis=1) * POSITION_M
    positions += origin_m
    return positions


def heights_m(records: Records) -> Floats:
    """Heights of the feet above the scene's ground, float64 (N,), metres."""
    heights: Floats = records["z"] * POSITION_M
    return heights


def headings_rad(records: Records) -> Floats:
    """Headings of records, float64 (N,), radians from +x in [0, 2 pi)."""
    headings: Floats = records["heading"] * HEADING_RAD
    return headings


def speeds_mps(records: Records) -> Floats:
    """Speeds of records, float64 (N,), metres a second."""
    speeds: Floats = records["speed"] * SPEED_MPS
    return speeds
