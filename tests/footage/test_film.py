"""Films show what is walked: feet that stay, treads that are met, ends that are reached."""

from itertools import pairwise

import numpy as np
import pytest

from esplanade.footage.film import film_walk
from esplanade.footage.options import WALKS
from esplanade.footage.walks import walks
from tests.footage.films import FRAMES_A_SECOND, filmed


@pytest.mark.parametrize("name", WALKS)
def test_bodies_end_where_the_walk_does(name: str):
    film = filmed(name)
    assert np.hypot(*(film.poses.root[-1, :2] - film.walk.places[-1])) < 0.05
    assert np.allclose(np.diff(film.times_s), 1.0 / FRAMES_A_SECOND)


@pytest.mark.parametrize("name", WALKS)
def test_bones_keep_their_lengths(name: str):
    film = filmed(name)
    thighs = np.linalg.norm(film.poses.knees - film.poses.hips, axis=2)
    shins = np.linalg.norm(film.poses.ankles - film.poses.knees, axis=2)
    assert np.ptp(thighs) < 1e-3
    assert np.ptp(shins) < 1e-3


@pytest.mark.parametrize("name", WALKS)
def test_feet_that_rest_flat_do_not_slide(name: str):
    film = filmed(name)
    ankles, toes = film.poses.ankles, film.poses.toes
    flat = np.abs(film.poses.pitches) < 1e-6
    level = np.abs(ankles[..., 2] - toes[..., 2]) < 1e-6
    # A swing foot may be level too, but then it is on its way up or down.
    resting = (flat & level)[1:] & (flat & level)[:-1] & (np.diff(ankles[..., 2], axis=0) == 0.0)
    moved = np.linalg.norm(np.diff(ankles, axis=0), axis=2)
    in_place = resting & (moved < 0.02)
    assert in_place.sum() > 20
    assert moved[in_place].max() < 1e-6


def test_feet_come_down_on_treads():
    film = filmed("stairs")
    heights = np.array([footprint.place[2] for footprint in film.footprints])
    assert np.allclose(heights / 0.17, np.round(heights / 0.17), atol=1e-6)
    assert heights.max() == pytest.approx(6 * 0.17)
    assert heights[[0, -1]].tolist() == [0.0, 0.0]


def test_steps_that_nobody_foresaw_are_aimed_anew():
    film = filmed("start-stop")
    assert film.steps > len(film.footprints)


def test_footprints_alternate_on_a_straight_way():
    sides = [footprint.right for footprint in filmed("flat").footprints[2:]]
    assert all(a != b for a, b in pairwise(sides))


def test_the_same_seed_films_the_same_and_another_one_another_body():
    again = film_walk(walks()["flat"], FRAMES_A_SECOND, seed=0)
    assert np.array_equal(again.poses.ankles, filmed("flat").poses.ankles)
    assert filmed("flat", seed=3).sizes.leg_m != filmed("flat").sizes.leg_m
