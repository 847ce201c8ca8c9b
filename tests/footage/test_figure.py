"""The figure: its parts are where the joints are, in two colours of legs."""

import numpy as np

from esplanade.footage.figure import SHOES, TROUSERS, parts_of
from tests.footage.films import filmed


def test_shoes_stand_on_the_ground_of_a_body_at_rest():
    parts = parts_of(filmed("flat").poses, 0)
    for colour in SHOES:
        (shoe,) = [part for part in parts if part.colour == colour]
        lowest = np.min(shoe.centres[:, 2] - shoe.radii_m)
        assert abs(lowest) < 0.01


def test_left_and_right_legs_differ_in_colour():
    parts = parts_of(filmed("flat").poses, 0)
    left, right = (
        np.mean([part.centres[:, 1].mean() for part in parts if part.colour == colour])
        for colour in TROUSERS
    )
    assert left > right


def test_nobody_is_taller_than_the_build():
    film = filmed("flat")
    parts = parts_of(film.poses, 0)
    top = max(float(np.max(part.centres[:, 2] + part.radii_m)) for part in parts)
    assert top < float(film.sizes.stature_m[0]) + 0.03
