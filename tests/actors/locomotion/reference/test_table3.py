"""Table 3: 15 of 15 rows with the fitted offset, and what is left without it."""

import numpy as np
import pytest

from esplanade.actors.locomotion.body.skeleton import leg_points
from esplanade.actors.locomotion.gait.curves import joint_angles
from esplanade.actors.locomotion.reference import table3


def test_all_rows_are_reproduced_with_the_fitted_offset():
    assert table3.reproduce().rows_right() == (15, 15)


@pytest.mark.parametrize("offset", [0.00225, 0.0025])
def test_the_offset_is_known_to_a_quarter_of_a_thousandth_only(offset: float):
    assert table3.reproduce(offset).rows_right() == (15, 15)


def test_two_thirds_are_reproduced_without_it():
    assert table3.reproduce(offset=0.0).rows_right() == (10, 10)


def test_no_row_follows_from_the_printed_equation():
    assert table3.reproduce_as_printed().rows_right() == (0, 0)
    assert table3.eq12_printed(0.5) == pytest.approx(0.382, abs=5e-4)


def test_printed_velocities_are_halves_of_halves():
    share = table3.PRINTED_RV / 0.485
    steps = 2.0 ** (table3.SHIFTED_HALVINGS + 1)
    assert np.max(np.abs(share * steps - np.round(share * steps))) < 0.05


def test_the_lengths_are_those_of_the_curves_without_an_ankle():
    rv = np.linspace(0.0, 0.5, 11)
    _, front, _ = leg_points(joint_angles(rv, np.zeros(11), faded=False))
    _, rear, _ = leg_points(joint_angles(rv, np.full(11, 0.5), faded=False))
    assert np.allclose(table3.source_length(rv), front[:, 0] - rear[:, 0], atol=1e-12)
