"""The pool of potentials that actors are led by."""

import errno
import mmap
import sys

import numpy as np
import pytest

from esplanade.actors.potential_pool import PotentialPool
from esplanade.planning import Body, Door, LayeredGrid, Scene
from esplanade.planning.routes.potential import Potential
from tests.planning.storeys import storeyed
from tests.planning.worlds import UPPER_M

BODY = Body.adult()
GRID = LayeredGrid.from_scene(Scene.open_space((0.0, 0.0, 4.0, 4.0)))


def pool() -> PotentialPool:
    return PotentialPool(GRID)


def test_actors_with_the_same_goal_share_a_row() -> None:
    guides = pool()
    one = guides.take((1.0, 1.0, 0.0, BODY))
    assert guides.take((1.0, 1.0, 0.0, BODY)) == one
    assert guides.take((1.0, 1.0, 0.0, Body(radius_m=0.3))) != one
    assert guides.take((2.0, 1.0, 0.0, BODY)) != one


def test_floors_and_bodies_have_rows_of_their_own() -> None:
    grid = LayeredGrid.from_scene(storeyed())
    guides = PotentialPool(grid)
    below = guides.take((12.0, 6.0, 0.0, BODY))
    above = guides.take((12.0, 6.0, UPPER_M, BODY))
    child = guides.take((12.0, 6.0, 0.0, Body.child()))
    assert len({below, above, child}) == 3
    cells = grid.on_ground([(12.0, 6.0)] * 2, [0.0, UPPER_M])[1]
    # The length left from each cell's first waypoint; from the other floor it is over the stairs.
    left = guides.arrays[[below, above]][:, cells, 0]
    assert np.diag(left).max() < 0.5
    assert min(left[0, 1], left[1, 0]) > 5.0


def test_a_goal_comes_back_to_the_row_it_had() -> None:
    guides = pool()
    slot = guides.take((1.0, 1.0, 0.0, BODY))
    before = guides.arrays[slot].copy()
    guides.release(slot)
    assert guides.take((1.0, 1.0, 0.0, BODY)) == slot
    assert np.array_equal(guides.arrays[slot], before)


def test_rows_in_use_stay_while_idle_ones_are_used_again() -> None:
    guides = pool()
    kept = guides.take((3.0, 3.0, 0.0, BODY))
    before = guides.arrays[kept].copy()
    for k in range(200):
        guides.release(guides.take((0.5 + 0.01 * k, 1.0, 0.0, BODY)))
    assert len(guides.users) <= 64
    assert np.array_equal(guides.arrays[kept], before)
    fresh = guides.take((0.5, 1.0, 0.0, BODY))
    assert fresh != kept
    cell = GRID.on_ground([(0.6, 1.1)], [0.0])[1][0]
    assert guides.arrays[fresh, cell, 0] < 0.5


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere rows are copied")
def test_no_row_is_copied_when_goals_come() -> None:
    guides = pool()
    guides.take((1.0, 1.0, 0.0, BODY))
    before = guides.arrays
    for k in range(300):
        guides.take((0.5 + 0.01 * k, 1.0, 0.0, BODY))
    assert guides.arrays is before
    assert len(guides.users) == 300


def test_rows_are_copied_where_there_is_no_address_space(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object, **__: object) -> None:
        raise OSError(errno.ENOMEM, "Cannot allocate memory")

    monkeypatch.setattr(mmap, "mmap", refused)
    guides = pool()
    kept = guides.take((3.0, 3.0, 0.0, BODY))
    before = guides.arrays[kept].copy()
    rows = [guides.take((0.5 + 0.01 * k, 1.0, 0.0, BODY)) for k in range(40)]
    assert len(set(rows)) == 40
    assert np.array_equal(guides.arrays[kept], before)
    assert len(guides.arrays) < 100


def test_nobodys_row_may_be_given_back() -> None:
    guides = pool()
    guides.release(-1)
    assert guides.take((1.0, 1.0, 0.0, BODY)) == 0


def test_rows_are_used_as_they_are_until_somebody_renews_them() -> None:
    grid = LayeredGrid.from_scene(
        Scene(
            bounds=(0.0, 0.0, 6.0, 6.0), doors=(Door(name="d", start=(3.0, 0.0), end=(3.0, 5.0)),)
        )
    )
    guides = PotentialPool(grid)
    idle = guides.take((2.0, 1.0, 0.0, BODY))
    guides.release(idle)
    used = guides.take((1.0, 1.0, 0.0, BODY))
    before = guides.arrays[used].copy()
    grid.set_door("d", False)
    guides.outdate()
    guides.renew_one()
    assert guides.take((2.0, 1.0, 0.0, BODY)) == idle, "nobody waits for a goal that is known"
    assert np.array_equal(guides.arrays[used], before)
    assert guides.outdated_rows == 2
    guides.release(idle)

    derive = guides.outdated()
    assert derive is not None
    first = derive()
    assert first.goal[:2] == (1.0, 1.0), "those in use come first"
    grid.set_door("d", True)
    guides.outdate()
    guides.renew(first)
    assert not np.array_equal(guides.arrays[used], before)
    assert guides.outdated_rows == 2, "the ground has changed since"
    while (derive := guides.outdated()) is not None:
        guides.renew(derive())
    assert np.array_equal(guides.arrays[used], before)


def test_nobody_waits_for_a_goal_that_is_derived_outside() -> None:
    guides = pool()
    guides.derived_outside = True
    first = guides.take((1.0, 1.0, 0.0, BODY))
    assert np.isinf(guides.arrays[first]).all(), "no path leads there yet"
    assert guides.provisional(np.array([first, -1])).tolist() == [True, False]
    assert not guides.has((1.0, 1.0, 0.0, BODY))
    derive = guides.outdated()
    assert derive is not None
    guides.renew(derive())
    assert guides.has((1.0, 1.0, 0.0, BODY))
    alike = guides.take((1.0, 1.0, 0.0, Body(radius_m=0.3)))
    assert np.array_equal(guides.arrays[alike], guides.arrays[first]), "it goes by another body's"
    assert guides.provisional(np.array([alike, first])).tolist() == [True, False]
    derive = guides.outdated()
    assert derive is not None
    guides.renew(derive())
    wide = Potential(GRID, (1.0, 1.0), 0.0, 0.3, body=Body(radius_m=0.3))
    assert np.array_equal(guides.arrays[alike], wide.values)
    assert guides.outdated() is None


def test_what_comes_first_is_what_somebody_waits_for() -> None:
    guides = pool()
    guides.take((1.0, 1.0, 0.0, BODY))
    guides.derived_outside = True
    guides.outdate()
    guides.take((2.0, 1.0, 0.0, BODY))
    derive = guides.outdated()
    assert derive is not None
    assert derive().goal[:2] == (2.0, 1.0)


def test_goals_of_bodies_that_the_grid_has_forgotten_are_given_up() -> None:
    grid = LayeredGrid.from_scene(Scene.open_space((0.0, 0.0, 4.0, 4.0)))
    guides, child = PotentialPool(grid), Body.child()
    slot = guides.take((1.0, 1.0, 0.0, child))
    guides.release(slot)
    guides.outdate()
    assert guides.outdated() is not None
    for k in range(64):
        grid.row_of(Body(height_m=0.5 + 0.05 * k, radius_m=0.1))
    assert not grid.knows(child)
    assert guides.outdated() is None
    assert not guides.has((1.0, 1.0, 0.0, child))


def test_a_renewed_potential_that_nobody_knows_any_more_is_void() -> None:
    guides, others = pool(), pool()
    others.take((1.0, 1.0, 0.0, BODY))
    others.outdate()
    derive = others.outdated()
    assert derive is not None
    guides.renew(derive())
    assert guides.outdated() is None
    assert len(guides.arrays) == 0


def test_goals_that_are_prepared_get_their_rows_at_once() -> None:
    """No more rows are taken than may be kept idle."""
    guides, few = pool(), [(0.5 + 0.1 * k, 1.0, 0.0, BODY) for k in range(12)]
    guides.prepare(few, threads=2)
    assert len(guides.users) == 12
    for x, y, z_m, body in few:
        row = guides.take((x, y, z_m, body))
        assert np.array_equal(
            guides.arrays[row], Potential(GRID, (x, y), z_m, BODY.radius_m, body=body).values
        )
    many = pool()
    many.prepare([(0.3 + 0.05 * k, 2.0, 0.0, BODY) for k in range(60)], threads=2)
    assert len(many.users) == 33
