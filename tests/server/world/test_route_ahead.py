"""Where people on routes will be: around corners, as the body goes, so that feet keep up."""

import math

import numpy as np
import pytest

from esplanade.actors.locomotion.footsteps.course import AHEAD, AHEAD_S
from esplanade.server.world.inputs import Follow
from esplanade.server.world.route_ahead import CORNERS, RouteAhead
from tests.server.worlds import FIELD, Trial

WALK_MPS = 1.6


def test_places_lead_around_corners_and_end_with_the_route() -> None:
    ahead = RouteAhead(3)
    ahead.set(1, [(2.0, 0.0, 0.0), (2.0, 1.0, 0.0), (2.0, 1.0, 3.5)])
    ahead.set(2, [(0.5, 0.0, 0.0), (0.5, 9.0, 0.0)])
    here = np.array([[1.0, 0.0], [0.0, 0.0]])
    found = ahead.places(np.array([1, 2]), here, np.array([2.0, 1.0]))
    assert found.shape == (2, AHEAD, 2)
    for k in range(AHEAD):
        gone = 2.0 * AHEAD_S * k
        first = (1.0 + gone, 0.0) if gone <= 1.0 else (2.0, min(gone - 1.0, 1.0))
        assert found[0, k] == pytest.approx(first)
        gone = AHEAD_S * k
        second = (gone, 0.0) if gone <= 0.5 else (0.5, gone - 0.5)
        assert found[1, k] == pytest.approx(second)


def test_a_route_may_have_more_corners_than_anybody_looks_ahead() -> None:
    ahead = RouteAhead(1)
    ahead.set(0, [(0.2 * k, 0.0, 0.0) for k in range(1, 3 * CORNERS)])
    found = ahead.places(np.array([0]), np.zeros((1, 2)), np.array([WALK_MPS]))
    assert found[0, :, 0] == pytest.approx(WALK_MPS * AHEAD_S * np.arange(AHEAD))


def test_feet_keep_up_with_a_body_that_walks_around_something() -> None:
    trial = Trial(scene=FIELD)
    (ann,) = trial.join((50.0, 50.0))
    x, y = trial.position(ann)
    turns = [0.22 * k for k in range(1, 120)]
    route = tuple((x + math.sin(a), y + 1.0 - math.cos(a), 0.0) for a in turns)
    trial.tick(Follow(ann, 1, route))
    furthest = 0.0
    for _ in range(240):
        trial.tick()
        walked = trial.world.feet._walkers.steps
        slot = trial.world.state.slot(ann)
        feet = walked.standing[slot, :2], walked.landing[slot, :2]
        furthest = max(furthest, min(math.dist(trial.position(ann), foot) for foot in feet))
    assert trial.world.feet.lost == 0
    assert furthest < 0.6
