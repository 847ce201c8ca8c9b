"""Footholds: where the swing foot lands, from where a body is going and where there is ground."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from esplanade.actors.locomotion.body.skeleton import FOOT, TRACK_HALF_WIDTH
from esplanade.actors.locomotion.gait.curves import smooth
from esplanade.actors.locomotion.gait.step_length import (
    RV_LONGEST,
    planted_length,
    straight_double_support,
)
from esplanade.actors.locomotion.planted.footprints import HEADING, ON_MAP, PLACE, Z
from esplanade.planning.compiled.arrays import Bools, Floats
from tests.naive.footsteps.course import Course, desired_headings
from tests.naive.footsteps.ground import Ground
from tests.naive.footsteps.limits import (
    BEHIND_LANDING,
    clamped_distance,
    clamped_foot,
    distance_and_limit,
    longest_step,
)
from tests.naive.headings import forward_and_left, wrap_angle
from tests.naive.planted.flight import LANDS_AHEAD, SHORTEST_RUN

# Limits of the height up or down to which a foot is put.
_TREAD_M: Final = 0.26
"""Greatest rise or fall ahead of a body that takes one tread at a time."""
_TWO_TREADS_M: Final = 0.42
"""Greatest rise or fall ahead of a body that is too fast for that."""
_HASTY_MPS: Final = 1.6
"""A body faster than this is too fast to take one tread at a time."""
_CLIMB_M: Final = 0.75
"""Greatest rise or fall under a body that is going there."""
_LEFT_M: Final = 0.42
"""A body this far above or below its standing foot has left it, as over the side of a flight."""
_CATCH_UP_M: Final = 1.5
"""Greatest rise or fall under a body that has left its standing foot."""

_OPENING_RAD: Final = 1.6
"""The greatest angle by which a foot is turned outwards against the other one."""
_CLOSING_RAD: Final = 1.0
"""The greatest angle by which a foot is turned inwards against the other one."""


class Footholds(NamedTuple):
    """The targets of N steps."""

    landing: Floats
    """(N, 4): footprints on which the swing feet land."""
    hips: Floats
    """(N, 2), metres: where the hips are to be at the end."""
    body: Floats
    """(N, 2), metres: where the body is at the end, which the hips may not get to."""
    velocity: Floats
    """(N, 2), metres a second: how fast the body goes then."""
    heading: Floats
    """(N,), radians: where the body wants to face then."""


def choose_footholds(
    course: Course,
    on_right: Bools,
    standing: Floats,
    leg_m: Floats,
    step_s: Floats,
    left_s: Floats,
    ground: Ground,
) -> Footholds:
    """Choose where N swing feet land while the other feet stand.

    Parameters
    ----------
    course : of the bodies
    on_right : bool (N,)
        Whether the standing foot is the right one.
    standing : float64 (N, 4), footprints of the standing feet
    leg_m : float64 (N,), metres
    step_s : float64 (N,), seconds
        How long the whole steps take.
    left_s : float64 (N,), seconds
        The time left of them.
    ground : where feet can be put

    Returns
    -------
    Footholds of N steps

    Notes
    -----
    A foot lands half a step ahead of where the body will be, on its own side. If there is no ground
    it lands halfway to the place under the body, or under it, or on the way there from the standing
    foot, or beside that.
    """
    there = course.at(left_s)
    velocity = course.velocity(left_s)
    desired = desired_headings(course, velocity)
    side = np.where(on_right, 1.0, -1.0)
    turn = side * wrap_angle(desired - standing[:, HEADING])
    heading = standing[:, HEADING] + side * np.clip(turn, -_CLOSING_RAD, _OPENING_RAD)

    legs_a_second = np.hypot(velocity[:, 0], velocity[:, 1]) / leg_m
    longest = longest_step(legs_a_second)
    _, limit = distance_and_limit(there[:, :2], standing, legs_a_second)
    hips = clamped_distance(there[:, :2], standing[:, ON_MAP], 1.1 * limit * leg_m)
    forward, left = forward_and_left(heading)
    ahead_mps = np.einsum("nd,nd->n", velocity, forward)
    aside_mps = np.einsum("nd,nd->n", velocity, left)
    ahead = np.where(
        ahead_mps > 0.0,
        leg_m * _heel_ahead_of_hips(ahead_mps * step_s / leg_m),
        0.5 * ahead_mps * step_s,
    )
    aside = side * TRACK_HALF_WIDTH * leg_m + 0.5 * aside_mps * step_s
    under = there.copy()
    under[:, :2] = hips + (side * TRACK_HALF_WIDTH * leg_m)[:, None] * left
    middle = standing[:, HEADING] + 0.5 * (heading - standing[:, HEADING])

    foot_m = FOOT * leg_m
    landing = np.empty((len(leg_m), 4))
    landing[:, Z], landing[:, HEADING] = there[:, 2], heading
    landing[:, ON_MAP] = hips + ahead[:, None] * forward + aside[:, None] * left
    landing[:, ON_MAP] = clamped_foot(landing[:, ON_MAP], standing, middle, side, longest, leg_m)
    landing, found = ground.settle(landing, foot_m)
    hasty = np.hypot(velocity[:, 0], velocity[:, 1]) > _HASTY_MPS
    climb_m = np.where(hasty, _TWO_TREADS_M, _TREAD_M)
    has_left = np.abs(course.ahead[:, 0, 2] - standing[:, Z]) > _LEFT_M
    far_m = np.where(has_left, _CATCH_UP_M, _CLIMB_M)
    found &= np.abs(landing[:, Z] - standing[:, Z]) <= climb_m
    if not found.all():
        halfway, beside = 0.5 * (landing[:, PLACE] + under), standing[:, PLACE].copy()
        partway = 0.5 * (standing[:, PLACE] + under)
        for places in (halfway, under, partway, beside):
            places[:, :2] = clamped_foot(places[:, :2], standing, middle, side, longest, leg_m)
        for places, limit_m in (
            (halfway, climb_m),
            (under, climb_m),
            (under, far_m),
            (partway, far_m),
            (beside, far_m),
        ):
            found = _try_places(landing, places, found, standing[:, Z], limit_m, foot_m, ground)
    # Footprints are sent in tenths of a millimetre; feet would land beside finer ones.
    landing[:, PLACE] = np.round(landing[:, PLACE], 4)
    hips = clamped_distance(hips, landing[:, ON_MAP], BEHIND_LANDING * leg_m)
    return Footholds(landing, hips, there[:, :2], velocity, desired)


def _try_places(
    landing: Floats,
    places: Floats,
    found: Bools,
    from_m: Floats,
    limit_m: Floats,
    foot_m: Floats,
    ground: Ground,
) -> Bools:
    """Put feet that have found no ground so far to places (N, 3); landing is changed in place.

    Heights may differ from from_m (N,) by limit_m (N,). The result says which feet have found
    ground by now.
    """
    rows = np.flatnonzero(~found)
    tried = landing[rows]
    tried[:, PLACE] = places[rows]
    landing[rows], there = ground.settle(tried, foot_m[rows])
    there &= np.abs(landing[rows, Z] - from_m[rows]) <= limit_m[rows]
    now = found.copy()
    now[rows[there]] = True
    return now


_VELOCITIES: Final = np.linspace(0.0, RV_LONGEST, 65)
_POSES: Final = straight_double_support(_VELOCITIES)
_LENGTHS: Final = planted_length(_POSES)


def _heel_ahead_of_hips(length: Floats) -> Floats:
    """Distances, leg lengths (N,), ahead of the hips where heels of steps of lengths (N,) land."""
    last = _LENGTHS[-1]
    walked = np.interp(np.minimum(length, last), _LENGTHS, _POSES.front_forward)
    runs = smooth((length - last) / (SHORTEST_RUN + 0.07 - last))
    return np.asarray(walked + (LANDS_AHEAD - walked) * runs)
