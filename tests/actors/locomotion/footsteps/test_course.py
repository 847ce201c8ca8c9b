import numpy as np
import pytest

from esplanade.actors.locomotion.footsteps._course_kernels import (
    BACKWARD_MPS,
    PUSHED_MPS,
    PUSHED_S,
    along,
    desired_heading,
    velocity_about,
)
from esplanade.actors.locomotion.footsteps.course import AHEAD, AHEAD_S, planned_places
from tests.actors.locomotion.courses import course


def test_a_course_is_followed_and_stays_at_its_end() -> None:
    ahead = course((1.0, -0.5)).ahead[0]
    np.testing.assert_allclose([along(ahead, 0.33, d) for d in range(3)], [0.33, -0.165, 0.0])
    np.testing.assert_allclose([along(ahead, 9.0, d) for d in range(3)], ahead[-1])
    for seconds in (0.0, 0.1, 0.77):
        np.testing.assert_allclose(velocity_about(ahead, seconds), [1.0, -0.5])
    np.testing.assert_allclose(velocity_about(ahead, 9.0), [0.0, 0.0], atol=1e-12)


def test_bodies_that_walk_face_ahead_and_others_as_they_did() -> None:
    assert desired_heading(0.7, 0.0, -0.2) == 0.7
    assert desired_heading(0.7, 0.0, -1.0) == -np.pi / 2.0


def as_arrays_do(planned, slice_s, now_s, places):
    """The plain twin of `planned_places`."""
    times = np.arange(AHEAD) * AHEAD_S
    last = planned.shape[1] - 1
    at = np.minimum((now_s + times) / slice_s, float(last))
    before = np.minimum(at.astype(np.int64), max(last - 1, 0))
    share = (at - before)[:, None]
    after = np.minimum(before + 1, last)
    expected = (1.0 - share) * planned[:, before] + share * planned[:, after]
    fade = np.maximum(1.0 - times, 0.0)[:, None]
    ahead = expected + fade * (places - expected[:, 0])[:, None]
    pushed_mps = np.array(
        [
            off_plan(moved / now_s, meant / now_s)
            for moved, meant in zip(
                (places - planned[:, 0])[:, :2],
                (now_s / slice_s * (planned[:, min(1, last)] - planned[:, 0]))[:, :2],
                strict=True,
            )
        ]
    )
    pushed = np.flatnonzero(np.hypot(*pushed_mps.T) > PUSHED_MPS)
    ahead[pushed, :, :2] += np.minimum(times, PUSHED_S)[:, None] * pushed_mps[pushed, None]
    return ahead, pushed


def off_plan(velocity, plan):
    """The part of a velocity that a plan does not explain; being slower along it is none."""
    speed = np.hypot(*plan)
    if speed <= PUSHED_MPS:
        return velocity
    along = velocity @ plan / speed
    aside = velocity - along * plan / speed
    backward = np.clip(-along / BACKWARD_MPS, 0.0, 1.0)
    return aside + backward * (along - speed) * plan / speed


@pytest.mark.parametrize("instants", [1, 2, 19])
def test_bodies_get_back_to_their_plans_within_a_second(instants) -> None:
    rng = np.random.default_rng(instants)
    planned = rng.normal(size=(60, instants, 3))
    places = planned[:, 0] + 0.05 * rng.normal(size=(60, 3))
    found, pushed = planned_places(planned, 0.2, 0.05, places)
    expected, rows = as_arrays_do(planned, 0.2, 0.05, places)
    np.testing.assert_allclose(found, expected, atol=1e-12)
    assert pushed.tolist() == rows.tolist()
    np.testing.assert_allclose(found[:, 0], places, atol=1e-12)
    slow = planned.copy()
    slow[:, :, :2] = np.arange(instants)[:, None] * [0.2, 0.1]
    aside = slow[:, 0] + [0.04, 0.02, 0.1]
    behind, nobody = planned_places(slow, 0.2, 0.05, aside)
    if instants > 1:
        assert nobody.tolist() == []
        on_plan, _ = planned_places(slow, 0.2, 0.05, slow[:, 0])
        np.testing.assert_allclose(behind[:, 5:], on_plan[:, 5:], atol=1e-12)


def test_a_body_that_is_pushed_back_goes_on_so_for_about_a_step_and_then_as_planned() -> None:
    planned = np.zeros((3, 8, 3))
    planned[:, :, 0] = 1.2 * 0.2 * np.arange(8)
    moved = np.array([[-0.06, 0.0, 0.0], [0.03, 0.05, 0.0], [0.01, 0.0, 0.0]])
    found, pushed = planned_places(planned, 0.2, 0.05, moved)
    assert pushed.tolist() == [0, 1]
    back, aside, slower = found
    np.testing.assert_allclose(np.diff(back[:4, 0]) / 0.2, -1.2, atol=0.2)
    np.testing.assert_allclose(np.diff(back[4:, 0]) / 0.2, 1.2, atol=0.2)
    np.testing.assert_allclose(aside[3, 1], 0.05 * 0.4 + 1.0 * 0.6)
    np.testing.assert_allclose(np.diff(slower[:, 0]) / 0.2, 1.2, atol=0.1)
