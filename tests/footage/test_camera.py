"""Cameras: what is right, up and near of them."""

import numpy as np
import pytest

from esplanade.footage.camera import Camera


def test_axes_are_upright_and_at_right_angles():
    axes = Camera((0.0, 0.0, 0.0), -62.0, 34.0, 100.0, (200, 100)).axes
    assert np.allclose(axes @ axes.T, np.eye(3), atol=1e-15)
    assert axes[0, 2] == 0.0
    assert axes[1, 2] > 0.0


def test_from_the_south_east_is_to_the_right_and_up_is_up():
    camera = Camera((1.0, 0.0, 1.0), -90.0, 0.0, 100.0, (200, 100))
    points = [(1.0, 0.0, 1.0), (1.5, 0.0, 1.0), (1.0, 0.0, 1.2), (1.0, -3.0, 1.0)]
    assert camera.pixels(points) == pytest.approx(
        np.array([[100.0, 50.0], [150.0, 50.0], [100.0, 30.0], [100.0, 50.0]])
    )
    assert camera.seen(points)[3, 2] == pytest.approx(3.0)
