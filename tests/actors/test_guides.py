"""The pool of potentials that actors are led by."""

import numpy as np

from actors.guides import GuidePool
from planning import LayeredGrid, Scene


def pool() -> GuidePool:
    return GuidePool(LayeredGrid.from_scene(Scene.open_space((0.0, 0.0, 4.0, 4.0))))


def test_actors_with_the_same_goal_share_a_row() -> None:
    guides = pool()
    one = guides.take((1.0, 1.0), 0, 0.25)
    assert guides.take((1.0, 1.0), 0, 0.25) == one
    assert guides.take((1.0, 1.0), 0, 0.3) != one
    assert guides.take((2.0, 1.0), 0, 0.25) != one


def test_a_goal_comes_back_to_the_row_it_had() -> None:
    guides = pool()
    slot = guides.take((1.0, 1.0), 0, 0.25)
    before = guides.arrays[slot].copy()
    guides.release(slot)
    assert guides.take((1.0, 1.0), 0, 0.25) == slot
    assert np.array_equal(guides.arrays[slot], before)


def test_rows_in_use_stay_while_idle_ones_are_used_again() -> None:
    guides = pool()
    kept = guides.take((3.0, 3.0), 0, 0.25)
    before = guides.arrays[kept].copy()
    for k in range(200):
        guides.release(guides.take((0.5 + 0.01 * k, 1.0), 0, 0.25))
    assert len(guides.arrays) <= 64
    assert np.array_equal(guides.arrays[kept], before)
    fresh = guides.take((0.5, 1.0), 0, 0.25)
    assert fresh != kept
    assert guides.arrays[fresh, 0, 4, 2, 0] < 0.5


def test_nobodys_row_may_be_given_back() -> None:
    guides = pool()
    guides.release(-1)
    assert guides.take((1.0, 1.0), 0, 0.25) == 0
