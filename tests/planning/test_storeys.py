"""The ground over several floors: walking, ways to goals, and doors."""

import math
from dataclasses import replace

import numpy as np
import pytest

from esplanade.planning import Body, Door, LayeredGrid, Polygon, Potential, Ramp, Scene, find_path
from esplanade.planning.grid.clearances import centres_of
from esplanade.planning.scene.bodies import MOST_BODIES
from tests.naive.geometry import point_segment_distance
from tests.planning.storeys import SLAB_FROM, STAIRS_FROM, box, grid_of, storeyed
from tests.planning.worlds import UPPER_M, scaled, slow_if_plain

ADULT, CHILD = Body.adult(), Body.child()
LOW_M = 1.5


@pytest.fixture(scope="module")
def house() -> LayeredGrid:
    return LayeredGrid.from_scene(storeyed())


def stroll(grid, start, step, steps, body=ADULT, clearance_m=0.25):
    """Places (steps + 1, 3) of a body that goes straight on."""
    position, height = np.array([start[:2]]), np.array([start[2]])
    places = [(*position[0], height[0])]
    for _ in range(steps):
        position, height = grid.walk(position, height, [step], clearance_m, body)
        places.append((*position[0], height[0]))
    return np.array(places)


@pytest.mark.parametrize("body", [ADULT, CHILD], ids=["adult", "child"])
def test_up_the_stairs_and_down_again(house, body) -> None:
    # Cells and treads do not fit: on its way the body comes to every place of a tread in a cell.
    up = stroll(house, (1.0, 6.2, 0.0), (0.15, 0.0), 70, body, body.radius_m)
    assert up[-1] == pytest.approx([11.5, 6.2, UPPER_M], abs=0.2)
    assert up[-1, 1:] == pytest.approx([6.2, UPPER_M], abs=1e-4)
    rises = np.diff(up[:, 2])
    assert rises.min() >= 0.0
    assert rises.max() <= body.step_on_m + 1e-4
    on_stairs = (up[:, 0] > STAIRS_FROM + 0.3) & (up[:, 0] < SLAB_FROM - 0.3)
    share = (up[on_stairs, 0] - STAIRS_FROM) / (SLAB_FROM - STAIRS_FROM)
    assert up[on_stairs, 2] == pytest.approx(share * UPPER_M, abs=0.35)
    down = stroll(house, tuple(up[-1]), (-0.15, 0.0), 70, body, body.radius_m)
    assert down[-1] == pytest.approx([1.0, 6.2, 0.0], abs=0.2)
    assert np.diff(down[:, 2]).max() <= 0.0


def test_in_one_long_stride_too(house) -> None:
    position, height = house.walk([(1.0, 6.0)], [0.0], [(10.0, 0.0)], 0.25)
    assert (*position[0], height[0]) == pytest.approx((11.0, 6.0, UPPER_M), abs=1e-3)


def test_below_the_upper_floor_one_stays_below(house) -> None:
    along = stroll(house, (9.0, 2.0, 0.0), (0.2, 0.1), 30)
    assert not along[:, 2].any()
    assert along[-1, 0] > 14.0


@pytest.mark.parametrize("way", [(-0.2, 0.0), (-0.2, 0.1), (-0.2, -0.1)])
def test_nobody_walks_off_the_edge(house, way) -> None:
    places = stroll(house, (9.0, 2.0, UPPER_M), way, 60)
    stays = places[places[:, 2] > UPPER_M - 1e-3]
    assert stays[:, 0].min() >= SLAB_FROM + 0.25 - 1e-6 or len(stays) < len(places)
    before_the_stairs = (stays[:, 1] < 4.7) | (stays[:, 1] > 7.3)
    assert stays[before_the_stairs, 0].min() >= SLAB_FROM + 0.25 - 1e-6
    assert np.abs(np.diff(places[:, 2])).max() <= ADULT.step_on_m


def test_beside_the_stairs_nobody_steps_off_where_they_are_high(house) -> None:
    high = stroll(house, (7.0, 6.0, 2.6), (0.0, 0.2), 20)
    assert high[:, 1].max() <= 7.0 - 0.25 + 1e-6
    assert high[:, 2].min() > 2.0
    low = stroll(house, (3.4, 6.0, 0.3), (0.0, 0.2), 20)
    assert low[-1, 1] > 8.0
    assert low[-1, 2] == 0.0


def ledges(body):
    """The edges that a body upstairs must not come close to."""
    return [
        ((SLAB_FROM, 0.0), (SLAB_FROM, 5.0)),
        ((SLAB_FROM, 7.0), (SLAB_FROM, 12.0)),
    ]


@pytest.mark.parametrize("body", [ADULT, CHILD], ids=["adult", "child"])
def test_random_walks_stay_on_floors_and_away_from_ledges(body) -> None:
    low = box(10.0, 1.0, 13.0, 4.0, 0.3, offset_m=LOW_M)
    grid = LayeredGrid.from_scene(storeyed(polygons=[low]))
    rng = np.random.default_rng(7)
    walkers = scaled(40, 2)
    positions = np.concatenate([
        rng.uniform((0.5, 0.5), (2.5, 11.5), (walkers // 2, 2)),
        rng.uniform((8.5, 4.5), (15.5, 11.5), (walkers - walkers // 2, 2)),
    ])  # fmt: skip
    heights = np.where(np.arange(walkers) < walkers // 2, 0.0, UPPER_M)
    headings = rng.uniform(-math.pi, math.pi, walkers)
    changed = np.zeros(walkers, dtype=np.bool_)
    been_low = 0
    for _ in range(scaled(2000, 40)):
        headings += rng.normal(0.0, 0.25, walkers)
        ways = 0.13 * np.stack([np.cos(headings), np.sin(headings)], axis=1)
        before, level = positions, heights
        positions, heights = grid.walk(before, level, ways, body.radius_m, body)
        stuck = np.hypot(*(positions - before).T) < 0.03
        headings[stuck] = rng.uniform(-math.pi, math.pi, stuck.sum())
        changed |= (level < 0.1) & (heights > 0.1) | (level > 3.0) & (heights < 3.0)
        assert np.isfinite(heights).all()
        assert np.abs(heights - level).max() <= body.step_on_m + 1e-4
        cells = grid.on_ground(positions, heights)[1]
        assert (cells >= 0).all()
        assert grid.layered.floors[cells] == pytest.approx(heights, abs=1e-5)
        i, j = np.minimum((positions / grid.cell_m).astype(int), (63, 47)).T
        assert (grid.layered.places["row"][cells] == j).all()
        assert (grid.layered.places["column"][cells] == i).all()
        assert (grid.layered.ceilings[cells] - heights >= body.height_m - 1e-4).all()
        for x, y in positions[heights > UPPER_M - 1e-3]:
            away = min(point_segment_distance((x, y), *ledge) for ledge in ledges(body))
            assert away >= body.radius_m - 1e-5
        over_x = np.clip(positions[:, 0], 10.0, 13.0)
        over_y = np.clip(positions[:, 1], 1.0, 4.0)
        away = np.hypot(positions[:, 0] - over_x, positions[:, 1] - over_y)
        been_low += ((away == 0.0) & (heights == 0.0)).sum()
        if body is ADULT:
            assert (away[heights < 1.0] >= body.radius_m - 1e-5).all()
    if scaled(1, 0):
        assert changed.sum() >= 3, "some went up or down the stairs"
        assert (been_low > 0) == (body is CHILD)


def test_a_body_passes_where_there_is_room_for_its_head() -> None:
    """A passage of 1.5 m between two floors that nobody tall gets through."""
    low = box(3.0, 0.0, 5.0, 8.0, 0.3, offset_m=LOW_M)
    grid = grid_of(8.0, [low])
    adult = stroll(grid, (1.0, 4.0, 0.0), (0.1, 0.0), 60)
    child = stroll(grid, (1.0, 4.0, 0.0), (0.1, 0.0), 60, CHILD, 0.2)
    assert adult[-1, 0] == pytest.approx(2.75, abs=1e-3)
    assert child[-1] == pytest.approx([7.0, 4.0, 0.0], abs=1e-3)


def test_a_step_is_taken_by_who_can_step_so_high() -> None:
    platform = box(3.0, 0.0, 8.0, 8.0, 0.45)
    grid = grid_of(8.0, [platform])
    adult = stroll(grid, (1.0, 4.0, 0.0), (0.1, 0.0), 40)
    child = stroll(grid, (1.0, 4.0, 0.0), (0.1, 0.0), 40, CHILD, 0.2)
    assert adult[-1] == pytest.approx([5.0, 4.0, 0.45], abs=1e-3)
    assert child[-1] == pytest.approx([2.87, 4.0, 0.0], abs=1e-3)


def test_up_a_ramp_the_height_rises_evenly() -> None:
    ring = ((2.0, 2.0), (10.0, 2.0), (10.0, 6.0), (2.0, 6.0))
    ramp = Polygon(points=ring, height_m=2.0, ramp=Ramp(start=(2.0, 4.0), end=(10.0, 4.0)))
    grid = LayeredGrid.from_scene(Scene(bounds=(0.0, 0.0, 12.0, 8.0), polygons=(ramp,)))
    places = stroll(grid, (1.0, 4.0, 0.0), (0.1, 0.0), 80)
    on = (places[:, 0] > 2.3) & (places[:, 0] < 9.7)
    assert places[on, 2] == pytest.approx((places[on, 0] - 2.0) / 4.0, abs=0.04)


# --- ways to goals -----------------------------------------------------------------------


def followed(potential, start, step_m=0.05, most_m=60.0):
    """Places (K, 3) of a body that goes down the potential, cell by cell."""
    grid = potential.grid
    x, y, z = start
    places = [start]
    while potential.distance([(x, y)], [z])[0] > 0.1:
        dx, dy = potential.direction([(x, y)], [z])[0]
        assert (dx, dy) != (0.0, 0.0)
        x, y = x + step_m * dx, y + step_m * dy
        z = grid.floor_at((x, y), z)
        places.append((x, y, z))
        assert len(places) < most_m / step_m, "it does not arrive"
    return np.array(places)


BELOW, ABOVE = (12.0, 6.0, 0.0), (12.0, 6.0, UPPER_M)


@slow_if_plain
@pytest.mark.parametrize(("start", "goal"), [(BELOW, ABOVE), (ABOVE, BELOW)])
@pytest.mark.parametrize("body", [ADULT, CHILD], ids=["adult", "child"])
def test_straight_above_is_as_far_as_over_the_stairs(house, start, goal, body) -> None:
    potential = Potential(house, goal[:2], goal[2], body.radius_m, body=body)
    found = potential.distance([start[:2]], [start[2]])[0]
    assert potential.distance([goal[:2]], [goal[2]])[0] == pytest.approx(0.0, abs=1e-6)
    # Around the flight's side to its foot, and up: the foot lies 9 m west of both.
    beside = math.hypot(STAIRS_FROM - 12.0, 1.0 + body.radius_m)
    least = (12.0 - STAIRS_FROM) + beside - 1.0
    assert least <= found <= least + 3.5
    places = followed(potential, start)
    assert places[-1] == pytest.approx(goal, abs=0.11)
    assert np.abs(np.diff(places[:, 2])).max() <= body.step_on_m + 1e-4
    assert 0.05 * len(places) <= found + 0.5
    halfway = places[np.abs(places[:, 2] - UPPER_M / 2.0) < 0.3]
    assert len(halfway) > 0
    assert (np.abs(halfway[:, 1] - 6.0) <= 1.0).all()
    assert house.is_free(places[:, :2], places[:, 2], body.radius_m - 0.18, body).all()


def test_without_stairs_there_is_no_way_up() -> None:
    grid = LayeredGrid.from_scene(storeyed().model_copy(update={"stairs": ()}))
    potential = Potential(grid, ABOVE[:2], ABOVE[2], 0.25)
    assert potential.distance([BELOW[:2]], [BELOW[2]])[0] == math.inf
    assert potential.direction([BELOW[:2]], [BELOW[2]])[0].tolist() == [0.0, 0.0]
    assert potential.distance([(9.0, 3.0)], [UPPER_M])[0] == pytest.approx(math.hypot(3.0, 3.0))


@slow_if_plain
def test_steps_too_high_for_a_child_are_no_way_for_it() -> None:
    scene = storeyed()
    steep = scene.stairs[0].model_copy(update={"steps": 9})
    grid = LayeredGrid.from_scene(scene.model_copy(update={"stairs": (steep,)}))
    for body, reached in ((ADULT, True), (CHILD, False)):
        potential = Potential(grid, ABOVE[:2], ABOVE[2], body.radius_m, body=body)
        assert math.isfinite(potential.distance([BELOW[:2]], [BELOW[2]])[0]) == reached


def test_the_way_of_a_child_leads_where_an_adult_has_to_go_around() -> None:
    low = box(4.0, 2.0, 5.0, 12.0, 0.3, offset_m=LOW_M)
    grid = grid_of(12.0, [low])
    start, goal = (2.0, 8.0), (8.0, 8.0)
    ways = {
        body: Potential(grid, goal, 0.0, body.radius_m, body=body).distance([start], [0.0])[0]
        for body in (ADULT, CHILD)
    }
    assert ways[CHILD] == pytest.approx(6.0, abs=0.05)
    assert ways[ADULT] > 2.0 * math.hypot(2.0, 6.0)


@slow_if_plain
def test_a_goal_above_and_one_below_are_two_potentials(house) -> None:
    above = Potential(house, (12.0, 6.0), UPPER_M, 0.25)
    below = Potential(house, (12.0, 6.0), 0.0, 0.25)
    assert not np.array_equal(above.values, below.values)
    again = Potential(house, (12.0, 6.0), UPPER_M + 0.1, 0.25)
    assert np.array_equal(again.values, above.values)
    pool = grid_of(8.0, [box(2.0, 2.0, 6.0, 6.0, 2.0).model_copy(update={"kind": "water"})])
    with pytest.raises(ValueError, match="nobody can stand at the goal"):
        Potential(pool, (4.0, 4.0), 0.0, 0.25)


# --- doors -------------------------------------------------------------------------------


def doored(is_open=True, floor_m=0.0):
    """A wall across one floor with a door in it, and a longer way around."""
    parts = {"offset_m": floor_m, "height_m": 2.4}
    door = Door(name="gate", start=(12.0, 5.0), end=(12.0, 6.5), open=is_open, **parts)
    other = Door(name="back", start=(12.0, 11.0), end=(12.0, 12.0), **parts)
    scene = storeyed(doors=[door, other])
    wall = Polygon(
        points=((11.9, 0.0), (12.1, 0.0), (12.1, 5.0), (11.9, 5.0)),
        kind="wall",
        **parts,
    )
    rest = wall.model_copy(
        update={"points": ((11.9, 6.5), (12.1, 6.5), (12.1, 11.0), (11.9, 11.0))}
    )
    return scene.model_copy(update={"polygons": (*scene.polygons, wall, rest)})


@pytest.mark.parametrize("floor_m", [0.0, UPPER_M], ids=["ground", "upper"])
def test_a_closed_door_stops_who_is_on_its_floor(floor_m) -> None:
    grid = LayeredGrid.from_scene(doored(floor_m=floor_m))
    start, other = (11.0, 5.75, floor_m), (11.0, 5.75, UPPER_M - floor_m)
    assert stroll(grid, start, (0.1, 0.0), 30)[-1, 0] == pytest.approx(14.0, abs=1e-6)
    grid.set_door("gate", False)
    assert stroll(grid, start, (0.1, 0.0), 30)[-1, 0] == pytest.approx(11.75, abs=1e-3)
    assert stroll(grid, other, (0.1, 0.0), 30)[-1, 0] == pytest.approx(14.0, abs=1e-6)
    grid.set_door("gate", True)
    assert stroll(grid, start, (0.1, 0.0), 30)[-1, 0] == pytest.approx(14.0, abs=1e-6)
    with pytest.raises(KeyError, match="trapdoor"):
        grid.set_door("trapdoor", True)


@slow_if_plain
@pytest.mark.parametrize("floor_m", [0.0, UPPER_M], ids=["ground", "upper"])
def test_what_a_door_will_change_can_be_derived_while_nothing_changes(floor_m) -> None:
    grid = LayeredGrid.from_scene(doored(floor_m=floor_m))
    for body in (ADULT, CHILD):
        grid.row_of(body)
    arrays, barriers = grid.arrays, grid.barriers.copy()
    feet = grid.traversability.of(ADULT)
    change = grid.prepare_door("gate", False)
    assert grid.arrays is arrays
    assert np.array_equal(grid.barriers, barriers)
    assert grid.traversability.of(ADULT) is feet
    grid.apply_door(change)
    assert grid.arrays is change.arrays
    assert not grid.doors.is_open("gate")
    other = LayeredGrid.from_scene(doored(False, floor_m))
    for body in (ADULT, CHILD):
        row, anew = grid.row_of(body), other.row_of(body)
        assert np.array_equal(grid.arrays.clearance[row], other.arrays.clearance[anew])
        assert np.array_equal(grid.arrays.edges[row], other.arrays.edges[anew])
        found, expected = grid.traversability.of(body), other.traversability.of(body)
        assert found.near.barriers is grid.barriers
        assert np.array_equal(found.steps, expected.steps)
        assert np.array_equal(found.classes, expected.classes)
    with pytest.raises(KeyError, match="trapdoor"):
        grid.prepare_door("trapdoor", True)


def test_a_change_that_was_prepared_for_another_grid_is_derived_anew() -> None:
    grid, other = (LayeredGrid.from_scene(doored()) for _ in range(2))
    grid.apply_door(other.prepare_door("gate", False))
    late = grid.prepare_door("back", False)
    grid.set_door("gate", True)
    grid.apply_door(late)
    other.set_door("back", False)
    assert (grid.doors.is_open("gate"), grid.doors.is_open("back")) == (True, False)
    assert np.array_equal(grid.arrays.clearance, other.arrays.clearance)


@slow_if_plain
@pytest.mark.parametrize("floor_m", [0.0, UPPER_M], ids=["ground", "upper"])
def test_what_a_door_changes_is_what_is_derived_anew(floor_m) -> None:
    grid = LayeredGrid.from_scene(doored(floor_m=floor_m))
    bodies = (ADULT, CHILD)
    rows = [grid.row_of(body) for body in bodies]
    before = grid.arrays.clearance.copy()
    for is_open in (False, True, False):
        grid.set_door("gate", is_open)
        other = LayeredGrid.from_scene(doored(is_open, floor_m))
        for body, row in zip(bodies, rows, strict=True):
            anew = other.row_of(body)
            assert np.array_equal(grid.arrays.clearance[row], other.arrays.clearance[anew])
            assert np.array_equal(grid.arrays.edges[row], other.arrays.edges[anew])
        changed = (grid.arrays.clearance != before).any(axis=0)
        assert changed.any() != is_open
        centres = centres_of(grid.layered, grid.layered.places)
        away = np.hypot(centres[:, 0] - 12.0, centres[:, 1] - np.clip(centres[:, 1], 5.0, 6.5))
        assert not changed[away > 3.0].any()
        near_in_height = np.abs(np.nan_to_num(grid.layered.floors) - floor_m) < 2.4
        assert not changed[~near_in_height].any()
    grid.set_door("gate", True)
    assert np.array_equal(grid.arrays.clearance, before)


def test_on_bare_ground_too() -> None:
    def scene(is_open):
        door = Door(name="gate", start=(3.7, 0.4), end=(2.2, 3.1), open=is_open)
        pool = box(1.0, 1.0, 2.0, 2.0, 1.0).model_copy(update={"kind": "water"})
        return Scene(bounds=(0.0, 0.0, 6.0, 5.0), polygons=(pool,), doors=(door,))

    grid = LayeredGrid.from_scene(scene(True))
    assert grid.arrays.flat
    grid.set_door("gate", False)
    anew = LayeredGrid.from_scene(scene(False)).arrays.clearance
    assert np.array_equal(grid.arrays.clearance, anew)
    assert (anew < 0.0).any()


@slow_if_plain
def test_a_way_through_a_closed_door_leads_around_it() -> None:
    grid = LayeredGrid.from_scene(doored())
    start, goal = (10.0, 5.75), (14.0, 5.75)
    through = Potential(grid, goal, 0.0, 0.25)
    assert through.distance([start], [0.0])[0] == pytest.approx(4.0, abs=0.01)
    grid.set_door("gate", False)
    around = Potential(grid, goal, 0.0, 0.25)
    expected = 2.0 * math.hypot(2.0, 11.25 - 5.75)
    assert expected <= around.distance([start], [0.0])[0] <= expected + 1.0
    places = followed(around, (*start, 0.0))
    assert places[np.abs(places[:, 0] - 12.0) < 0.1, 1].min() > 11.0
    grid.set_door("back", False)
    assert Potential(grid, goal, 0.0, 0.25).distance([start], [0.0])[0] == math.inf
    grid.set_door("gate", True)
    again = Potential(grid, goal, 0.0, 0.25)
    assert again.distance([start], [0.0])[0] == pytest.approx(4.0, abs=0.01)


def test_bodies_that_hardly_differ_share_what_is_known_of_the_ground() -> None:
    grid = LayeredGrid.from_scene(storeyed())
    rows = {grid.row_of(replace(ADULT, radius_m=0.241 + 0.0002 * k)) for k in range(40)}
    assert rows == {grid.row_of(ADULT)}
    assert grid.row_of(replace(ADULT, edge_cells=9)) == grid.row_of(ADULT)
    assert grid.row_of(replace(ADULT, step_on_m=0.3)) != grid.row_of(ADULT)
    assert grid.row_of(replace(ADULT, radius_m=0.4)) != grid.row_of(ADULT)
    assert grid.row_of(replace(ADULT, height_m=1.76)) == grid.row_of(ADULT)
    assert grid.row_of(replace(ADULT, height_m=1.75)) != grid.row_of(ADULT)


def test_a_path_is_found_for_a_body_that_no_more_kinds_have_room_for() -> None:
    grid = grid_of(4.0)
    kinds = [
        replace(ADULT, radius_m=0.2 + 0.05 * (k % 4), height_m=1.2 + 0.05 * (k // 4))
        for k in range(MOST_BODIES)
    ]
    rows = [grid.claim(body) for body in kinds if body != ADULT]
    assert len(set(rows)) == len(rows) == MOST_BODIES - 1
    with pytest.raises(ValueError, match=rf"bodies of {MOST_BODIES} kinds walk in the zone"):
        grid.row_of(replace(ADULT, step_on_m=0.55))
    assert find_path(grid, (1.0, 1.0, 0.0), (3.0, 3.0, 0.0), Body(step_on_m=0.55)).length_m > 2.8


def test_nobody_is_free_where_the_ceiling_is_too_low() -> None:
    low = box(6.0, 0.0, 12.0, 8.0, 1.0, offset_m=LOW_M)
    grid = grid_of(12.0, polygons=[low])
    points, heights = [(3.0, 4.0), (7.0, 4.0), (10.0, 4.0)], [0.0] * 3
    assert grid.is_free(points, heights, 0.25, ADULT).tolist() == [True, False, False]
    assert grid.is_free(points, heights, 0.2, CHILD).all()
    assert grid.nearest_free((10.0, 4.0), 0.0, 0.2, CHILD) == (10.0, 4.0)
    free = grid.nearest_free((10.0, 4.0), 0.0, 0.25, ADULT)
    assert free is not None
    assert free[0] < 6.0
