"""Meanings of numbers by themselves: times since 1970, degrees on the globe, worlds with y up."""

from dataclasses import replace
from typing import Final

import numpy as np

from esplanade.recordings.rows import Floats, Rows, Whole
from esplanade.recordings.units import DEGREES, MAX_METRES, METRES_A_DEGREE

_SINCE_1970: Final = (
    (1e17, 1e-9, "nanoseconds"),
    (1e14, 1e-6, "microseconds"),
    (1e11, 1e-3, "milliseconds"),
)
"""Times beyond the first number are in such a part of a second, if they count from 1970."""
_FURTHEST_M: Final = 2e7
"""Coordinates of maps are within this."""
_LEAST_WAY_M: Final = 1.0
_TIMES_FLATTER: Final = 10.0


def since_1970(rows: Rows) -> Rows:
    """Seconds, where times without a unit are so great that they can only count parts of them."""
    if rows.times_named or not rows.clock.max() > _SINCE_1970[-1][0]:
        return rows
    middle = float(np.median(rows.clock))
    for least, part_s, name in _SINCE_1970:
        if middle > least:
            remark = f"times are read as {name} since 1970, by their size"
            return replace(rows, clock=rows.clock * part_s, remarks=(*rows.remarks, remark))
    return rows


def on_the_ground(rows: Rows, metres: float) -> Rows:
    """Places on the ground in the file's unit: degrees are made metres, and y up is laid down.

    Worlds of games have their ground in x and z. They show themselves: nobody moves along y, and
    everybody along z, further than heads go up and down.
    """
    if rows.unit == DEGREES:
        return _projected(rows)
    if rows.z is None or not np.isfinite(rows.z).all() or not len(rows.z):
        return rows
    along_y, along_z = (metres * _longest_way(values, rows.who) for values in (rows.y, rows.z))
    if along_z < _LEAST_WAY_M or along_z < _TIMES_FLATTER * along_y:
        return rows
    remark = "nobody moves along its y but all along its z: z is read as y, and y as the height"
    return replace(rows, y=rows.z, z=rows.y, remarks=(*rows.remarks, remark))


def near_the_origin(rows: Rows) -> Rows:
    """Places in metres, moved to the origin where they lie as far off as those of maps do."""
    boxes = [(float(values.min()), float(values.max())) for values in (rows.x, rows.y)]
    if all(max(-low, high) <= MAX_METRES for low, high in boxes):
        return rows
    if not all(high - low <= MAX_METRES and max(-low, high) < _FURTHEST_M for low, high in boxes):
        return rows
    east, north = (float(round(0.5 * low + 0.5 * high)) for low, high in boxes)
    remark = f"({east:.0f}, {north:.0f}) m becomes the origin, for its places lie far from theirs"
    return replace(rows, x=rows.x - east, y=rows.y - north, remarks=(*rows.remarks, remark))


def _longest_way(values: Floats, who: Whole) -> float:
    """How far anybody goes along an axis."""
    order = np.argsort(who, kind="stable")
    starts = np.flatnonzero(np.append(True, np.diff(who[order]) > 0))
    found = values[order]
    return float(np.median(np.maximum.reduceat(found, starts) - np.minimum.reduceat(found, starts)))


def _projected(rows: Rows) -> Rows:
    east, north = (0.5 * float(values.min() + values.max()) for values in (rows.x, rows.y))
    remark = f"({east:.6f}, {north:.6f}) in degrees becomes the origin"
    return replace(
        rows,
        x=(rows.x - east) * METRES_A_DEGREE * np.cos(np.radians(north)),
        y=(rows.y - north) * METRES_A_DEGREE,
        remarks=(*rows.remarks, remark),
    )
