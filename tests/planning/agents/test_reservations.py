"""Certain obstacles in CT-space against looking at everyone."""

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from esplanade.planning.agents._reservation_kernels import (
    conflict,
    crowding,
    meetings,
    others_near,
    room_wanted,
)
from tests.naive import reservations as naive
from tests.planning.worlds import holds, open_grid, reserved

SLICES = 3
BODIES_OVERLAP_M = 1.8
MARGIN_M = 0.03
SOFT = 0.25
MEETING_ROOM_M = 0.8
MEETING_ROOM = 0.2
QUEUE_ROOM_M = 0.5
QUEUE_ROOM = 0.2


EAST, WEST = (1.0, 0.0), (-1.0, 0.0)


def straight(start, velocity):
    return np.array(start) + 0.2 * np.arange(SLICES + 1)[:, None] * np.array(velocity)


@given(st.integers(0, 10_000), st.integers(1, 12), st.sampled_from([1.0, 4.0]))
@example(seed=0, actors=12, fastest=4.0)
@holds(120, 30)
def test_conflicts_are_those_of_looking_at_everyone(seed, actors, fastest) -> None:
    rng = np.random.default_rng(seed)
    paths = np.array(
        [
            straight(rng.uniform(2.5, 5.5, 2), rng.uniform(-0.7, 0.7, 2) * fastest)
            for _ in range(actors)
        ]
    )
    r = reserved(
        open_grid(8.0),
        paths,
        radii_m=rng.uniform(0.15, 0.9, actors),
        ranks=rng.permutation(actors),
        heights=rng.choice([0.0, 1.0, 3.0], actors),
        fastest_m=0.2 * fastest,
    )
    _hold_up_some(r, rng)
    for me in range(actors):
        a = paths[me, 1]
        angle = rng.uniform(0.0, 2.0 * math.pi)
        b = a + 0.2 * fastest * np.array([math.cos(angle), math.sin(angle)])
        blocked, soft = conflict(r, me, r.heights[me, 2], 1, *a, *b)
        expected = naive.conflict(r, MARGIN_M, me, r.heights[me, 2], 1, tuple(a), tuple(b))
        assert blocked == expected[0]
        if not blocked:
            assert soft == pytest.approx(expected[1])


def _hold_up_some(r, rng) -> None:
    turns = rng.uniform(0.0, 2.0 * math.pi, len(r.paths))
    r.courses[:] = np.column_stack([np.cos(turns), np.sin(turns)])
    r.held_up[:] = rng.random(len(r.paths)) < 0.4


def test_swapping_places_is_a_meeting() -> None:
    paths = np.array([straight((3.0, 4.0), (3.0, 0.0)), straight((3.6, 4.0), (-3.0, 0.0))])
    r = reserved(open_grid(8.0), paths, (0.2, 0.2), (1, 0), fastest_m=0.6)
    assert conflict(r, 0, 0, 0, 3.0, 4.0, 3.6, 4.0)[0]


def test_who_goes_first_is_not_forbidden_but_pays() -> None:
    paths = np.array([straight((3.0, 4.0), (0.0, 0.0)), straight((3.6, 4.0), (0.0, 0.0))])
    r = reserved(open_grid(8.0), paths, (0.25, 0.25), (0, 1))
    assert conflict(r, 0, 0, 0, 3.0, 4.0, 3.3, 4.0) == (False, SOFT)
    assert conflict(r, 1, 0, 0, 3.6, 4.0, 3.3, 4.0)[0]


def test_who_is_too_close_may_draw_apart_but_not_come_nearer() -> None:
    paths = np.array([straight((3.0, 4.0), (0.0, 0.0)), straight((3.3, 4.0), (0.0, 0.0))])
    r = reserved(open_grid(8.0), paths, (0.25, 0.25), (1, 0))
    assert conflict(r, 0, 0, 0, 3.0, 4.0, 2.8, 4.0) == (False, 0.0)
    assert conflict(r, 0, 0, 0, 3.0, 4.0, 3.1, 4.0)[0]


def test_who_cannot_get_out_of_the_way_in_time_may_begin_to() -> None:
    """One who goes first comes at 1.3 m/s and would touch me in this slice, wherever I stand."""
    paths = np.array([straight((3.0, 4.0), (1.3, 0.0)), straight((3.6, 4.1), (0.0, 0.0))])
    r = reserved(open_grid(8.0), paths, (0.25, 0.25), (0, 1))
    away = (3.6, 4.1, 3.65, 4.16)
    assert conflict(r, 1, 0, 0, *away) == (False, SOFT)
    assert conflict(r, 1, 0, 0, 3.6, 4.1, 3.6, 4.1)[0], "standing gains nothing"
    assert conflict(r, 1, 0, 0, 3.6, 4.1, 3.55, 4.05)[0], "nor does coming nearer"


def test_who_has_time_to_get_out_of_the_way_has_to() -> None:
    paths = np.array([straight((2.5, 4.0), (1.3, 0.0)), straight((3.6, 4.1), (0.0, 0.0))])
    r = reserved(open_grid(8.0), paths, (0.25, 0.25), (0, 1))
    assert conflict(r, 1, 0, 2, 3.6, 4.1, 3.65, 4.16)[0]


def _two(apart_m, course, other_course, held_up):
    """One at (4, 4) and another `apart_m` east of contact, both standing."""
    paths = np.array(
        [straight((4.0, 4.0), (0.0, 0.0)), straight((4.5 + MARGIN_M + apart_m, 4.0), (0.0, 0.0))]
    )
    r = reserved(open_grid(9.0), paths, (0.25, 0.25), (0, 1))
    r.courses[:] = course, other_course
    r.held_up[:] = held_up
    return r


@pytest.mark.parametrize("course", [EAST, WEST])
def test_where_everyone_gets_along_nobody_wants_room(course) -> None:
    r = _two(0.01, EAST, course, (False, False))
    assert room_wanted(r, 0, 1) == 0.0
    assert conflict(r, 0, 0, 1, 4.0, 4.0, 4.0, 4.0) == (False, 0.0)


@pytest.mark.parametrize("part", [0.05, 0.5, 0.95])
def test_those_who_queue_want_room_to_each_other(part) -> None:
    r = _two(QUEUE_ROOM_M * (1.0 - part), EAST, EAST, (True, True))
    assert crowding(r, 0, 1, 2, 4.0, 4.0) == pytest.approx(part * QUEUE_ROOM)
    assert crowding(_two(0.01, EAST, EAST, (True, False)), 0, 1, 2, 4.0, 4.0) == 0.0


@pytest.mark.parametrize("held_up", [(True, False), (False, True), (True, True)])
def test_those_who_want_against_each_other_keep_to_the_right(held_up) -> None:
    """The other is east of me; going north I have it on the right, going south on the left."""
    room_m = 0.5 * MEETING_ROOM_M
    weights = [
        crowding(_two(room_m, course, (-course[0], -course[1]), held_up), 0, 1, 2, 4.0, 4.0)
        for course in ((0.0, 1.0), EAST, (0.0, -1.0))
    ]
    assert weights == pytest.approx([0.75 * MEETING_ROOM, 0.25 * MEETING_ROOM, 0.0])


@given(st.integers(0, 10_000), st.sampled_from([1.0, 2.0]))
@holds(60, 20)
def test_those_listed_as_near_are_all_who_matter(seed, fastest) -> None:
    rng = np.random.default_rng(seed)
    paths = np.array(
        [straight(rng.uniform(1.5, 6.5, 2), rng.uniform(-0.7, 0.7, 2) * fastest) for _ in range(15)]
    )
    r = reserved(open_grid(8.0), paths, [0.25] * 15, range(15), fastest_m=0.2 * fastest)
    _hold_up_some(r, rng)
    others = np.zeros(64, dtype=np.int64)
    a = paths[9, 0]
    met, crowded = others_near(r, 9, 0, 0, *a, 0.2 * fastest, others)
    b = a + rng.uniform(-0.14, 0.14, 2) * fastest
    c = b + rng.uniform(-0.14, 0.14, 2) * fastest
    first, second = conflict(r, 9, 0, 0, *a, *b), conflict(r, 9, 0, 1, *b, *c)
    blocked, soft = meetings(r, others, met, crowded, 9, 0, *a, *b, *c)
    assert blocked == (first[0] or second[0])
    if not blocked:
        assert soft == pytest.approx(first[1] + second[1])


@pytest.mark.parametrize(
    ("apart_m", "met"),
    [(0.0, True), (1.7, True), (BODIES_OVERLAP_M + 0.01, False), (-1.7, True), (-3.0, False)],
)
def test_who_is_above_or_below_is_met_only_where_bodies_overlap(apart_m, met) -> None:
    paths = np.array([straight((3.0, 4.0), (0.0, 0.0)), straight((3.3, 4.0), (0.0, 0.0))])
    r = reserved(open_grid(8.0), paths, (0.25, 0.25), (1, 0), heights=(3.0, 3.0 + apart_m))
    assert conflict(r, 0, 3.0, 0, 3.0, 4.0, 3.1, 4.0)[0] == met
    others = np.zeros(4, dtype=np.int64)
    assert others_near(r, 0, 3.0, 0, 3.0, 4.0, 0.3, others) == (int(met), 0)


def test_who_comes_down_is_met_from_the_slice_on_in_which_it_is_low_enough() -> None:
    paths = np.array([straight((3.0, 4.0), (0.0, 0.0)), straight((3.3, 4.0), (0.0, 0.0))])
    r = reserved(open_grid(8.0), paths, (0.25, 0.25), (1, 0), heights=(0.0, 0.0))
    r.heights[1] = [3.0, 2.5, 1.0, 0.0]
    blocked = [conflict(r, 0, 0.0, k, 3.0, 4.0, 3.1, 4.0)[0] for k in range(SLICES)]
    assert blocked == [False, True, True]


@given(st.integers(0, 1000), st.integers(1, 40))
@holds(40, 20)
def test_the_index_lists_everyone_once_in_the_right_bucket(seed, actors) -> None:
    rng = np.random.default_rng(seed)
    paths = rng.uniform(-1.0, 9.0, (actors, 2, 2))
    r = reserved(open_grid(8.0), paths, [0.25] * actors, range(actors))
    for k in range(2):
        assert sorted(r.members[k]) == list(range(actors))
        assert (np.diff(r.starts[k]) >= 0).all()
        assert r.starts[k, -1] == actors
        for b in range(r.nx * r.ny):
            for m in r.members[k, r.starts[k, b] : r.starts[k, b + 1]]:
                x, y = np.clip((paths[m, k] / r.bucket_m).astype(int), 0, (r.nx - 1, r.ny - 1))
                assert y * r.nx + x == b


@pytest.mark.parametrize("radius_m", [0.15, 0.5])
def test_buckets_are_wide_enough_for_whoever_can_be_met(radius_m) -> None:
    r = reserved(open_grid(8.0), None, (radius_m,), (0,), fastest_m=0.8)
    assert r.bucket_m >= 2.0 * radius_m + MARGIN_M + MEETING_ROOM_M + 2.0 * 0.8
