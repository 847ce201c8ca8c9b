"""Evasion and walls, one body at a time."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.pedestrians import SocialForce
from esplanade.pedestrians.compiled._force_kernels import beyond, evasion, slide, wall_push
from tests.planning.worlds import holds

NUMBERS = SocialForce().numbers(0.1)
CORNER = np.array([[1.0, -5.0, 1.0, 1.0], [1.0, 1.0, -5.0, 1.0]])
COUNTS = np.zeros(2, dtype=np.bool_)
coordinates = st.floats(-5.0, 5.0)


def test_whoever_is_met_head_on_is_evaded_to_the_right_and_slows_a_person_down() -> None:
    ax, ay = evasion(2.0, 0.0, 1.3, 0.0, -1.3, 0.0, 0.0, NUMBERS)
    assert ax < -0.1
    assert ay < -0.1


def test_bodies_at_one_place_or_without_any_interaction_do_nothing() -> None:
    assert evasion(0.0, 0.0, 1.3, 0.0, -1.3, 0.0, 0.0, NUMBERS) == (0.0, 0.0)
    assert evasion(1.0, 0.0, -0.5, 0.0, 0.0, 0.0, 0.0, NUMBERS) == (0.0, 0.0)


def test_what_is_behind_counts_half() -> None:
    behind = evasion(-1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, NUMBERS)
    ahead = evasion(1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, NUMBERS)
    assert behind[0] == pytest.approx(-0.5 * ahead[0])


@given(coordinates, coordinates, coordinates, coordinates, st.floats(0.0, 6.3))
@holds(200, 50)
def test_a_turned_scene_turns_the_evasion(
    x: float, y: float, vx: float, vy: float, angle: float
) -> None:
    if np.hypot(x, y) < 0.01:
        return
    turned = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    here = np.array(evasion(x, y, vx, vy, 0.4, -0.3, 0.2, NUMBERS))
    there = evasion(*turned @ (x, y), *turned @ (vx, vy), *turned @ (0.4, -0.3), 0.2, NUMBERS)
    speed = np.hypot(vx, vy)
    cosine = (x * vx + y * vy) / max(1e-9, speed * np.hypot(x, y))
    if abs(speed - 0.05) > 1e-6 and abs(cosine - NUMBERS.sight_cosine) > 1e-6:
        relative = 2.0 * np.array([vx - 0.4, vy + 0.3]) + np.array([x, y]) / np.hypot(x, y)
        across = relative[0] * y - relative[1] * x
        if abs(across) > 1e-6:
            np.testing.assert_allclose(there, turned @ here, atol=1e-9)


@given(coordinates, coordinates, coordinates, coordinates)
@holds(200, 50)
def test_no_more_is_taken_off_than_acts(ax: float, ay: float, rx: float, ry: float) -> None:
    left = np.hypot(*beyond(ax, ay, rx, ry))
    assert left <= 2.0 * np.hypot(ax, ay) + 1e-12
    assert beyond(ax, ay, ax, ay) == (0.0, 0.0)


def test_walls_push_away_and_those_that_do_not_count_do_not() -> None:
    push = wall_push(0.9, 0.0, CORNER, COUNTS, NUMBERS)
    assert push == pytest.approx((-3.0 * np.exp(-1.0), 0.0))
    assert wall_push(0.9, 0.0, CORNER, ~COUNTS, NUMBERS) == (0.0, 0.0)
    assert wall_push(-2.0, -3.0, CORNER, COUNTS, NUMBERS) == (0.0, 0.0)


def test_a_step_slides_along_a_wall_and_ends_in_a_corner() -> None:
    along = np.array([0.3, 0.1])
    slide(0.9, 0.0, along, CORNER, COUNTS, 0.05)
    np.testing.assert_allclose(along, [0.0, 0.1])
    cornered = np.array([0.3, 0.3])
    slide(0.9, 0.9, cornered, CORNER, COUNTS, 0.05)
    np.testing.assert_array_equal(cornered, [0.0, 0.0])
    free = np.array([-0.3, -0.3])
    slide(0.9, 0.9, free, CORNER, COUNTS, 0.05)
    np.testing.assert_array_equal(free, [-0.3, -0.3])
    still = np.zeros(2)
    slide(0.9, 0.9, still, CORNER, COUNTS, 0.05)
    np.testing.assert_array_equal(still, [0.0, 0.0])


def test_a_step_into_a_sharp_wedge_stops() -> None:
    """Sliding along one wall leads into the other, and back."""
    wedge = np.array([[0.0, 0.0, 5.0, 0.4], [0.0, 0.0, 5.0, -0.4]])
    step = np.array([-0.5, 0.02])
    slide(0.6, 0.0, step, wedge, COUNTS, 0.05)
    np.testing.assert_array_equal(step, [0.0, 0.0])
