"""Certain obstacles in CT-space against looking at everyone."""

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from planning._reservation_kernels import MARGIN_M, OVERLAP_M, SOFT, conflict, others_near
from tests.naive import reservations as naive
from tests.planning.worlds import holds, open_grid, reserved

SLICES = 3


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
        radii_m=rng.uniform(0.15, 0.5, actors),
        ranks=rng.permutation(actors),
        heights=rng.choice([0.0, 1.0, 3.0], actors),
        fastest_m=0.2 * fastest,
    )
    for me in range(actors):
        a = paths[me, 1]
        angle = rng.uniform(0.0, 2.0 * math.pi)
        b = a + 0.2 * fastest * np.array([math.cos(angle), math.sin(angle)])
        blocked, soft = conflict(r, me, r.heights[me, 2], 1, *a, *b)
        expected = naive.conflict(r, MARGIN_M, me, r.heights[me, 2], 1, tuple(a), tuple(b))
        assert blocked == expected[0]
        if not blocked:
            assert soft == expected[1]


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


@pytest.mark.parametrize(
    ("apart_m", "met"),
    [(0.0, True), (1.7, True), (OVERLAP_M + 0.01, False), (-1.7, True), (-3.0, False)],
)
def test_who_is_above_or_below_is_met_only_where_bodies_overlap(apart_m, met) -> None:
    paths = np.array([straight((3.0, 4.0), (0.0, 0.0)), straight((3.3, 4.0), (0.0, 0.0))])
    r = reserved(open_grid(8.0), paths, (0.25, 0.25), (1, 0), heights=(3.0, 3.0 + apart_m))
    assert conflict(r, 0, 3.0, 0, 3.0, 4.0, 3.1, 4.0)[0] == met
    others = np.zeros(4, dtype=np.int64)
    assert others_near(r, 0, 3.0, 0, 3.0, 4.0, 0.3, others) == met


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
    assert r.bucket_m >= 2.0 * radius_m + MARGIN_M + 2.0 * 0.8
