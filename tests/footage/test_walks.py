"""The walks that are filmed: known to the options, at the pace they claim, within their scenes."""

import numpy as np
import pytest

from esplanade.footage.options import WALKS
from esplanade.footage.walks import TICK_S, walks


def test_the_options_name_every_walk():
    assert tuple(walks()) == WALKS


@pytest.mark.parametrize(("name", "speed_mps"), [("flat", 1.3), ("curve", 1.1), ("stairs", 0.75)])
def test_bodies_go_at_the_pace_of_the_caption(name: str, speed_mps: float):
    walk = walks()[name]
    speeds = np.hypot(*np.diff(walk.places, axis=0).T) / TICK_S
    assert f"{speed_mps:g} m/s" in walk.caption
    assert np.median(speeds[speeds > 0.0]) == pytest.approx(speed_mps, rel=0.02)
    assert speeds.max() <= speed_mps * 1.001


@pytest.mark.parametrize("name", WALKS)
def test_walks_begin_and_end_at_rest_inside_their_scenes(name: str):
    walk = walks()[name]
    assert np.all(walk.places[1] == walk.places[0])
    assert np.all(walk.places[-2] == walk.places[-1])
    x0, y0, x1, y1 = walk.scene.bounds
    assert np.all((walk.places > (x0, y0)) & (walk.places < (x1, y1)))
    assert len(walk.headings) == len(walk.places)


@pytest.mark.parametrize("name", WALKS)
def test_spans_of_strips_lie_within_the_walk(name: str):
    walk = walks()[name]
    end_s = (len(walk.places) - 1) * TICK_S
    assert all(0.0 <= first < last <= end_s for first, last in walk.spans_s)


def test_a_body_that_stands_faces_where_it_went_last():
    walk = walks()["start-stop"]
    first_stop = round((0.4 + 2.3 / 1.4 + 0.6) / TICK_S)
    assert walk.headings[0] == pytest.approx(0.0)
    assert walk.headings[first_stop] == pytest.approx(0.0)
    assert walk.headings[-1] == pytest.approx(np.pi)
