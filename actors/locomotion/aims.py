"""Where the next foot comes down and how long that takes, from where a body is going."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion import _course_kernels as kernels
from esplanade.actors.locomotion.durations import step_duration_s
from esplanade.actors.locomotion.ground import Ground
from esplanade.actors.locomotion.motion import Floats
from esplanade.actors.locomotion.skeleton import FOOT, TRACK_HALF_WIDTH
from esplanade.actors.locomotion.step_length import (
    RV_LONGEST,
    double_support,
    longest_step,
    planted_length,
)
from esplanade.actors.locomotion.strides import wrapped

AHEAD_S: Final = kernels.AHEAD_S
"""Time between the places of a course."""
AHEAD: Final = kernels.AHEAD
"""How many places a course has."""

WALKING_MPS: Final = 0.3
"""Who is faster turns to where it goes."""
CLOSING_S: Final = 0.5
"""A step that goes nowhere: the other foot is drawn up, or the body turns."""
SHORTEST_S: Final = 0.2
SHORTEST_UP_S: Final = 0.25
"""On stairs, up or down."""
SHORTEST_REST_S: Final = 0.2
"""Of a step under way that has to end elsewhere."""
LONGEST_S: Final = 0.8

# Lengths in legs.
_LONGEST: Final = 0.68
"""Steps that are walked; who is faster takes them in less time."""
_PAST: Final = 0.5
_PAST_AHEAD: Final = 0.1
"""A step takes the body no further from its standing foot; so much more in the direction of the
toe, on which the foot can rise."""
_BEHIND: Final = 0.54
"""And no further from the landing foot."""
_FURTHEST: Final = 0.86
_FURTHEST_BACK: Final = 0.55
_FURTHEST_ASIDE: Final = 0.55
_NEAREST_ASIDE: Final = 1.1 * TRACK_HALF_WIDTH
"""Feet that pass one another keep so far apart."""
_RISE_M: Final = 0.15
"""Stairs are walked tread by tread: who would climb more in a step takes a shorter one,"""
_HURRY: Final = 2.5
"""so many times as short at most."""
_UNEVEN_M: Final = 0.12
_TREAD_M: Final = 0.26
_TWO_TREADS_M: Final = 0.42
_CLIMB_M: Final = 0.75
"""How far up or down a foot is put ahead by those who take one tread at a time, and by those who
are too fast for that; and at most, under a body that has gone there."""
_HASTY_MPS: Final = 1.6

_OPENING_RAD: Final = 1.6
_CLOSING_RAD: Final = 1.0
"""How far a foot may be turned against the other, outwards and inwards."""


class Course(NamedTuple):
    """Where N bodies are and are going."""

    headings: Floats
    """(N,), radians from +x: where they face if they stand."""
    ahead: Floats
    """(N, AHEAD, 3): places from now on, AHEAD_S apart, metres."""

    def take(self, rows: NDArray[np.int64]) -> Course:
        return Course(self.headings[rows], self.ahead[rows])

    def at(self, seconds: Floats) -> Floats:
        """Places (N, 3) after times (N,)."""
        out = np.empty((len(seconds), 3))
        kernels.fill_places(self.ahead, seconds, out)
        return out

    def velocity(self, seconds: Floats) -> Floats:
        """Velocities (N, 2) about times (N,), metres a second."""
        out = np.empty((len(seconds), 2))
        kernels.fill_velocities(self.ahead, seconds, out)
        return out


class Aim(NamedTuple):
    """What N steps are to reach."""

    landing: Floats
    """(N, 4): footprint."""
    place: Floats
    """(N, 2): of the hips in the end, metres."""
    body: Floats
    """(N, 2): of the body then, which hips may not get to."""
    velocity: Floats
    """(N, 2): and how fast it goes then, metres a second."""
    heading: Floats
    """(N,): where the body wants to face, radians."""


def wanted_headings(course: Course, velocity: Floats) -> Floats:
    """Where bodies want to face, (N,): ahead when they walk."""
    walking = np.hypot(velocity[:, 0], velocity[:, 1]) > WALKING_MPS
    return np.where(walking, np.arctan2(velocity[:, 1], velocity[:, 0]), course.headings)


def durations_s(course: Course, standing: Floats, leg_m: Floats, briskness: Floats) -> Floats:
    """How long steps of bodies with one foot on footprints (N, 4) take: seconds (N,)."""
    velocity = course.velocity(np.full(len(leg_m), 2.0 * AHEAD_S))
    legs_a_second = np.maximum(np.hypot(velocity[:, 0], velocity[:, 1]) / leg_m, 1e-9)
    # Length x duration of a free walk is fixed: what length goes with a speed.
    natural = np.sqrt(step_duration_s(np.full_like(leg_m, 0.6)) * 0.6 * legs_a_second)
    seconds = np.minimum(natural, _LONGEST) / legs_a_second / briskness
    standing_still = legs_a_second * leg_m < 0.5 * WALKING_MPS
    seconds = np.where(standing_still, CLOSING_S, np.minimum(seconds, LONGEST_S))
    rise = np.abs(course.at(seconds)[:, 2] - standing[:, 2])
    shortest = np.where(rise > _UNEVEN_M, SHORTEST_UP_S, SHORTEST_S)
    return np.maximum(within_reach_s(course, standing, leg_m, seconds), shortest)


def within_reach_s(course: Course, standing: Floats, leg_m: Floats, seconds: Floats) -> Floats:
    """Times (N,) cut so that the body does not get too far past its standing foot by then."""
    place = course.at(seconds)
    distance, limit = _stretched(place[:, :2] - standing[:, :2], standing[:, 3])
    speed = np.maximum(np.hypot(*course.velocity(seconds).T), 0.1)
    seconds = seconds - np.maximum(distance - limit * leg_m, 0.0) / speed
    rise = np.abs(place[:, 2] - course.ahead[:, 0, 2])
    steep = np.maximum(rise / _RISE_M, 1.0)
    return np.asarray(np.maximum(seconds / np.minimum(steep, _HURRY), SHORTEST_REST_S))


def _stretched(apart: Floats, heading: Floats) -> tuple[Floats, Floats]:
    """Distances of bodies from feet, (N, 2) apart, and how many legs they may be: (N,), (N,)."""
    distance = np.hypot(apart[:, 0], apart[:, 1])
    ahead = np.einsum("nd,nd->n", apart, _axes(heading)[0]) / np.maximum(distance, 1e-9)
    return distance, _PAST + _PAST_AHEAD * np.maximum(ahead, 0.0)


def aim(
    course: Course,
    right: NDArray[np.bool_],
    standing: Floats,
    leg_m: Floats,
    step_s: Floats,
    left_s: Floats,
    ground: Ground,
) -> Aim:
    """Where feet come down that swing while the others stand on footprints (N, 4).

    Parameters
    ----------
    course : where the bodies go
    right : (N,), whether the standing foot is the right one
    leg_m : (N,)
    step_s, left_s : (N,), how long the whole step takes, and what is left of it
    """
    there = course.at(left_s)
    velocity = course.velocity(left_s)
    wanted = wanted_headings(course, velocity)
    side = np.where(right, 1.0, -1.0)
    turn = side * wrapped(wanted - standing[:, 3])
    heading = standing[:, 3] + side * np.clip(turn, -_CLOSING_RAD, _OPENING_RAD)

    _, limit = _stretched(there[:, :2] - standing[:, :2], standing[:, 3])
    place = _no_further(there[:, :2], standing[:, :2], 1.1 * limit * leg_m)
    forward, left = _axes(heading)
    ahead_mps = np.einsum("nd,nd->n", velocity, forward)
    aside_mps = np.einsum("nd,nd->n", velocity, left)
    ahead = np.where(
        ahead_mps > 0.0,
        leg_m * _front_of_hips(ahead_mps * step_s / leg_m),
        0.5 * ahead_mps * step_s,
    )
    aside = side * TRACK_HALF_WIDTH * leg_m + 0.5 * aside_mps * step_s
    under = there.copy()
    under[:, :2] = place + (side * TRACK_HALF_WIDTH * leg_m)[:, None] * left
    middle = standing[:, 3] + 0.5 * (heading - standing[:, 3])

    foot_m = FOOT * leg_m
    landing = np.empty((len(leg_m), 4))
    landing[:, 2], landing[:, 3] = there[:, 2], heading
    landing[:, :2] = place + ahead[:, None] * forward + aside[:, None] * left
    landing[:, :2] = _limited(landing[:, :2], standing, middle, side, leg_m)
    landing, found = ground.settle(landing, foot_m)
    hasty = np.hypot(velocity[:, 0], velocity[:, 1]) > _HASTY_MPS
    climb_m = np.where(hasty, _TWO_TREADS_M, _TREAD_M)
    far_m = np.full_like(climb_m, _CLIMB_M)
    found &= np.abs(landing[:, 2] - standing[:, 2]) <= climb_m
    if not found.all():
        halfway, beside = 0.5 * (landing[:, :3] + under), standing[:, :3].copy()
        for places in (halfway, under, beside):
            places[:, :2] = _limited(places[:, :2], standing, middle, side, leg_m)
        for places, limit_m in (
            (halfway, climb_m),
            (under, climb_m),
            (under, far_m),
            (beside, far_m),
        ):
            found = _put(landing, places, found, standing[:, 2], limit_m, foot_m, ground)
    landing[:, :3] = np.round(landing[:, :3], 4)  # as it is told, or feet would land beside it
    place = _no_further(place, landing[:, :2], _BEHIND * leg_m)
    return Aim(landing, place, there[:, :2], velocity, wanted)


def _put(
    landing: Floats,
    places: Floats,
    found: NDArray[np.bool_],
    from_m: Floats,
    limit_m: Floats,
    foot_m: Floats,
    ground: Ground,
) -> NDArray[np.bool_]:
    """Put feet that have found no ground elsewhere, (N, 3), not too far up or down; in place.

    Returns who has found some now.
    """
    rows = np.flatnonzero(~found)
    tried = landing[rows]
    tried[:, :3] = places[rows]
    landing[rows], there = ground.settle(tried, foot_m[rows])
    there &= np.abs(landing[rows, 2] - from_m[rows]) <= limit_m[rows]
    now = found.copy()
    now[rows[there]] = True
    return now


def _limited(
    points: Floats, standing: Floats, middle: Floats, side: Floats, leg_m: Floats
) -> Floats:
    """Places (N, 2) for feet: on their own side of the standing foot, and within reach."""
    forward, left = _axes(middle)
    apart = points - standing[:, :2]
    ahead = np.clip(
        np.einsum("nd,nd->n", apart, forward), -_FURTHEST_BACK * leg_m, _FURTHEST * leg_m
    )
    aside = np.clip(
        side * np.einsum("nd,nd->n", apart, left),
        _NEAREST_ASIDE * leg_m,
        _FURTHEST_ASIDE * leg_m,
    )
    return np.asarray(standing[:, :2] + ahead[:, None] * forward + (side * aside)[:, None] * left)


def _no_further(points: Floats, origin: Floats, limit_m: Floats) -> Floats:
    apart = points - origin
    distance = np.maximum(np.hypot(apart[:, 0], apart[:, 1]), 1e-9)
    return np.asarray(origin + apart * (np.minimum(distance, limit_m) / distance)[:, None])


def _axes(heading: Floats) -> tuple[Floats, Floats]:
    forward = np.stack([np.cos(heading), np.sin(heading)], axis=1)
    return forward, np.stack([-forward[:, 1], forward[:, 0]], axis=1)


_VELOCITIES: Final = np.linspace(0.0, RV_LONGEST, 65)
_POSES: Final = double_support(_VELOCITIES)
_LENGTHS: Final = planted_length(_POSES)


def _front_of_hips(length: Floats) -> Floats:
    """How far ahead of the hips the heel of a step of some length comes down, legs (N,)."""
    return np.interp(np.minimum(length, longest_step()), _LENGTHS, _POSES.front_forward)
