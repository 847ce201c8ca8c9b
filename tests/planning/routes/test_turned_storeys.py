"""Ramps, kerbs and the edge rule at any angle and offset: tools and people give one answer."""

import math

from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning import Body, LayeredGrid, PathStatus, Potential, find_path
from tests.planning.routes.test_edge_rule import flight as low_flight
from tests.planning.turned import arrives, has_route, kerb, radii, ramp, turns
from tests.planning.worlds import holds

Point3 = tuple[float, float, float]


def leads(grid: LayeredGrid, start: Point3, goal: Point3, body: Body) -> bool:
    return find_path(grid, start, goal, body).status is PathStatus.FOUND


@given(turns, radii, st.sampled_from([-0.06, 0.1, 0.2, 0.5]))
@holds(150, 1)
def test_a_ramp_leads_up_and_down_wherever_it_is_wide_enough(turned, radius_m, wider) -> None:
    grid = LayeredGrid.from_scene(ramp(turned, 2.0 * radius_m + wider))
    foot, top = (*turned.at(-3.0, 0.0), 0.0), (*turned.at(2.2, 0.0), 1.2)
    for a, b in ((foot, top), (top, foot)):
        assert leads(grid, a, b, Body(radius_m=radius_m)) == (wider > 0.0)
        assert has_route(grid, a, b, radius_m) == (wider > 0.0)


heights = st.sampled_from([0.1, 0.28, 0.45, 0.58, 0.64, 0.75, 0.88, 0.95, 1.5])
depths = st.sampled_from([0.15, 0.3, 0.8, 1.6])


@given(turns, radii, heights, depths)
@holds(150, 1)
def test_a_kerb_is_crossed_if_it_is_no_higher_than_a_step(turned, radius_m, height, depth) -> None:
    grid = LayeredGrid.from_scene(kerb(turned, height, depth))
    start, goal = (*turned.at(-3.0, 0.4), 0.0), (*turned.at(3.0, -0.4), 0.0)
    for body in (Body(radius_m=radius_m), Body(radius_m=radius_m, step_on_m=0.3, leg_length_m=0.6)):
        assert leads(grid, start, goal, body) == (height <= body.step_on_m)
    assert has_route(grid, start, goal, radius_m) == (height <= Body.adult().step_on_m)


@given(turns, radii, heights, depths)
@holds(15, 1)
def test_a_live_actor_crosses_the_kerbs_that_others_cross(turned, radius_m, height, depth) -> None:
    scene = kerb(turned, height, depth)
    start, goal = (*turned.at(-3.0, 0.4), 0.0), (*turned.at(3.0, -0.4), 0.0)
    assert arrives(scene, start, goal, radius_m) == (height <= Body.adult().step_on_m)


@given(
    st.integers(0, 359),
    st.sampled_from([8, 14, 20]),
    st.sampled_from([1.0, 1.4]),
    st.booleans(),
)
@holds(60, 1)
def test_the_potential_is_bounded_by_the_same_m_as_the_tool(degrees, steps, width, up) -> None:
    scene, below, above = low_flight(steps, width, math.radians(degrees))
    grid, top = LayeredGrid.from_scene(scene), 0.1 * steps
    start, goal = ((*below, 0.0), (*above, top)) if up else ((*above, top), (*below, 0.0))
    low, high = 1, 6 * steps
    while high - low > 1:
        middle = (low + high) // 2
        found = leads(grid, start, goal, Body(edge_cells=middle))
        low, high = (low, middle) if found else (middle, high)
    for most in (low, high):
        body = Body(edge_cells=most)
        potential = Potential(grid, goal[:2], goal[2], body.radius_m, body=body)
        left_m = potential.distance([start[:2]], [start[2]])[0]
        assert math.isfinite(left_m) == (most == high)
