"""Traversability is kept for each body, and derived anew around doors."""

import numpy as np
import pytest

from esplanade.planning import Body, Door, find_path
from esplanade.planning.routes.find_path import PathStatus
from esplanade.planning.traversal.cache import find_traversability
from tests.planning.storeys import box, grid_of

WALLS = [box(4.0, 0.0, 4.25, 3.5, 3.0), box(4.0, 4.5, 4.25, 8.0, 3.0)]
DOOR = Door(name="gate", start=(4.125, 3.5), end=(4.125, 4.5))


def same(a, b) -> bool:
    return np.array_equal(a.steps, b.steps) and np.array_equal(a.classes, b.classes)


def test_a_traversability_is_kept_for_each_body() -> None:
    grid = grid_of(4.0)
    adult = grid.traversability.of(Body.adult())
    assert grid.traversability.of(Body()) is adult
    assert grid.traversability.of(Body.child()) is not adult


def test_a_door_that_closes_and_opens_changes_only_what_is_near() -> None:
    grid = grid_of(8.0, WALLS, doors=[DOOR])
    body = Body.adult()
    open_before = grid.traversability.of(body)
    grid.doors.set_open("gate", False)
    closed = grid.traversability.of(body)
    assert same(closed, find_traversability(grid.layered, grid.barriers, body))
    changed = grid.layered.places[closed.steps != open_before.steps]
    assert len(changed)
    assert (np.abs(changed["row"] - 16) <= 4).all()
    assert (np.abs(changed["column"] - 16) <= 4).all()
    grid.doors.set_open("gate", True)
    assert same(grid.traversability.of(body), open_before)


@pytest.mark.parametrize("is_open", [True, False])
def test_a_way_leads_through_an_open_door_only(is_open) -> None:
    grid = grid_of(8.0, WALLS, doors=[DOOR])
    start, goal = (2.0, 4.0, 0.0), (6.0, 4.0, 0.0)
    assert find_path(grid, start, goal).status is PathStatus.FOUND
    grid.doors.set_open("gate", is_open)
    status = PathStatus.FOUND if is_open else PathStatus.NO_WAY
    assert find_path(grid, start, goal).status is status
