import numpy as np
import pytest

from esplanade.actors.locomotion.body.sizes import STATURE, BodySizes


def test_trunks_fit_legs_of_bodies_in_proportion() -> None:
    legs = np.array([0.8, 0.9, 1.0])
    sizes = BodySizes(legs, STATURE * legs)
    assert sizes.trunk_m == pytest.approx(legs)
    assert sizes.foot_m == pytest.approx(0.2 * legs)
    some = sizes.take(np.array([2, 0]))
    assert some.leg_m.tolist() == [1.0, 0.8]
