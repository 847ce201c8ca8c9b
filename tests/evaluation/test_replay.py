"""Replays: ticks, the order of people, and past positions."""

import numpy as np
import pytest

from esplanade.evaluation.replay import Replay
from esplanade.recordings import Crowd, Track
from tests.evaluation.worlds import crowd, replay, walk


def samples(name: str, *rows: tuple[float, float, float]) -> Track:
    table = np.array(rows)
    return Track(name, table[:, 0], table[:, 1:])


def test_people_are_where_they_were_at_every_tick_they_are_there() -> None:
    walked = replay(samples("1", (0.95, 0.0, 0.0), (1.35, 4.0, 0.0)))
    assert (walked.first[0], walked.last[0]) == (10, 13)
    np.testing.assert_allclose(walked.trajectory(0)[:, 0], [0.5, 1.5, 2.5, 3.5])
    np.testing.assert_allclose(walked.at(0, 12), [2.5, 0.0])
    assert [walked.present(tick).tolist() for tick in (9, 10, 13, 14)] == [[], [0], [0], []]


def test_a_sample_on_a_tick_is_there_whatever_rounding_says() -> None:
    walked = replay(samples("1", (0.1 + 0.2, 0.0, 0.0), (0.7, 1.0, 0.0)))
    assert (walked.first[0], walked.last[0], walked.end_tick) == (3, 7, 7)


def test_people_recorded_between_two_ticks_are_never_present() -> None:
    walked = replay(samples("1", (0.11, 0.0, 0.0), (0.19, 1.0, 0.0)), walk("2", 0, (0, 0), (3, 0)))
    assert not any(0 in walked.present(tick) for tick in range(10))
    assert len(walked.trajectory(0)) == 0
    assert walked.bounds[2] == pytest.approx(3.0, abs=0.5)


def test_people_are_ordered_by_number_then_by_name() -> None:
    tracks = [walk(name, 0.0, (0, 0), (1, 0)) for name in ("b", "10", "9", "a")]
    assert replay(*tracks).ids == ("9", "10", "a", "b")


def test_recordings_may_begin_at_any_time() -> None:
    for begins_s in (-50.0, 1e7):
        walked = replay(walk("1", begins_s, (0, 0), (6, 0)))
        assert len(walked.trajectory(0)) == walked.last[0] - walked.first[0] + 1
        assert walked.first[0] == round(begins_s / 0.1)


def test_the_past_ends_now_and_begins_when_they_came() -> None:
    walked = replay(walk("1", 0.0, (0, 0), (12, 0)))
    assert len(walked.past(0, 2, 32)) == 3
    past = walked.past(0, 50, 32)
    assert len(past) == 33
    np.testing.assert_array_equal(past[-1], walked.at(0, 50))


def test_cubic_interpolation_meets_the_samples_without_corners() -> None:
    track = walk("1", 0.0, (0, 0), (3, 0), (3, 3))
    smooth = Replay(crowd(track), interpolation="cubic").trajectory(0)
    np.testing.assert_allclose(smooth[::4], track.positions[: len(smooth[::4])], atol=1e-9)
    corner = Replay(crowd(track)).trajectory(0)
    bend = [np.abs(np.diff(trajectory, n=2, axis=0)).max() for trajectory in (smooth, corner)]
    assert bend[0] < bend[1]


def test_names_come_from_the_recording() -> None:
    assert Replay(Crowd("zara1", (walk("1", 0, (0, 0), (1, 0)),))).name == "zara1"
