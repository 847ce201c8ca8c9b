"""What kernels know of a crowd of actors, and what these decide."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

MOVING = 1
GIVING_WAY = 2
WAITING = 3
REPLANNING = 4
BLOCKED = 5
ARRIVED = 6

PARAMETERS = np.dtype(
    [
        ("radius_m", "f8"),
        ("speed_mps", "f8"),
        ("max_speed_mps", "f8"),
        ("max_acceleration_mps2", "f8"),
        ("goal_tolerance_m", "f8"),
        ("person_clearance_m", "f8"),
        ("contact_closing_s", "f8"),
        ("risk_weight", "f8"),
        ("foresight_s", "f8"),
        ("closing_weight", "f8"),
        ("turn_weight", "f8"),
        ("wall_weight", "f8"),
        ("hurry_weight", "f8"),
        ("catch_up", "f8"),
        ("hysteresis_s", "f8"),
        ("keep_right_weight", "f8"),
        ("max_expansions", "f8"),
        ("height_m", "f8"),
        ("step_on_m", "f8"),
        ("edge_cells", "f8"),
    ]
)
"""What kernels know of an actor's parameters; one field each, in the units of their names."""


class Agents(NamedTuple):
    """State of A actors; every array has A rows.

    `cells` (A,) are those that they stand in, -1 where nobody can; `bodies` (A,) the rows of their
    kinds of body in the grid's clearances. `potential_rows` are rows of the potential pool, -1
    without a goal; `known` tells whether `followed` holds a path; `followed` (A, K, 2) begins at
    the tick that `ages` (A,) ticks ago was. `left_m` is the way that was left a tick ago, nan at
    first; `behind_s` the time lost since the goal was set and not made up yet; `passages`
    (A,) of `PASSAGE` are the narrow places ahead or just come through, and the progress there. The
    kernels that decide write all three.
    """

    positions: NDArray[np.float64]
    velocities: NDArray[np.float64]
    cells: NDArray[np.int64]
    bodies: NDArray[np.int64]
    goals: NDArray[np.float64]
    potential_rows: NDArray[np.int64]
    parameters: NDArray[np.void]
    ranks: NDArray[np.int64]
    known: NDArray[np.bool_]
    ages: NDArray[np.int64]
    followed: NDArray[np.float64]
    left_m: NDArray[np.float64]
    behind_s: NDArray[np.float64]
    passages: NDArray[np.void]


class Decisions(NamedTuple):
    """What the actors decided; every array has A rows.

    `paths` (A, K, 2); `wishes` (A, 2) m/s for the next tick; `reasons`; `statuses` of the
    searches; `expansions`; `renewed` tells that `paths` replaces what was followed.
    """

    paths: NDArray[np.float64]
    wishes: NDArray[np.float64]
    reasons: NDArray[np.int64]
    statuses: NDArray[np.int64]
    expansions: NDArray[np.int64]
    renewed: NDArray[np.bool_]
