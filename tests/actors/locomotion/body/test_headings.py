import numpy as np
import pytest

from esplanade.actors.locomotion.body.headings import forward_and_left, wrap_angle


def test_wrapped_angles_are_the_same_directions_within_half_a_turn() -> None:
    angles = np.linspace(-20.0, 20.0, 401)
    wrapped = wrap_angle(angles)
    assert ((wrapped >= -np.pi) & (wrapped < np.pi)).all()
    assert np.exp(1j * wrapped) == pytest.approx(np.exp(1j * angles))


def test_left_is_a_quarter_turn_from_forward() -> None:
    headings = np.array([0.0, 0.7, -2.5])
    forward, left = forward_and_left(headings)
    ahead, aside = forward @ (1.0, 1j), left @ (1.0, 1j)
    assert ahead == pytest.approx(np.exp(1j * headings))
    assert aside == pytest.approx(1j * ahead)
