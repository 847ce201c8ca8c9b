"""Table 3 of Jing et al. 2015: velocities and halvings of algorithm 1, as printed and reproduced.

The table does not follow from the paper's eq. (12). It does follow, in all 15 rows, from the step
length of Boulic's own curves (hip 50 RV and knee 140 RV, where the paper's coefficients imply 25
and 70) with three additions, none of which can be derived: the printed velocities are RV_SCALE
times those found; FITTED_OFFSET is added to every length; and from the twelfth row on the printed
numbers of halvings are one row off. The offset is fitted to the table: any value from .00225 to
.0025 does.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from esplanade.actors.locomotion.body.skeleton import SHIN, THIGH
from esplanade.actors.locomotion.reference.paper_gait import halve
from esplanade.planning.compiled.arrays import Floats, Ints

LENGTHS: Final = np.arange(1, 16) * 0.05
"""Step lengths of the 15 rows, leg lengths."""
PRINTED_RV: Final = np.array(
    [
        0.0300,
        0.0610,
        0.0910,
        0.1213,
        0.1591,
        0.1895,
        0.2273,
        0.2577,
        0.2878,
        0.3183,
        0.3486,
        0.3789,
        0.4244,
        0.4547,
        0.4812,
    ]
)
PRINTED_HALVINGS: Final = np.array([3, 2, 3, 1, 5, 5, 4, 4, 4, 4, 4, 2, 3, 6, 3])
SHIFTED_HALVINGS: Final = np.array([3, 2, 3, 1, 5, 5, 4, 4, 4, 4, 4, 4, 2, 3, 6])
"""The printed numbers with a missing 4 put in at the twelfth row and the last number struck off.

Only so do they fit the printed velocities, which are multiples of .485 / 2^k.
"""

TOLERANCE: Final = 0.01
"""Tolerance of the paper's algorithm 1, leg lengths."""
RV_SCALE: Final = 0.97
"""Ratio of printed velocities to those found; nothing explains it."""
FITTED_OFFSET: Final = 0.0024
"""Length that is added to every step, leg lengths; it is fitted to the table."""
SAME_RV: Final = 7e-4
"""Velocities closer than this count as the same: one of them is misprinted by .0002."""


class Reproduced(NamedTuple):
    """Results of algorithm 1 for the 15 rows."""

    rv: Floats
    """(15,), leg lengths a second, scaled as the printed ones."""
    halvings: Ints
    """(15,): how often the interval was halved."""

    def rows_right(self) -> tuple[int, int]:
        """Number of velocities, and of counts of halvings, that agree with the table."""
        same = np.abs(self.rv - PRINTED_RV) < SAME_RV
        return int(same.sum()), int((self.halvings == SHIFTED_HALVINGS).sum())


def eq12_printed(rv: ArrayLike) -> Floats:
    """Step lengths (...), leg lengths, by eq. (12) as it is printed, with angles in degrees."""
    v = np.asarray(rv, dtype=np.float64)
    return _legs(
        565.0 / 27.0 * v, 30.0 * v, 790.0 / 49.0 * v - 825.0 / 343.0, 565.0 / 27.0 * v + 3.0
    )


def source_length(rv: ArrayLike) -> Floats:
    """Step lengths (...), leg lengths, of Boulic's curves at half a cycle.

    The ankle is left out, as in eq. (12).
    """
    v = np.asarray(rv, dtype=np.float64)
    front = 1190.0 / 27.0 * v
    return _legs(front, 30.0 * v, front - 3.0, 30.0 * v + 1360.0 / 49.0 * v + 825.0 / 343.0)


def reproduce(offset: float = FITTED_OFFSET) -> Reproduced:
    """Algorithm 1 with lengths of the source's curves and an offset, leg lengths, added to them."""
    rv, halvings = halve(lambda v: source_length(v) + offset, LENGTHS, TOLERANCE)
    return Reproduced(RV_SCALE * rv, halvings)


def reproduce_as_printed() -> Reproduced:
    """Algorithm 1 with eq. (12) as it is printed; it has no steps of .40 or more."""
    rv, halvings = halve(eq12_printed, LENGTHS, TOLERANCE)
    return Reproduced(rv, halvings)


def _legs(thigh_a: Floats, thigh_b: Floats, shin_a: Floats, shin_b: Floats) -> Floats:
    """Distance between the heels, for angles of thighs and shins in degrees."""
    thighs = np.sin(np.radians(thigh_a)) + np.sin(np.radians(thigh_b))
    shins = np.sin(np.radians(shin_a)) + np.sin(np.radians(shin_b))
    length: Floats = THIGH * thighs + SHIN * shins
    return length
