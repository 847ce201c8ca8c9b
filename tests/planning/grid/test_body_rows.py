"""Kinds of body: their rows are shared, given back, and derived on a fork beside the grid."""

import numpy as np
import pytest

from esplanade.planning import Body, Door, LayeredGrid, Scene
from esplanade.planning.grid.clearances import kind_of
from esplanade.planning.scene.bodies import MOST_BODIES

SCENE = Scene(
    bounds=(0.0, 0.0, 6.0, 6.0), doors=(Door(name="d", start=(3.0, 0.0), end=(3.0, 3.0)),)
)


@pytest.fixture
def grid() -> LayeredGrid:
    return LayeredGrid.from_scene(SCENE)


def nth(k: int) -> Body:
    return Body(radius_m=0.1, height_m=0.4 + 0.05 * k)


def test_every_measure_is_rounded_to_where_less_fits() -> None:
    kind = kind_of(Body(0.217, 1.73, 0.58, 0.93, edge_cells=7))
    assert kind == Body(0.22, 1.75, 0.55, 0.9)
    assert kind_of(kind) == kind
    assert kind_of(Body.adult()) == Body.adult()


def test_a_row_without_users_is_another_kinds_when_all_are_taken(grid: LayeredGrid) -> None:
    for k in range(MOST_BODIES - 1):
        grid.claim(nth(k))
    with pytest.raises(ValueError, match="64 kinds walk in the zone"):
        grid.claim(Body(radius_m=0.9))
    grid.release(nth(5))
    row = grid.row_of(nth(5))
    low = Body(radius_m=0.9, height_m=0.3)
    assert grid.claim(low) == row
    assert not grid.knows(nth(5))
    assert grid.row_of(low) == row
    fresh = LayeredGrid.from_scene(SCENE)
    other = fresh.row_of(low)
    assert np.array_equal(grid.arrays.clearance[row], fresh.arrays.clearance[other])


def test_what_a_fork_gets_to_know_is_taken_over_at_once(grid: LayeredGrid) -> None:
    fork, arrays = grid.fork(), grid.arrays
    row = fork.row_of(Body.child())
    assert grid.arrays is arrays
    assert not grid.knows(Body.child())
    assert grid.apply_bodies(grid.bodies_change(fork))
    assert grid.row_of(Body.child()) == row
    assert grid.arrays is fork.arrays


def test_what_was_derived_before_a_door_moved_is_derived_again(grid: LayeredGrid) -> None:
    fork = grid.fork()
    fork.row_of(Body.child())
    change = grid.bodies_change(fork)
    grid.set_door("d", is_open=False)
    assert not grid.apply_bodies(change)
    row = grid.row_of(Body.child())
    other = LayeredGrid.from_scene(SCENE)
    other.set_door("d", is_open=False)
    anew = other.row_of(Body.child())
    assert np.array_equal(grid.arrays.clearance[row], other.arrays.clearance[anew])


def test_a_fork_never_takes_the_row_of_a_body_that_has_come_meanwhile(grid: LayeredGrid) -> None:
    for k in range(MOST_BODIES - 1):
        grid.row_of(nth(k))
    fork = grid.fork()
    fork.row_of(Body(radius_m=0.9))
    change = grid.bodies_change(fork)
    grid.claim(nth(0))
    assert not grid.apply_bodies(change)
    assert grid.knows(nth(0))
