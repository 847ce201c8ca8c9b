"""Ways over anchors, judged by shapely: they lead to the goal, and pass everything by a radius."""

import numpy as np
from benchmarks._turned_plans import Plan
from benchmarks._turned_scenes import Case, Turn
from hypothesis import assume, given
from hypothesis import strategies as st
from shapely import LineString, MultiLineString, Polygon, union_all

from esplanade.planning import Body, LayeredGrid, Scene
from esplanade.planning.grid.clearances import kind_of
from esplanade.planning.routes._anchor_way_kernels import anchors_ahead, leads_exactly
from esplanade.planning.routes.wave_front import NO_TARGETS, Wave, WaveFront
from esplanade.planning.traversal._anchor_kernels import SLACK_M
from tests.planning.routes.test_random_plans import plans, turns
from tests.planning.worlds import holds

ROUNDING_M = 1e-4
"""Heights and waypoints are rounded to float32."""
NEAR_M = 1e-3


def obstacles_of(case: Case) -> object:
    """All that stands in a plan."""
    lines = [(wall.start, wall.end) for wall in case.scene.walls]
    rings = [Polygon(polygon.points) for polygon in case.scene.polygons]
    return union_all([MultiLineString(lines), *rings])


@given(plans, turns)
@holds(60, 2)
def test_the_way_over_anchors_leads_to_the_goal_and_touches_nothing(plan: Plan, turn: Turn) -> None:
    assume(plan.has_way and plan.room_m >= 0.03)
    case = plan.turned(turn)
    grid = LayeredGrid.from_scene(case.scene)
    goal, goal_cell = case.goal[:2], grid.cell_at(case.goal[:2], 0.0)
    wave = WaveFront(grid, goal, goal_cell, plan.radius_m, Wave.SIGHT, case.body)
    wave.grow(NO_TARGETS)
    points, cells = np.empty((4096, 2)), np.empty(4096, dtype=np.int64)
    start_cell = grid.cell_at(case.start[:2], 0.0)
    row = grid.row_of(case.body)
    count, complete = anchors_ahead(grid.arrays, wave.values, row, start_cell, points, cells)
    assert complete
    assert np.hypot(*(points[count - 1] - goal)) < ROUNDING_M
    room = LineString(points[:count]).distance(obstacles_of(case))
    assert room >= plan.radius_m - SLACK_M - ROUNDING_M
    assert [grid.cell_at(tuple(point), 0.0) for point in points[:count].tolist()] == cells[
        :count
    ].tolist()


@given(plans, turns, st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(0.0, 6.3))
@holds(60, 2)
def test_a_line_leads_exactly_where_it_passes_everything_by_a_radius(
    plan: Plan, turn: Turn, along: float, across: float, course: float
) -> None:
    case = plan.turned(turn)
    obstacles = obstacles_of(case)
    start = turn.at(along, across)
    end = (start[0] + 1.5 * np.cos(course), start[1] + 1.5 * np.sin(course))
    inside = any(
        Polygon(one.points).covers(LineString([start, end])) for one in case.scene.polygons
    )
    assume(not inside)
    room = LineString([start, end]).distance(obstacles)
    grid = LayeredGrid.from_scene(case.scene)
    row, cell = grid.row_of(case.body), grid.cell_at(start, 0.0)
    for less_m in (0.0, 0.015):
        need = kind_of(case.body).radius_m - SLACK_M - less_m
        if abs(room - need) > NEAR_M:
            found = leads_exactly(grid.arrays, row, cell, *start, *end, less_m)
            assert found is bool(room > need)


def test_where_no_way_leads_there_are_no_points() -> None:
    grid = LayeredGrid.from_scene(Scene(bounds=(0, 0, 4, 4)))
    values = np.full((len(grid.layered.floors), 4), np.inf, dtype=np.float32)
    points, cells = np.empty((8, 2)), np.empty(8, dtype=np.int64)
    cell, row = grid.cell_at((2.0, 2.0), 0.0), grid.row_of(Body.adult())
    assert anchors_ahead(grid.arrays, values, row, cell, points, cells) == (0, False)
