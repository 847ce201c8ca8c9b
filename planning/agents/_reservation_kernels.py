"""Certain obstacles: the planned paths of other agents, looked up in CT-space."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._geometry_kernels import closest_approach
from esplanade.planning.scene.heights import BODIES_OVERLAP_M


class Reservations(NamedTuple):
    """The planned paths of all agents, and an index of them by bucket, slice by slice.

    `paths` (A, K, 2) m; `heights` (A, K) m of the feet; `radii` (A,) m; `ranks` (A,), smaller goes
    first; `courses` (A, 2) unit vectors down the potential, zeros for agents that are settled or
    have no path; `held_up` (A,) tells whether an agent is held up, `contested` (A,) whether its
    passage is contested; `starts` (K, buckets + 1) and `members` (K, A) list the agents of a
    bucket.
    """

    rules: NDArray[np.void]
    """The one record (1,) of `RULES`."""
    paths: NDArray[np.float64]
    heights: NDArray[np.float64]
    radii: NDArray[np.float64]
    ranks: NDArray[np.int64]
    courses: NDArray[np.float64]
    held_up: NDArray[np.bool_]
    contested: NDArray[np.bool_]
    starts: NDArray[np.int64]
    members: NDArray[np.int64]
    x0: float
    y0: float
    bucket_m: float
    widest_m: float
    """The greatest radius."""
    fastest_m: float
    """The greatest distance that an agent gets in a slice."""
    nx: int
    ny: int


@kernel
def index_paths(reservations: Reservations) -> None:
    """Fill `starts` and `members` from `paths` (a counting sort for every slice)."""
    r = reservations
    actors, slices, _ = r.paths.shape
    bucket = np.empty(actors, dtype=np.int64)
    for k in range(slices):
        r.starts[k] = 0
        for a in range(actors):
            i = min(r.nx - 1, max(0, int((r.paths[a, k, 0] - r.x0) / r.bucket_m)))
            j = min(r.ny - 1, max(0, int((r.paths[a, k, 1] - r.y0) / r.bucket_m)))
            bucket[a] = j * r.nx + i
            r.starts[k, bucket[a] + 1] += 1
        for b in range(r.nx * r.ny):
            r.starts[k, b + 1] += r.starts[k, b]
        for a in range(actors - 1, -1, -1):
            r.starts[k, bucket[a] + 1] -= 1
            r.members[k, r.starts[k, bucket[a] + 1]] = a
        for b in range(r.nx * r.ny):
            r.starts[k, b] = r.starts[k, b + 1]
        r.starts[k, r.nx * r.ny] = actors


@inlined
def _against(r: Reservations, me: int, other: int) -> bool:
    """Whether the courses of two agents are against each other."""
    along = r.courses[me, 0] * r.courses[other, 0] + r.courses[me, 1] * r.courses[other, 1]
    return bool(along < -r.rules[0]["against_cosine"])


@inlined
def room_wanted(r: Reservations, me: int, other: int) -> float:
    """Metres that two agents would like between their bodies; 0 if they only must not touch."""
    if not (r.held_up[me] or r.held_up[other]):
        return 0.0
    if _against(r, me, other):
        return float(r.rules[0]["meeting_room_m"])
    return float(r.rules[0]["queue_room_m"]) if r.held_up[me] and r.held_up[other] else 0.0


@inlined
def _most_room_m(r: Reservations) -> float:
    """The most that `room_wanted` may be."""
    return float(max(r.rules[0]["meeting_room_m"], r.rules[0]["queue_room_m"]))


@inlined
def crowding(r: Reservations, me: int, other: int, k: int, x: float, y: float) -> float:
    """Weight of being at (x, y) at slice k for leaving too little room to one other agent."""
    room_m = room_wanted(r, me, other)
    if room_m == 0.0:
        return 0.0
    rules = r.rules[0]
    ex = x - r.paths[other, k, 0]
    ey = y - r.paths[other, k, 1]
    apart = np.sqrt(ex * ex + ey * ey)
    lacking = 1.0 - max(0.0, apart - r.radii[me] - r.radii[other] - rules["margin_m"]) / room_m
    if lacking <= 0.0:
        return 0.0
    if not _against(r, me, other):
        return float(rules["queue_weight"] * lacking)
    to_the_right = (r.courses[me, 0] * ey - r.courses[me, 1] * ex) / max(apart, 1e-9)
    return float(rules["meeting_weight"] * lacking * max(0.0, 0.5 + to_the_right))


@inlined
def buckets_within(
    r: Reservations, x: float, y: float, within_m: float
) -> tuple[int, int, int, int]:
    """Rows and columns (j0, j1, i0, i1) of the buckets that may hold agents within a distance."""
    return (
        min(r.ny - 1, max(0, int((y - within_m - r.y0) / r.bucket_m))),
        min(r.ny - 1, max(0, int((y + within_m - r.y0) / r.bucket_m))),
        min(r.nx - 1, max(0, int((x - within_m - r.x0) / r.bucket_m))),
        min(r.nx - 1, max(0, int((x + within_m - r.x0) / r.bucket_m))),
    )


@inlined
def conflict(
    reservations: Reservations,
    me: int,
    feet_m: float,
    k: int,
    ax: float,
    ay: float,
    bx: float,
    by: float,
) -> tuple[bool, float]:
    """Meetings of agent `me` while it moves from a at slice k to b at slice k + 1.

    The first value tells whether one of them is forbidden. The second is the weight of the others;
    at the end of a step the weight of too little room to other agents is added. Swapping places is
    a meeting. `feet_m` is the height of the agent's feet; agents on another floor are not met.
    """
    r = reservations
    soft = 0.0
    if not r.rules[0]["reserves"]:
        return False, soft
    # An agent further away than this at the end was not met in the move and is not crowded.
    moved_m = np.sqrt((bx - ax) ** 2 + (by - ay) ** 2)
    far = max(_most_room_m(r), moved_m + r.fastest_m)
    j0, j1, i0, i1 = buckets_within(r, bx, by, 2.0 * r.widest_m + r.rules[0]["margin_m"] + far)
    for j in range(j0, j1 + 1):
        row = j * r.nx  # buckets of a row are listed one after the other
        for m in range(r.starts[k + 1, row + i0], r.starts[k + 1, row + i1 + 1]):
            other = r.members[k + 1, m]
            if other == me or abs(r.heights[other, k + 1] - feet_m) >= BODIES_OVERLAP_M:
                continue
            dx = bx - r.paths[other, k + 1, 0]
            dy = by - r.paths[other, k + 1, 1]
            most = r.radii[me] + r.radii[other] + r.rules[0]["margin_m"] + far
            if dx * dx + dy * dy > most * most:
                continue
            weight = _meeting(r, me, other, k, ax, ay, bx, by)
            if weight == np.inf:
                return True, 1.0
            soft += weight
            if k % 2 == 1:  # b is the end of a step
                soft += crowding(r, me, other, k + 1, bx, by)
    return False, soft


@inlined
def others_near(
    reservations: Reservations,
    me: int,
    feet_m: float,
    k: int,
    x: float,
    y: float,
    slice_m: float,
    others: NDArray[np.int64],
) -> tuple[int, int]:
    """List the agents that may be met within two slices of leaving (x, y) at slice k; count them.

    Agents that cannot be met but may stand too near are listed from the end of `others` backwards;
    the second number counts them. `slice_m` is the distance that agent `me` gets in a slice.
    `others` takes as many as it has room for.
    """
    r = reservations
    rules = r.rules[0]
    apart_m = rules["margin_m"] + 2.0 * slice_m
    far = 2.0 * r.widest_m + apart_m + _most_room_m(r) + r.fastest_m
    j0, j1, i0, i1 = buckets_within(r, x, y, far)
    met = 0
    crowded = 0
    if not rules["reserves"]:
        return met, crowded
    for j in range(j0, j1 + 1):
        row = j * r.nx  # buckets of a row are listed one after the other
        for m in range(r.starts[k + 1, row + i0], r.starts[k + 1, row + i1 + 1]):
            o = r.members[k + 1, m]
            dx = x - r.paths[o, k + 1, 0]
            dy = y - r.paths[o, k + 1, 1]
            if dx * dx + dy * dy > far * far or o == me:
                continue
            if abs(r.heights[o, k + 1] - feet_m) >= BODIES_OVERLAP_M:
                continue
            if met + crowded == len(others):
                return met, crowded
            reach = r.radii[me] + r.radii[o] + apart_m
            room_m = room_wanted(r, me, o)
            # In the whole step agents stay within `fastest_m` of their places in its middle.
            most = reach + room_m + r.fastest_m
            if dx * dx + dy * dy > most * most:
                continue
            nearest = np.inf
            for s in range(2):
                d = closest_approach(
                    x - r.paths[o, k + s, 0],
                    y - r.paths[o, k + s, 1],
                    r.paths[o, k + s, 0] - r.paths[o, k + s + 1, 0],
                    r.paths[o, k + s, 1] - r.paths[o, k + s + 1, 1],
                )
                nearest = min(nearest, d)
            if nearest < reach:
                others[met] = o
                met += 1
            elif nearest < reach + room_m:
                crowded += 1
                others[len(others) - crowded] = o
    return met, crowded


@inlined
def meetings(
    reservations: Reservations,
    others: NDArray[np.int64],
    met: int,
    crowded: int,
    me: int,
    k: int,
    ax: float,
    ay: float,
    bx: float,
    by: float,
    cx: float,
    cy: float,
) -> tuple[bool, float]:
    """`conflict` from a at slice k to b and on to c, with those that `others_near` listed."""
    soft = 0.0
    for n in range(met):
        o = others[n]
        weight = _meeting(reservations, me, o, k, ax, ay, bx, by) + _meeting(
            reservations, me, o, k + 1, bx, by, cx, cy
        )
        if weight == np.inf:
            return True, 1.0
        soft += weight + crowding(reservations, me, o, k + 2, cx, cy)
    for n in range(len(others) - crowded, len(others)):
        soft += crowding(reservations, me, others[n], k + 2, cx, cy)
    return False, soft


@inlined
def _meeting(
    reservations: Reservations,
    me: int,
    other: int,
    k: int,
    ax: float,
    ay: float,
    bx: float,
    by: float,
) -> float:
    """Weight of a move from a at slice k to b because of one other agent; inf if forbidden.

    It is 0 if the two stay clear, or are too close already and draw apart. A meeting with an agent
    of larger rank, which will yield, is dear. A meeting with one of smaller rank is forbidden,
    unless it is about to happen anyway and the move leaves more room than standing would: an agent
    that cannot get out of the way in time has to begin with it.
    """
    r = reservations
    rules = r.rules[0]
    rx = ax - r.paths[other, k, 0]
    ry = ay - r.paths[other, k, 1]
    ex = bx - r.paths[other, k + 1, 0]
    ey = by - r.paths[other, k + 1, 1]
    reach = r.radii[me] + r.radii[other] + rules["margin_m"]
    d = closest_approach(rx, ry, ex - rx, ey - ry)
    if d >= reach:
        return 0.0
    before = np.sqrt(rx * rx + ry * ry)
    if d >= before - 1e-9 and np.sqrt(ex * ex + ey * ey) > before:
        return 0.0
    if r.ranks[other] > r.ranks[me]:
        return float(rules["yielding_weight"])
    if (
        k < rules["evading_slices"]
        and d > closest_approach(rx, ry, ex + ax - bx - rx, ey + ay - by - ry) + rules["evading_m"]
    ):
        return float(rules["yielding_weight"])
    return np.inf
