"""M in the living world: actors stay on edges no longer than their bodies may."""

import math
from dataclasses import replace

import pytest
from benchmarks import _four_answers as four
from benchmarks._turned_scenes import Case, Turn, low_flight, plank
from hypothesis import given
from hypothesis import strategies as st

from esplanade.actors import ActorParameters, Navigator, Reason
from esplanade.planning import Body, LayeredGrid, PathStatus, PlanModel, Polygon, Scene, find_path
from tests.planning.routes.test_edge_rule import flight, kerb
from tests.planning.worlds import holds

Place = tuple[float, float, float]


def walk(
    grid: LayeredGrid, start: Place, goal: Place, most: int, seconds: float
) -> tuple[Reason, float, list[float], set[Reason]]:
    """The last reason, the most cells on edges in a row, heights on the way, and all reasons."""
    navigator = Navigator(grid, tick_s=0.1, plan=PlanModel(threads=1))
    navigator.add_actor(
        "a",
        start[:2],
        goal[:2],
        ActorParameters(edge_cells=most),
        z_m=start[2],
        goal_z_m=goal[2],
    )
    counted, heights, reasons = 0.0, [], set()
    reason = Reason.NONE
    for tick in range(int(10 * seconds)):
        navigator.observe({})
        state = navigator.tick()["a"]
        reason = state.reason
        reasons.add(reason)
        heights.append(state.z_m)
        counted = max(counted, float(navigator.table.agents.on_edges[0]))
        if reason is Reason.ARRIVED or (reason is Reason.NO_PATH and tick > 10):
            break
    navigator.close()
    return reason, counted, heights, reasons


@pytest.mark.parametrize("degrees", [0, 30])
@pytest.mark.parametrize("most", [60, 42, 30, 20])
def test_an_actor_climbs_a_flight_just_where_find_path_does(degrees: int, most: int) -> None:
    scene, below, above = flight(36, angle=math.radians(degrees))
    grid = LayeredGrid.from_scene(scene)
    start, goal = (*below, 0.0), (*above, 3.6)
    path = find_path(grid, start, goal, Body(edge_cells=most))
    reason, counted, _, _ = walk(grid, start, goal, most, 40.0)
    if path.status is PathStatus.FOUND:
        assert reason is Reason.ARRIVED
        assert counted < most + 2
    else:
        assert reason is Reason.NO_PATH


def least_m(case: Case, grid: LayeredGrid) -> int:
    """The smallest M with which the tool finds the way there and back."""
    return next(m for m in range(2, 100) if four.tool(grid, replace(case, body=Body(edge_cells=m))))


@pytest.mark.parametrize(("steps", "degrees"), [(12, 18.0), (24, 0.0), (24, 45.0), (24, 72.0)])
def test_an_actor_needs_no_larger_m_than_find_path(steps: int, degrees: float) -> None:
    case = low_flight(Turn(degrees, (0.06, 0.11)), steps, Body.adult())
    grid = LayeredGrid.from_scene(case.scene)
    least = least_m(case, grid)
    for m in (least, least + 1, least + 3):
        for each in (case, case.back):
            reason, counted, _, _ = walk(grid, each.start, each.goal, m, 40.0)
            assert reason is Reason.ARRIVED
            assert counted < m + 2
    assert not four.actor(grid, replace(case, body=Body(edge_cells=least - 1)))


turns = st.builds(Turn, st.floats(0.0, 360.0), st.tuples(*[st.floats(0.0, 0.25)] * 2))
flights = st.builds(low_flight, turns, st.integers(6, 14), st.just(Body.adult()))
planks = st.builds(
    plank,
    turns,
    st.floats(1.0, 4.0),
    st.floats(0.55, 1.0),
    st.just(Body.adult()),
    st.booleans(),
)


@given(st.one_of(flights, planks), st.integers(-2, 4))
@holds(12, 1)
def test_an_actor_arrives_just_where_find_path_finds_a_way(case: Case, more: int) -> None:
    grid = LayeredGrid.from_scene(case.scene)
    asked = replace(case, body=Body(edge_cells=max(2, least_m(case, grid) + more)))
    assert four.actor(grid, asked) == four.tool(grid, asked) == four.check(grid, asked)


def test_an_actor_goes_around_a_kerb_that_its_body_cannot_walk_along() -> None:
    scene, start, goal = kerb(10.0, 0.5, 2.0)
    grid = LayeredGrid.from_scene(scene)
    for most in (200, 4):
        reason, counted, heights, reasons = walk(grid, (*start, 0.0), (*goal, 0.0), most, 40.0)
        assert reason is Reason.ARRIVED
        assert Reason.GIVING_WAY not in reasons
        assert (counted >= 30) == (most == 200)
        assert (max(heights) > 0.2) == (most == 200)


def test_without_a_way_around_the_kerb_there_is_no_path() -> None:
    scene, start, goal = kerb(10.0, 0.5, 0.0)
    grid = LayeredGrid.from_scene(scene)
    reason, counted, _, _ = walk(grid, (*start, 0.0), (*goal, 0.0), 4, 40.0)
    assert reason is Reason.NO_PATH
    assert counted == 0


def test_the_count_is_saved_with_the_actors() -> None:
    scene, below, above = flight(36)
    grid = LayeredGrid.from_scene(scene)
    navigator = Navigator(grid, tick_s=0.1, plan=PlanModel(threads=1))
    navigator.add_actor("a", below, above, ActorParameters(edge_cells=50), goal_z_m=3.6)
    for _ in range(40):
        navigator.observe({})
        navigator.tick()
    counted = float(navigator.table.agents.on_edges[0])
    assert counted > 5
    header, arrays = navigator.table.save()
    other = Navigator(grid, tick_s=0.1, plan=PlanModel(threads=1))
    other.load(header, arrays)
    assert float(other.table.agents.on_edges[0]) == counted
    other.place_actor("a", below, z_m=0.0)
    assert float(other.table.agents.on_edges[0]) == 0.0
    navigator.close()
    other.close()


def test_an_actor_inside_a_solid_comes_out_or_says_that_no_path_leads_out() -> None:
    solid = Polygon(points=((8, 8), (14, 8), (14, 14), (8, 14)), height_m=3, kind="wall")
    scene = Scene(bounds=(0, 0, 20, 20), polygons=(solid,))
    for inside in ((11.0, 11.0), (8.2, 11.0), (13.9, 13.9)):
        reason, _, _, _ = walk(
            LayeredGrid.from_scene(scene), (*inside, 0.0), (3.0, 3.0, 0.0), 64, 40.0
        )
        assert reason in (Reason.NO_PATH, Reason.ARRIVED)
