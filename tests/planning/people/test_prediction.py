"""Eqs. (1)-(3) against the way they are written, and what becomes of people's tracks."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning import LayeredGrid, PredictionModel, TrackHistory, Wall
from esplanade.planning.people import _prediction_kernels as kernels
from tests.naive import prediction as naive
from tests.planning.storeys import SLAB_FROM, STAIRS_FROM, box, grid_of, storeyed
from tests.planning.worlds import UPPER_M, holds, open_grid

TICK_S = 0.1
SAMPLE_S = 0.4

tracks = st.lists(
    st.tuples(st.floats(-50.0, 50.0), st.floats(-50.0, 50.0)), min_size=2, max_size=6
).map(np.array)


@given(tracks)
@holds(100, 100)
def test_both_readings_of_eq_1_are_their_sums(track) -> None:
    known = len(track)
    default = kernels.mean_velocity(track, known, SAMPLE_S)
    printed = kernels.printed_velocity(track, known, SAMPLE_S)
    assert default == pytest.approx(naive.default_velocity(track, SAMPLE_S), abs=1e-9)
    assert printed == pytest.approx(naive.printed_velocity(track, SAMPLE_S), abs=1e-9)


@given(tracks)
@holds(100, 100)
def test_the_default_is_the_exponential_mean_of_past_velocities(track) -> None:
    default = kernels.mean_velocity(track, len(track), SAMPLE_S)
    assert default == pytest.approx(naive.exponential_mean(track, SAMPLE_S), abs=1e-9)


@given(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), st.integers(1, 12), st.booleans())
@holds(60, 30)
def test_who_walks_evenly_is_expected_to_go_on_so(vx, vy, ticks, printed) -> None:
    history = TrackHistory(PredictionModel(printed=printed), TICK_S)
    for k in range(ticks + 1):
        history.observe({"p": (vx * k * TICK_S, vy * k * TICK_S)})
    assert history.velocities()[0] == pytest.approx([vx, vy], abs=1e-9)


def test_who_has_just_come_is_taken_to_stand() -> None:
    history = TrackHistory(PredictionModel(), TICK_S)
    history.observe({"p": (3.0, 4.0)})
    assert history.velocities().tolist() == [[0.0, 0.0]]
    assert history.positions.tolist() == [[3.0, 4.0]]


def test_the_newest_velocity_has_no_past() -> None:
    """Over one sample of 0.4 s, less while somebody has been seen for less."""
    grid = open_grid(8.0)
    history = TrackHistory(PredictionModel(), TICK_S)
    xs = np.cumsum([0.0] + [0.1] * 12 + [-0.1] * 6)
    for k, x in enumerate(xs):
        history.observe({"p": (x, 2.0)})
        expected = 0.0 if k == 0 else (x - xs[max(0, k - 4)]) / (min(k, 4) * TICK_S)
        newest = history.predict(grid, 2, 0.2).newest
        assert newest[0] == pytest.approx([expected, 0.0], abs=1e-9)
    assert history.velocities()[0, 0] > newest[0, 0]


def test_an_old_turn_counts_less_than_a_new_one() -> None:
    straight = np.array([[0.0, 0.0], [-0.4, 0.0], [-0.8, 0.0], [-1.2, 0.0], [-1.6, 0.0]])
    late, early = straight.copy(), straight.copy()
    late[1:, 1] -= 0.2
    early[4:, 1] -= 0.2
    turned = [abs(kernels.mean_velocity(t, 5, SAMPLE_S)[1]) for t in (late, early)]
    assert turned == pytest.approx([0.25, 0.0625])


def walked(grid, velocity, model=None, start=(4.0, 4.0), ticks=20):
    history = TrackHistory(model or PredictionModel(), TICK_S)
    for k in range(ticks):
        moved = np.multiply(velocity, (k - ticks + 1) * TICK_S)
        history.observe({"p": tuple(np.add(start, moved))})
    return history.predict(grid, 24, 0.2)


def growth_mps(history):
    """By how much everyone's deviation grows a second, (P,)."""
    sigmas = history.predict(open_grid(8.0), 1, 1.0).sigmas
    return sigmas[:, 1] - sigmas[:, 0]


def test_means_and_deviations_follow_eqs_2_and_3() -> None:
    alike = PredictionModel(calibration_s=math.inf)
    prediction = walked(open_grid(40.0), (1.0, -0.5), alike, start=(20.0, 20.0))
    seconds = 0.2 * np.arange(25)
    assert prediction.means[0] == pytest.approx(
        np.array([20.0, 20.0]) + seconds[:, None] * np.array([1.0, -0.5]), abs=1e-6
    )
    assert prediction.sigmas[0] == pytest.approx(0.05 + 0.17 * seconds)
    assert not prediction.heights.any()


def test_deviations_follow_how_steadily_somebody_walks() -> None:
    model = PredictionModel()
    history = TrackHistory(model, TICK_S)
    rng = np.random.default_rng(5)
    astray = np.array([20.0, 20.0])
    for k in range(120):
        astray = astray + rng.normal(0.0, 0.1, 2)
        history.observe({"steady": (0.13 * k, 5.0), "erratic": tuple(astray), "z": (1.0, 1.0)})
        if k == 0:
            assert growth_mps(history) == pytest.approx([model.sigma_growth_mps] * 3)
    erratic, steady, _ = growth_mps(history)
    assert history.ids == ["erratic", "steady", "z"]
    assert steady == pytest.approx(model.least_growth_mps)
    assert erratic > 1.2 * model.sigma_growth_mps


def test_who_comes_back_is_judged_anew() -> None:
    model = PredictionModel()
    history = TrackHistory(model, TICK_S)
    for k in range(60):
        history.observe({"p": (0.13 * k, 5.0)})
    assert growth_mps(history)[0] < 0.9 * model.sigma_growth_mps
    history.observe({})
    history.observe({"p": (1.0, 5.0)})
    assert growth_mps(history) == pytest.approx([model.sigma_growth_mps])


def test_a_prediction_slides_along_a_wall_and_never_through_it() -> None:
    grid = open_grid(8.0, [((5.0, 0.0), (5.0, 8.0))])
    prediction = walked(grid, (1.0, 0.5))
    assert prediction.means[0, :, 0].max() <= 5.0 - 0.15 + 1e-6
    assert prediction.means[0, -1, 1] == pytest.approx(4.0 + 24 * 0.2 * 0.5, abs=0.05)
    assert prediction.velocities[0, -1] == pytest.approx([0.0, 0.5], abs=1e-6)


def test_people_may_come_go_and_come_again() -> None:
    history = TrackHistory(PredictionModel(), TICK_S)
    for k in range(5):
        history.observe({"a": (0.1 * k, 0.0), "b": (0.0, 1.0)})
    history.observe({"b": (0.0, 1.0)})
    assert history.ids == ["b"]
    history.observe({"a": (9.0, 9.0), "b": (0.0, 1.0)})
    velocities = dict(zip(history.ids, history.velocities().tolist(), strict=True))
    assert velocities == {"a": [0.0, 0.0], "b": [0.0, 0.0]}


def test_more_people_than_before_keep_their_tracks() -> None:
    history = TrackHistory(PredictionModel(), TICK_S)
    for k in range(6):
        history.observe({who: (0.1 * k * who, 0.0) for who in range(k * 20 + 1)})
    assert len(history.ids) == 101
    assert history.velocities()[0] == pytest.approx([0.0, 0.0])
    by_id = dict(zip(history.ids, history.velocities(), strict=True))
    assert by_id[20] == pytest.approx([20.0, 0.0])


def test_on_another_floor_a_track_begins_anew() -> None:
    history = TrackHistory(PredictionModel(), TICK_S)
    for k in range(6):
        history.observe({"p": (0.1 * k, 0.0, 0.0)})
    history.observe({"p": (0.6, 0.0, 3.3)})
    assert history.heights.tolist() == [3.3]
    assert history.velocities().tolist() == [[0.0, 0.0]]


def test_up_a_flight_of_stairs_a_track_goes_on() -> None:
    history = TrackHistory(PredictionModel(), TICK_S)
    for k in range(20):
        history.observe({"p": (0.1 * k, 0.0, 0.18 * (k // 3))})
    assert history.velocities()[0] == pytest.approx([1.0, 0.0])


def test_each_is_predicted_on_its_own_floor() -> None:
    """A wall on the ground hinders people who walk below, not those who walk above."""
    wall = Wall(start=(5.0, 0.0), end=(5.0, 8.0), height_m=2.5)
    grid = grid_of(8.0, [box(0.0, 0.0, 8.0, 8.0, 0.3, offset_m=3.0)], [wall])
    history = TrackHistory(PredictionModel(), TICK_S)
    for k in range(10):
        x = 3.0 + 0.1 * k
        history.observe({"above": (x, 4.0, 3.3), "below": (x, 4.0, 0.0)})
    prediction = history.predict(grid, 12, 0.2)
    above, below = prediction.means[:, :, 0]
    assert prediction.heights[0] == pytest.approx([3.3] * 13)
    assert prediction.heights[1] == pytest.approx([0.0] * 13)
    assert below.max() <= 5.0 - 0.15 + 1e-6
    assert above[-1] == pytest.approx(3.9 + 12 * 0.2, abs=1e-6)


def test_people_are_expected_to_go_up_stairs_and_to_stay_off_ledges() -> None:
    house = storeyed()
    grid = LayeredGrid.from_scene(house)
    history = TrackHistory(PredictionModel(), TICK_S)
    for k in range(20):
        x = STAIRS_FROM - 0.5 + 0.13 * k
        up = (x, 6.0, grid.floor_at((x, 6.0), 0.18 * k))
        history.observe({"ledge": (10.0 - 0.05 * k, 2.0, UPPER_M), "up": up})
    prediction = history.predict(grid, 24, 0.2)
    assert prediction.means[0, :, 0].min() >= SLAB_FROM + 0.15 - 1e-6
    assert prediction.heights[0] == pytest.approx([UPPER_M] * 25)
    rises = np.diff(prediction.heights[1])
    assert (rises >= -1e-6).all()
    assert rises.max() <= 0.4
    assert prediction.heights[1, -1] == pytest.approx(UPPER_M, abs=1e-3)


@given(st.floats(-2.0, 14.0), st.floats(-2.0, 14.0), st.floats(-2.0, 2.0), st.floats(-2.0, 2.0))
@holds(40, 10)
def test_means_are_what_walking_slice_by_slice_comes_to(x, y, vx, vy) -> None:
    """Also of those who come from outside the bounds."""
    walls = (((5.0, 2.0), (5.0, 9.0)), ((5.0, 6.0), (9.0, 7.0)))
    grid = open_grid(12.0, walls)
    history = TrackHistory(PredictionModel(), TICK_S)
    for k in range(5):
        history.observe({"p": (x + vx * k * TICK_S, y + vy * k * TICK_S)})
    prediction = history.predict(grid, 18, 0.2)
    place, height = prediction.means[0, :1], np.zeros(1)
    step = 0.2 * history.velocities()
    for k in range(1, 19):
        place, height = grid.walk(place, height, step, PredictionModel().wall_clearance_m)
        assert prediction.means[0, k] == pytest.approx(place[0], abs=1e-9)


@given(st.lists(st.sets(st.integers(0, 12)), min_size=2, max_size=8), st.randoms())
@holds(30, 10)
def test_coming_and_going_leaves_everyone_in_order_with_their_own_past(present, random) -> None:
    """People who have been there all along are predicted as if nobody else had been."""
    history = TrackHistory(PredictionModel(), TICK_S)
    alone = TrackHistory(PredictionModel(), TICK_S)
    for k, ids in enumerate(present):
        at = {who: (who + 0.1 * k * who, 2.0) for who in random.sample(sorted(ids), len(ids))}
        history.observe({**at, "z": (0.2 * k, 1.0)})
        alone.observe({"z": (0.2 * k, 1.0)})
        assert history.ids == [*sorted(ids, key=str), "z"]
        assert history.positions[:, 0].tolist() == [at[who][0] for who in history.ids[:-1]] + [
            0.2 * k
        ]
        assert history.velocities()[-1].tolist() == alone.velocities()[0].tolist()


def test_the_order_of_listing_does_not_matter() -> None:
    one, other = (TrackHistory(PredictionModel(), TICK_S) for _ in range(2))
    people = {7: (1.0, 2.0), "b": (3.0, 4.0), "a": (5.0, 6.0), 30: (0.5, 0.5)}
    one.observe(people)
    other.observe(dict(reversed(people.items())))
    assert one.ids == other.ids
    assert one.positions.tolist() == other.positions.tolist()


@pytest.mark.parametrize(
    "where", [(math.nan, 0.0), (0.0, math.inf), (1.0,), (1.0, 2.0, 0, 0), (0.0, 0.0, math.nan)]
)
def test_a_bad_position_changes_nothing(where) -> None:
    history = TrackHistory(PredictionModel(), TICK_S)
    history.observe({"a": (1.0, 1.0)})
    with pytest.raises(ValueError, match="'b'"):
        history.observe({"a": (2.0, 2.0), "b": where})
    assert history.ids == ["a"]
    assert history.positions.tolist() == [[1.0, 1.0]]


def test_places_come_with_heights_and_without() -> None:
    history = TrackHistory(PredictionModel(), TICK_S)
    history.observe({"a": (1.0, 2.0), "b": (3.0, 4.0, 5.0)})
    assert history.positions.tolist() == [[1.0, 2.0], [3.0, 4.0]]
    assert history.heights.tolist() == [0.0, 5.0]
    with pytest.raises(TypeError):
        history.observe({"a": 1.0, "b": 2.0})  # type: ignore[dict-item]
    assert history.positions.tolist() == [[1.0, 2.0], [3.0, 4.0]]


def test_nothing_is_saved_of_somebody_whose_row_another_has() -> None:
    """Two histories of one present, one of which knew somebody else before, are equal bytes."""
    histories = [TrackHistory(PredictionModel(), TICK_S) for _ in range(2)]
    for k in range(7):
        histories[0].observe({"gone": (0.1 * k, 5.0, 4.0)})
        histories[1].observe({})
    for history in histories:
        history.observe({})
        history.observe({"p": (1.0, 2.0, 0.5)})
    one, other = (history.save() for history in histories)
    for name in one:
        assert np.array_equal(one[name], other[name]), name
