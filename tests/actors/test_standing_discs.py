"""The room that discs around those who stand get."""

import numpy as np
import pytest

from esplanade.actors.standing_discs import (
    as_known,
    narrowed,
    narrower,
    still_there,
    wider,
    widest,
    with_those,
)


@pytest.mark.parametrize(
    ("room_m", "widened_m"), [(0.3, 0.65), (0.5, 0.75), (0.72, 0.97), (0.95, 1.2)]
)
def test_a_disc_is_widened_the_less_the_wider_it_is_but_always(
    room_m: float, widened_m: float
) -> None:
    assert wider(np.array([1.0, 2.0, 0.0, room_m])) == (1.0, 2.0, 0.0, widened_m)


def test_of_discs_around_a_place_the_widest_counts() -> None:
    near, far = (1.0, 2.0, 0.0, 0.5), (3.0, 2.0, 0.0, 0.5)
    wide = (1.0, 2.0, 0.0, 0.7)
    assert widest({near, wide, far}) == {wide, far}
    assert as_known(np.array([near, far]), [wide])[:, 3].tolist() == [0.7, 0.5]


def test_a_disc_is_narrowed_to_hardly_more_than_the_body_and_stays_so() -> None:
    usual = np.array([(1.0, 2.0, 0.0, 0.5), (3.0, 2.0, 0.0, 0.3)])
    assert [narrower(disc, 0.25)[3] for disc in usual] == [0.35, 0.3]
    narrow, wide = (1.0, 2.0, 0.0, 0.35), (1.0, 2.0, 0.0, 0.75)
    other = (3.0, 2.0, 0.0, 0.3)
    assert narrowed({narrow, other}, usual) == {narrow}
    assert with_those({wide, other}, {narrow}) == {narrow, other}
    assert as_known(usual, [narrow])[:, 3].tolist() == [0.5, 0.3]


def test_a_place_is_known_while_one_stands_there_whatever_room_it_gets() -> None:
    near, far = (1.0, 2.0, 0.0, 0.5), (3.0, 2.0, 0.0, 0.5)
    standing = np.array([(1.001, 1.999, 0.0, 0.3), (3.0, 2.02, 0.0, 0.5)])
    assert still_there((near, far), standing) == (near,)
    assert still_there((near, far), np.empty((0, 4))) == ()
