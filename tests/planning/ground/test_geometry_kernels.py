"""Points, segments and sliding against what is obviously right."""

import math

import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from esplanade.planning.ground import _geometry_kernels as kernels
from tests.naive import geometry as naive
from tests.planning.worlds import holds, lines, open_grid, points, scaled

spots = points(-3.0, 3.0)


@given(spots, spots, spots)
@holds(200, 100)
def test_distance_to_a_segment(p, a, b) -> None:
    distance, x, y = kernels.nearest_on_segment(*p, *a, *b)
    assert distance == pytest.approx(naive.point_segment_distance(p, a, b), abs=1e-9)
    assert kernels.point_segment_distance(*p, *a, *b) == pytest.approx(distance, abs=1e-12)
    assert math.dist(p, (x, y)) == pytest.approx(distance, abs=1e-12)
    assert naive.point_segment_distance((x, y), a, b) < 1e-9


@given(spots, spots, spots, spots)
@example((0.0, 0.0), (2.0, 0.0), (1.0, 0.0), (3.0, 0.0))
@example((0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0))
@example((0.0, 0.0), (0.0, 0.0), (-1.0, 0.0), (1.0, 0.0))
@holds(300, 100)
def test_segments_cross(a, b, c, d) -> None:
    apart = naive.segment_distance(a, b, c, d)
    assume(apart == 0.0 or apart > 1e-6)
    assert kernels.segments_cross(*a, *b, *c, *d) == naive.segments_meet(a, b, c, d)


@given(spots, spots)
@holds(50, 30)
def test_closest_approach(relative, change) -> None:
    exact = kernels.closest_approach(*relative, *change)
    assert exact == pytest.approx(naive.closest_approach(relative, change), abs=1e-3)


@given(lines(0.0, 6.0, 8), points(0.0, 6.0))
@holds(60, 15)
def test_the_index_finds_the_nearest_barrier_within_its_reach(walls, p) -> None:
    grid = open_grid(6.0, walls)
    placement = kernels.Placement(0.0, 0.0, 1.8, 0.6, 0.9)
    found = kernels.nearest_barrier(grid.index, placement, 0.25, *p)[0]
    nearest = min([math.inf, *(naive.point_segment_distance(p, *wall) for wall in walls)])
    if nearest <= grid.index.reach_m:
        assert found == pytest.approx(nearest, abs=1e-9)
    else:
        assert found > grid.index.reach_m


@given(
    lines(0.0, 5.0, 5),
    points(0.0, 5.0),
    st.lists(points(-1.5, 1.5), min_size=1, max_size=scaled(12, 3)),
    st.sampled_from([0.0, 0.1, 0.25, 0.6]),
)
@example([((2.5, 0.0), (2.5, 2.5))], (2.0, 0.0), [(0.5, -0.5)] * 6, 0.0)
@example([((2.5, 0.0), (2.5, 2.5))], (2.0, 0.0), [(0.5, -0.5)] * 6, 0.25)
@example([((2.5, 5.0), (1.5, 2.5))], (2.0, 5.0), [(0.5, 0.5)] * 6, 0.1)
@holds(300, 20)
def test_a_walk_never_crosses_a_wall_nor_the_bounds(walls, start, moves, clearance) -> None:
    grid = open_grid(5.0, walls)
    position = np.array([start])
    inside_of = [naive.point_segment_distance(start, *wall) for wall in walls]
    assume(all(away > 1e-3 for away in inside_of))
    for move in moves:
        before = position
        position, heights = grid.walk(before, [0], [move], clearance)
        assert heights.tolist() == [0.0]
        assert (position >= 0.0).all()
        assert (position <= 5.0).all()
        assert np.hypot(*(position - before)[0]) <= math.hypot(*move) + 2.0 * clearance + 1e-9
    for wall in walls:
        assert naive.point_segment_distance(tuple(position[0]), *wall) >= (
            min([clearance, *inside_of]) - 1e-6
        )


@given(lines(0.0, 5.0, 4), points(0.2, 4.8), points(-0.4, 0.4), st.sampled_from([0.0, 0.1, 0.25]))
@example([((2.5, 0.0), (2.5, 2.5))], (2.48, 0.2), (0.4, -0.4), 0.0)
@holds(300, 40)
def test_a_short_walk_ends_on_the_same_side(walls, start, move, clearance) -> None:
    grid = open_grid(5.0, walls)
    assume(all(naive.point_segment_distance(start, *wall) > 1e-3 for wall in walls))
    end = grid.walk([start], [0], [move], clearance)[0][0]
    crossed = [wall for wall in walls if naive.segments_meet(start, tuple(end), *wall)]
    for wall in crossed:
        ends = min(naive.point_segment_distance(p, start, tuple(end)) for p in wall)
        assert ends < math.hypot(*move), "only around the end of a wall may the chord cross it"


def test_a_walk_slides_along_a_wall() -> None:
    grid = open_grid(8.0, [((4.0, 0.0), (4.0, 8.0))])
    end, _ = grid.walk([(3.0, 2.0)], [0], [(2.0, 2.0)], 0.25)
    assert end[0] == pytest.approx([3.75, 4.0], abs=1e-6)


def test_who_stands_too_close_is_let_out_but_not_further_in() -> None:
    grid = open_grid(8.0, [((4.0, 0.0), (4.0, 8.0))])
    inward, _ = grid.walk([(3.9, 4.0)], [0], [(0.5, 0.0)], 0.25)
    outward, _ = grid.walk([(3.9, 4.0)], [0], [(-0.5, 0.0)], 0.25)
    assert inward[0] == pytest.approx([3.9, 4.0], abs=1e-6)
    assert outward[0] == pytest.approx([3.4, 4.0], abs=1e-6)


def test_a_closed_room_holds_whoever_is_in_it() -> None:
    room = [
        ((2.0, 2.0), (6.0, 2.0)),
        ((6.0, 2.0), (6.0, 6.0)),
        ((6.0, 6.0), (2.0, 6.0)),
        ((2.0, 6.0), (2.0, 2.0)),
    ]
    grid = open_grid(8.0, room)
    rng = np.random.default_rng(5)
    people = scaled(200, 20)
    for clearance in (0.0, 0.2):
        positions = rng.uniform(2.3, 5.7, (people, 2))
        for _ in range(scaled(100, 5)):
            ways = rng.normal(0.0, 1.0, (people, 2))
            positions, _ = grid.walk(positions, np.zeros(people), ways, clearance)
        assert (positions > 2.0).all()
        assert (positions < 6.0).all()


@pytest.mark.parametrize(
    ("positions", "heights", "displacements", "clearance", "message"),
    [
        ([(1.0, 1.0)], [0], [(math.nan, 0.0)], 0.2, "displacements must be finite"),
        ([(1.0, 1.0)], [0], [(math.inf, 0.0)], 0.2, "displacements must be finite"),
        ([(math.nan, 1.0)], [0], [(0.1, 0.0)], 0.2, "positions and heights must be finite"),
        ([(1.0, 1.0)], [math.nan], [(0.1, 0.0)], 0.2, "heights must be finite"),
        ([(1.0, 1.0)], [0, 0], [(0.1, 0.0)], 0.2, "1 positions but 2 heights"),
        ([(1.0, 1.0)], [0], [(0.1, 0.0), (0.0, 0.0)], 0.2, "1 positions but 2 displacements"),
        ([(1.0, 1.0)], [0], [(0.1, 0.0)], -0.1, "clearance_m"),
        ([(1.0, 1.0)], [0], [(0.1, 0.0)], 1.1, "clearance_m"),
    ],
)
def test_a_walk_names_what_is_wrong(positions, heights, displacements, clearance, message) -> None:
    with pytest.raises(ValueError, match=message):
        open_grid().walk(positions, heights, displacements, clearance)


@given(
    st.tuples(st.floats(0.0, 5.0), st.floats(0.1, 3.0)),
    st.sampled_from([0.0, 0.3, 0.5, math.inf]),
    st.tuples(st.floats(0.0, 5.0), st.floats(1.0, 2.0), st.floats(0.1, 0.8)),
)
@example((0.0, 0.6), math.inf, (0.0, 1.8, 0.6))
@example((1.8, 1.0), math.inf, (0.0, 1.8, 0.6))
@example((0.0, 2.0), 0.3, (0.0, 1.8, 0.3))
@holds(200, 60)
def test_which_barriers_stop_which_bodies(barrier, climb, placement) -> None:
    """A body passes if it can step over, pass under, or step down where the floor drops."""
    bottom, height = barrier
    floor, tall, step = placement
    row = np.array([(2.0, 0.0, 2.0, 5.0, bottom, bottom + height, climb)], dtype=kernels.BARRIER)
    steps_over = bottom + height - floor <= step
    passes_under = bottom - floor >= tall
    steps_down = climb <= step
    edge = min(abs(bottom + height - floor - step), abs(bottom - floor - tall), abs(climb - step))
    assume(edge > 2.0 * kernels.TOLERANCE_M or placement in ((0.0, 1.8, 0.6), (0.0, 1.8, 0.3)))
    free = steps_over or passes_under or steps_down
    assert kernels.stops(row[0], kernels.Placement(floor, floor, tall, step, step)) == (not free)


@pytest.mark.parametrize("top", [0.1 * 6, float(np.float32(0.6)), 0.6])
def test_a_step_as_high_as_the_body_steps_stops_it_in_no_rounding(top: float) -> None:
    row = np.array([(2.0, 0.0, 2.0, 5.0, 0.0, top, math.inf)], dtype=kernels.BARRIER)
    row = np.concatenate([row, row])
    row["climb_m"][1], row["top_m"][1] = top, 2.0
    for barrier in row:
        assert not kernels.stops(barrier, kernels.Placement(0.0, 0.0, 1.8, 0.6, 0.9))


def test_steps_count_from_the_support_and_heads_from_the_floor() -> None:
    low, high = np.array(
        [(2.0, 0.0, 2.0, 5.0, 0.0, 0.4, math.inf), (3.0, 0.0, 3.0, 5.0, 1.85, 9.0, 9.0)],
        dtype=kernels.BARRIER,
    )
    for support, stopped in ((0.0, True), (0.1, False)):
        assert kernels.stops(low, kernels.Placement(0.0, support, 1.8, 0.3, 0.6)) == stopped
    assert not kernels.stops(high, kernels.Placement(0.0, 0.1, 1.8, 0.3, 0.6))
