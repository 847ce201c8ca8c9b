"""The measures of episodes, and their samples."""

from dataclasses import replace

import numpy as np

from esplanade.evaluation.measures import MEASURES, PIECE_S, named, pieces, sample, table
from esplanade.evaluation.policies import make_policy
from esplanade.evaluation.simulation import Environment, run_episode
from tests.evaluation.worlds import RULES, replay, trip, walk


def test_a_table_has_a_row_for_each_episode_and_a_column_for_each_measure() -> None:
    place = Environment.of(replay(walk("1", 0.0, (0, 0), (10, 0)), walk("2", 0.0, (10, 0), (0, 0))))
    score = run_episode(place, trip(place.replay), make_policy("straight"), RULES).score
    lost = replace(score, reached=False, time_ratio=np.nan)
    rows = table([score, lost])
    assert rows.shape == (2, len(MEASURES))
    touched, gone = (named(row) for row in rows)
    assert touched["contacts_percent"] == 100.0
    assert touched["near_s"] == score.near_s
    assert touched["missed_percent"] == 0.0
    assert gone["missed_percent"] == 100.0
    assert np.isnan(gone["time_ratio"])


def test_trips_that_begin_in_the_same_piece_of_the_recording_hang_together() -> None:
    place = Environment.of(replay(walk("1", 0.0, (0, 0), (10, 0)), walk("2", 0.0, (10, 0), (0, 0))))
    score = run_episode(place, trip(place.replay), make_policy("straight"), RULES).score
    scores = [replace(score, start_s=s) for s in (0.0, PIECE_S - 0.1, PIECE_S, 5.5 * PIECE_S, 1.0)]
    assert pieces(scores) == [0, 0, 1, 5, 0]
    assert sample(scores).clusters.tolist() == [0, 0, 1, 2, 0]
