"""Whole ways through layered scenes: those of the paper, and those that it does not draw."""

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning import Body, LayeredGrid, PathStatus, Polygon, Ramp, Scene, Wall, find_path
from tests.planning.storeys import bodies, box, cluttered, flight, grid_of, walk_through
from tests.planning.worlds import holds

ADULT, CHILD = Body.adult(), Body.child()


def found(grid, start, goal, body=ADULT):
    """A path that must exist and be walkable."""
    path = find_path(grid, start, goal, body)
    assert path.status is PathStatus.FOUND
    walk_through(path, grid, body)
    assert math.dist(path.points[0], start) < 0.5
    assert math.dist(path.points[-1], goal) < 0.5
    return path


def figure_7() -> LayeredGrid:
    """Stairs with risers of 0.45 m on the left; on the right a floor raised to 1 m below a slab.

    The slab is layer 2, 2.50 m up; steps of 0.25 m lead onto the raised floor.
    """
    slab = box(2.0, 0.0, 16.0, 16.0, 0.2, offset_m=2.5)
    raised = [box(8.0 + 0.5 * k, 4.0, 14.0 - 0.5 * k, 12.0, 0.25 * (k + 1)) for k in range(4)]
    stairs = [flight((0.9, 1.0 + y), (0.9, 5.0 + y), 1.8, 2.7, 6) for y in (0.0, 8.0)]
    walls = [box(8.0, 0.0, 14.0, 4.0, 2.4), box(8.0, 12.0, 14.0, 16.0, 2.4)]
    landings = [box(0.0, y, 2.0, y + 3.0, 0.2, offset_m=2.5) for y in (5.0, 13.0)]
    return grid_of(16.0, [slab, *landings, *raised, *walls], stairs=stairs)


def test_figure_7_only_the_tall_one_climbs_risers_of_45_cm() -> None:
    grid = figure_7()
    foot, upstairs = (0.9, 0.3, 0.0), (10.0, 8.0, 2.7)
    up = found(grid, foot, upstairs, ADULT)
    assert set(up.layers.tolist()) == {0, 1}
    assert np.diff(up.points[:, 2]).max() == pytest.approx(0.45, abs=1e-5)
    assert find_path(grid, foot, upstairs, CHILD).status is PathStatus.NO_WAY


def test_figure_7_only_the_short_one_passes_where_150_cm_are_left() -> None:
    grid = figure_7()
    left, right = (5.0, 8.0, 0.0), (15.2, 8.0, 0.0)
    through = found(grid, left, right, CHILD)
    assert through.points[:, 2].max() == pytest.approx(1.0)
    assert find_path(grid, left, right, ADULT).status is PathStatus.NO_WAY


def figure_8() -> LayeredGrid:
    """A ground floor with a wall across it, an upper floor, and stairs between the two."""
    upper = box(6.0, 0.0, 12.0, 12.0, 0.2, offset_m=2.6)
    walls = [
        Wall(start=start, end=end, height_m=3.5)
        for start, end in (
            ((3.0, 0.0), (3.0, 7.0)),
            ((1.8, 9.0), (6.0, 9.0)),
            ((1.8, 11.0), (6.0, 11.0)),
        )
    ]
    return grid_of(12.0, [upper], walls, [flight((1.8, 10.0), (6.0, 10.0), 2.0, 2.8, 16)])


@pytest.mark.parametrize("body", [ADULT, CHILD])
def test_figure_8_from_the_ground_to_the_upper_floor_with_headings(body) -> None:
    path = found(figure_8(), (5.0, 1.0, 0.0), (10.0, 2.0, 2.8), body)
    assert path.layers[0] == 0
    assert path.layers[-1] == 1
    assert path.points[-1, 2] == pytest.approx(2.8)
    climbing = (path.points[:, 2] > 1.0) & (path.points[:, 2] < 2.4)
    assert np.abs(path.headings[climbing]).max() < math.radians(30)
    assert abs(path.headings[0] - math.pi / 2) < math.radians(45)
    steps = np.diff(path.points[:, :2], axis=0)
    turns = np.abs(np.angle(np.exp(1j * np.diff(path.headings))))
    assert turns.max() < math.radians(100)
    along = (steps * np.c_[np.cos(path.headings[:-1]), np.sin(path.headings[:-1])]).sum(axis=1)
    assert (along > 0.0).all()
    corners = [(5.0, 1.0), (3.0, 7.3), (1.8, 9.5), (6.0, 9.5), (10.0, 2.0)]
    straight = sum(math.dist(p, q) for p, q in pairwise(corners))
    assert path.length_m < 1.1 * straight


def test_the_goal_may_lie_right_above_or_below_the_start() -> None:
    grid = figure_8()
    up = found(grid, (9.0, 6.0, 0.0), (9.0, 6.0, 2.8))
    down = found(grid, (9.0, 6.0, 2.8), (9.0, 6.0, 0.0))
    assert up.length_m == pytest.approx(down.length_m, rel=0.02)
    assert up.length_m > 15.0
    assert (up.layers[0], up.layers[-1]) == (0, 1)


def spiral(turns: int) -> LayeredGrid:
    """A square spiral of gentle ramps around a core, each turn 3 m above the one before."""
    a, b, c, d = 1.0, 3.0, 6.0, 8.0
    ramps = []
    for turn in range(turns):
        for side in range(4):
            low = 3.0 * turn + 0.75 * side
            corners, ways = {
                0: (((b, a), (d, a), (d, b), (b, b)), ((b, a), (d, a))),
                1: (((c, b), (d, b), (d, d), (c, d)), ((d, b), (d, d))),
                2: (((a, c), (c, c), (c, d), (a, d)), ((c, d), (a, d))),
                3: (((a, a), (b, a), (b, c), (a, c)), ((a, c), (a, a))),
            }[side]
            ramps.append(
                Polygon(
                    points=corners,
                    offset_m=max(0.0, low - 0.2),
                    height_m=0.95 if low else 0.75,
                    kind="floor",
                    ramp=Ramp(start=ways[0], end=ways[1], start_height_m=0.2 if low else 0.0),
                )
            )
    return grid_of(9.0, ramps)


@pytest.mark.parametrize("body", [ADULT, CHILD])
def test_a_spiral_leads_up_over_itself(body) -> None:
    grid = spiral(3)
    path = found(grid, (2.6, 2.0, 0.0), (2.0, 2.0, 8.9), body)
    assert path.points[-1, 2] == pytest.approx(9.0, abs=0.4)
    assert (np.diff(path.points[:, 2]) > -0.05).all()
    assert path.length_m > 40.0


def bridge() -> LayeredGrid:
    """A deck from west to east with stairs at both ends, over a path from south to north."""
    deck = box(3.0, 4.0, 9.0, 6.0, 0.25, offset_m=2.5)
    sides = [Wall(start=(3.0, y), end=(9.0, y), height_m=1.1, offset_m=2.75) for y in (4.0, 6.0)]
    stairs = [
        flight((0.0, 5.0), (3.0, 5.0), 2.0, 2.75, 11),
        flight((12.0, 5.0), (9.0, 5.0), 2.0, 2.75, 11),
    ]
    return grid_of(12.0, [deck], sides, stairs)


def test_a_bridge_is_crossed_above_and_passed_below() -> None:
    grid = bridge()
    above = found(grid, (4.0, 5.0, 2.75), (8.0, 5.0, 2.75))
    below = found(grid, (6.0, 1.0, 0.0), (6.0, 11.0, 0.0))
    assert above.length_m == pytest.approx(4.0)
    assert below.length_m == pytest.approx(10.0)
    assert set(above.points[:, 2].tolist()) == {2.75}
    assert set(below.points[:, 2].tolist()) == {0.0}
    down = found(grid, (6.0, 5.0, 2.75), (6.0, 5.0, 0.0))
    assert down.length_m > 10.0


def test_a_thin_wall_is_walked_around() -> None:
    grid = grid_of(8.0, walls=[Wall(start=(4.0, 0.0), end=(4.0, 6.0), height_m=2.5)])
    path = found(grid, (3.0, 1.0, 0.0), (5.0, 1.0, 0.0))
    assert path.length_m > 2 * 5.2
    at_wall = path.points[np.abs(path.points[:, 0] - 4.0) < 0.2]
    assert at_wall[:, 1].min() > 6.1


def test_the_path_begins_and_ends_exactly_where_asked() -> None:
    path = found(grid_of(8.0), (1.03, 1.11, 0.0), (6.4, 5.9, 0.0))
    assert path.points[0].tolist() == [1.03, 1.11, 0.0]
    assert path.points[-1].tolist() == [6.4, 5.9, 0.0]
    assert path.points.dtype == np.float64
    assert path.layers.dtype == np.int64
    assert path.headings.dtype == np.float64
    assert path.length_m == pytest.approx(math.hypot(5.37, 4.79))
    there = find_path(grid_of(8.0), (1.0, 1.0, 0.0), (1.0, 1.0, 0.0))
    assert there.status is PathStatus.FOUND
    assert there.length_m == 0.0


def test_the_nearest_floor_is_meant() -> None:
    grid = figure_8()
    assert find_path(grid, (9.0, 6.0, 0.4), (9.0, 6.0, 2.3)).layers[[0, -1]].tolist() == [0, 1]
    nowhere = find_path(grid, (9.0, 6.0, 1.4), (5.0, 5.0, 0.0))
    assert nowhere.status is PathStatus.START_BLOCKED


def test_who_stands_too_near_a_wall_is_moved_but_never_through_it() -> None:
    wall = Wall(start=(4.0, 0.0), end=(4.0, 8.0), height_m=2.5)
    grid = grid_of(8.0, walls=[wall])
    path = found(grid, (3.95, 4.0, 0.0), (1.0, 4.0, 0.0))
    assert path.points[0, 0] == pytest.approx(3.75, abs=2e-3)
    assert find_path(grid, (4.05, 4.0, 0.0), (1.0, 4.0, 0.0)).status is PathStatus.NO_WAY


def test_inside_walls_nobody_stands_and_out_of_closets_one_is_let() -> None:
    block = box(2.0, 2.0, 6.0, 6.0, 30.0)
    closet = [
        Wall(start=a, end=b)
        for a, b in (
            ((7.0, 7.0), (7.4, 7.0)),
            ((7.4, 7.0), (7.4, 7.4)),
            ((7.4, 7.4), (7.0, 7.4)),
            ((7.0, 7.4), (7.0, 7.0)),
        )
    ]
    grid = grid_of(8.0, [block], closet)
    outside, inside, shut_in = (1.0, 1.0, 0.0), (4.0, 4.0, 0.0), (7.2, 7.2, 0.0)
    assert find_path(grid, inside, outside).status is PathStatus.START_BLOCKED
    assert find_path(grid, outside, inside).status is PathStatus.GOAL_BLOCKED
    assert len(find_path(grid, outside, inside).points) == 0
    for ends in ((shut_in, outside), (outside, shut_in)):
        path = found(grid, *ends)
        moved = path.points[0] if ends[0] is shut_in else path.points[-1]
        assert 0.4 < math.dist(moved, shut_in) <= 0.5


@pytest.mark.parametrize(
    "point", [(math.nan, 1.0, 0.0), (1.0, math.inf, 0.0), (1.0, 1.0, math.nan), (1.0, 1.0)]
)
@pytest.mark.parametrize("which", ["start", "goal"])
def test_points_that_are_none_are_refused_by_name(point, which) -> None:
    grid, fine = grid_of(4.0), (2.0, 2.0, 0.0)
    ends = (point, fine) if which == "start" else (fine, point)
    with pytest.raises(ValueError, match=f"{which} must be three finite numbers"):
        find_path(grid, *ends)


def test_points_beyond_the_bounds_are_refused() -> None:
    with pytest.raises(ValueError, match=r"goal: .* outside the bounds"):
        find_path(grid_of(4.0), (1.0, 1.0, 0.0), (5.0, 1.0, 0.0))


@given(cluttered(), bodies, st.integers(0, 10**6))
@holds(40, 5)
def test_every_path_is_walkable(grid, body, pick) -> None:
    random = np.random.default_rng(pick)
    a = grid.layered
    for _ in range(4):
        ends = []
        for cell in random.choice(np.flatnonzero(np.isfinite(a.floors)), 2):
            _, j, i = a.places[cell]
            x, y = (np.array([i, j]) + random.random(2)) * a.cell_m
            ends.append((float(x), float(y), float(a.floors[cell])))
        path = find_path(grid, ends[0], ends[1], body)
        if path.status is PathStatus.FOUND:
            walk_through(path, grid, body)


def test_a_scene_without_any_surface_to_stand_on_blocks_everyone() -> None:
    scene = Scene(bounds=(0.0, 0.0, 4.0, 4.0), polygons=(box(-1.0, -1.0, 5.0, 5.0, 40.0),))
    grid = LayeredGrid.from_scene(scene)
    assert find_path(grid, (2, 2, 0), (1, 1, 0)).status is PathStatus.START_BLOCKED


@pytest.mark.parametrize("shift_m", [0.0, 0.05, 0.1, 0.15, 0.2])
@pytest.mark.parametrize("slope", [0.4, 0.6, 0.9])
def test_a_thin_ramp_leads_up_where_the_ground_below_it_begins_to_count(
    tmp_path: Path, slope: float, shift_m: float
) -> None:
    foot, top = 5.0 + shift_m, 2.4
    head = foot + top / slope
    sheets = [
        [(0, 0, 0), (20, 0, 0), (20, 6, 0), (0, 6, 0)],
        [(foot, 2, 0), (head, 2, top), (head, 4, top), (foot, 4, 0)],
        [(head, 2, top), (head + 4, 2, top), (head + 4, 4, top), (head, 4, top)],
    ]
    corners = [corner for sheet in sheets for corner in sheet]
    faces = [(4 * k + 1, 4 * k + b, 4 * k + c) for k in range(3) for b, c in ((2, 3), (3, 4))]
    mesh = tmp_path / "ramp.obj"
    mesh.write_text(
        "".join(f"v {x} {y} {z}\n" for x, y, z in corners)
        + "".join(f"f {a} {b} {c}\n" for a, b, c in faces)
    )
    grid = LayeredGrid.from_mesh(mesh, up="z")
    assert find_path(grid, (2.0, 3.0, 0.0), (head + 2.0, 3.0, top)).status is PathStatus.FOUND
