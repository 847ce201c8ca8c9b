"""Fig. 6 of Lei & Li: how where a person is and where it goes bends one search's path."""

import numpy as np
import pytest

from esplanade.planning import SearchStatus
from tests.planning.agents.test_search import found, ground_of
from tests.planning.worlds import STEP_S, task

START, GOAL = (1.125, 4.125), (7.375, 4.125)
# (a) and (b): the same way in another place; (c) and (d): the same place and another way.
FIG_6 = {
    "a": ((1.6, 7.6), (0.5, 0.0)),
    "b": ((4.0, 4.6), (0.5, 0.0)),
    "c": ((5.5, 4.3), (-0.8, 0.0)),
    "d": ((5.5, 4.3), (0.8, 0.0)),
}


@pytest.fixture(scope="module")
def searches():
    """Each case's person and result: the actor is already walking towards its goal."""
    question = task(START, GOAL, velocity=(1.3, 0.0))
    return {name: (who, found(ground_of(question, people=[who]))) for name, who in FIG_6.items()}


def sideways(path) -> float:
    """Largest distance from the straight way, metres."""
    return float(np.abs(path[:, 1] - START[1]).max())


def clearance(who, path) -> float:
    """Smallest distance of centres if the person does as predicted, metres."""
    seconds = STEP_S / 2 * np.arange(len(path))
    person = np.array(who[0]) + seconds[:, None] * np.array(who[1])
    return float(np.hypot(*(path - person).T).min())


def test_a_far_away_the_path_is_straight(searches) -> None:
    _, result = searches["a"]
    assert result.status is SearchStatus.FOUND
    assert sideways(result.path) < 0.02
    assert result.path[-1, 0] > 7.0


def test_b_near_the_path_bends(searches) -> None:
    _, result = searches["b"]
    assert 0.3 < sideways(result.path) < 2.0


def test_c_heading_for_the_actor_it_bends_more_and_d_heading_away_less(searches) -> None:
    bends = {name: sideways(result.path) for name, (_, result) in searches.items()}
    assert bends["a"] <= bends["d"] < bends["b"]
    assert bends["d"] + 0.3 < bends["c"] < 2.0


def test_nobody_is_touched_if_everyone_does_as_predicted(searches) -> None:
    for name, (who, result) in searches.items():
        assert clearance(who, result.path) > 0.55, name


def test_of_two_ways_round_the_one_behind_the_person_is_taken() -> None:
    """Somebody who crosses from the right is let pass in front."""
    question = task(START, GOAL, velocity=(1.3, 0.0))
    crossing = ((4.3, 1.6), (0.0, 1.0))
    result = found(ground_of(question, people=[crossing]))
    assert clearance(crossing, result.path) > 0.55
    meeting = np.argmin(np.hypot(*(result.path - (4.3, 4.125)).T))
    assert result.path[meeting, 1] < 4.125 or meeting > 13
