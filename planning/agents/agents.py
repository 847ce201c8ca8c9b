"""The state of agents as kernels know it, and their decisions."""

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
        ("person_room_m", "f8"),
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
        ("leg_length_m", "f8"),
        ("edge_cells", "f8"),
        ("patience_s", "f8"),
        ("stride", "f8"),
    ]
)
"""An agent's parameters as kernels know them, one field each, in the units of their names."""


class Agents(NamedTuple):
    """State of A agents as kernels read and write it; every array has A rows.

    Their bodies and tempers: `bodies` (A,) are rows of their kinds of body in the grid's
    clearances, `contacts` (A,) those of their contact distances in the tables of risk, `parameters`
    (A,) records of `PARAMETERS`; the agent with the smaller of `ranks` (A,) goes first of two with
    equal distances left.

    Their places: `positions` (A, 2) m, `velocities` (A, 2) m/s, `headings` (A,) rad from +x,
    `cells` (A,) that they stand in, -1 where nobody can stand, `heights` (A,) m of the floor there
    and `layers` (A,) of it; `on_edges` (A,) is the way that they have come on edges since they left
    stable ground or were put there, in cells; `reasons` (A,) codes of why they do what they do.

    Their paths: `goals` (A, 2) m; `potential_rows` (A,) of the pool, -1 without a goal; `planned`
    (A, K, 3) m is the plan of the latest tick, from that tick's beginning, with heights. `known`
    (A,) tells whether `followed` holds a path; `followed` (A, K, 2) m begins at the tick that
    `ages` (A,) ticks ago was. `left_m` (A,) is the distance that was left a tick ago, nan at first;
    `behind_s` (A,) the time lost since the goal was set and not made up yet; `passages`
    (A,) of `PASSAGE` are the narrow places ahead or just come through, and the progress there.
    The kernels that decide write these three. An agent that `waits` (A,) stays where it is, goal or
    not; the weight of risk of each is multiplied by its share of `cautions` (A,), 1 as a rule.
    """

    positions: NDArray[np.float64]
    velocities: NDArray[np.float64]
    cells: NDArray[np.int64]
    bodies: NDArray[np.int64]
    contacts: NDArray[np.int64]
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
    headings: NDArray[np.float64]
    heights: NDArray[np.float64]
    layers: NDArray[np.int64]
    on_edges: NDArray[np.float64]
    reasons: NDArray[np.int64]
    planned: NDArray[np.float64]
    waits: NDArray[np.bool_]
    cautions: NDArray[np.float64]


class Decisions(NamedTuple):
    """Decisions of A agents; every array has A rows.

    `paths` (A, K, 2); `wishes` (A, 2) m/s for the next tick; `reasons`; `statuses` of the
    searches; `expansions`; `renewed` tells that `paths` replaces the followed path; `replanned`
    that a path was looked for at all. Without that the followed path goes on.
    """

    paths: NDArray[np.float64]
    wishes: NDArray[np.float64]
    reasons: NDArray[np.int64]
    statuses: NDArray[np.int64]
    expansions: NDArray[np.int64]
    renewed: NDArray[np.bool_]
    replanned: NDArray[np.bool_]
