import numpy as np

from esplanade.actors.locomotion.footsteps.course import desired_headings
from tests.actors.locomotion.courses import course


def test_a_course_is_followed_and_stays_at_its_end() -> None:
    way = course((1.0, -0.5))
    np.testing.assert_allclose(way.at(np.array([0.33])), [[0.33, -0.165, 0.0]])
    np.testing.assert_allclose(way.at(np.array([9.0])), way.ahead[:, -1])
    for seconds in (0.0, 0.1, 0.77):
        np.testing.assert_allclose(way.velocity(np.array([seconds])), [[1.0, -0.5]])
    np.testing.assert_allclose(way.velocity(np.array([9.0])), [[0.0, 0.0]], atol=1e-12)


def test_bodies_that_walk_face_ahead_and_others_as_they_did() -> None:
    still, walking = course((0.0, -0.2), 0.7), course((0.0, -1.0), 0.7)
    assert desired_headings(still, np.array([[0.0, -0.2]])).tolist() == [0.7]
    assert desired_headings(walking, np.array([[0.0, -1.0]])).tolist() == [-np.pi / 2.0]
