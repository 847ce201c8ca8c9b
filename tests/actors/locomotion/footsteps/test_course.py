import numpy as np
import pytest

from esplanade.actors.locomotion.footsteps._course_kernels import (
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
    return expected + fade * (places - expected[:, 0])[:, None]


@pytest.mark.parametrize("instants", [1, 2, 19])
def test_bodies_get_back_to_their_plans_within_a_second(instants) -> None:
    rng = np.random.default_rng(instants)
    planned, places = rng.normal(size=(30, instants, 3)), rng.normal(size=(30, 3))
    found = planned_places(planned, 0.2, 0.05, places)
    np.testing.assert_array_equal(found, as_arrays_do(planned, 0.2, 0.05, places))
    np.testing.assert_allclose(found[:, 0], places, atol=1e-12)
    on_plan = planned_places(planned, 0.2, 0.05, planned[:, 0])
    np.testing.assert_allclose(found[:, 5:], on_plan[:, 5:], atol=1e-12)
