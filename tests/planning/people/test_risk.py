"""Risk against the direct sum of eq. (5), and what must always hold of it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning import GAUSSIAN, PEOPLE, RiskField, RiskModel, Spread
from esplanade.planning.people._risk_kernels import index_people
from esplanade.planning.people.risk import EVERYWHERE, SLACK_M, radial_tables, sigma_points
from tests.naive import risk as naive
from tests.planning.worlds import (
    UPPER_M,
    field_of,
    holds,
    open_grid,
    points,
    scaled,
    two_floors,
    walking,
)

CLOSING_WEIGHT = 0.2

speeds = st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0))
people = st.lists(st.tuples(points(1.0, 7.0), speeds), min_size=1, max_size=4)


@pytest.mark.parametrize("spread", [GAUSSIAN, PEOPLE])
@given(people, st.integers(0, 6), points(0.0, 8.0), speeds)
@holds(60, 6)
def test_the_field_is_the_direct_sum(spread, crowd, k, here, velocity) -> None:
    model = RiskModel()
    prediction = walking([p for p, _ in crowd], [v for _, v in crowd], slices=6)
    field = RiskField(open_grid(8.0), model, 6, spread)
    field.fill(prediction)
    found = field.at(k, [here], [0], [velocity], CLOSING_WEIGHT)[0]
    here, velocity = np.array(here), np.array(velocity)
    direct = naive.risk(model, spread, prediction, k, 0, here, velocity, CLOSING_WEIGHT)
    # The tables are linear between distances and read along one axis of the grid of sigma points.
    assert found == pytest.approx(direct, abs=0.05 * len(crowd))


def test_on_the_whole_the_field_is_close_to_the_direct_sum() -> None:
    grid = open_grid(8.0)
    rng = np.random.default_rng(1)
    prediction = walking(rng.uniform(1.0, 7.0, (6, 2)), rng.normal(0.0, 1.0, (6, 2)), slices=12)
    field = field_of(grid, prediction, slices=12)
    errors = []
    for _ in range(scaled(200, 40)):
        here = rng.uniform(0.0, 8.0, 2)
        v = rng.normal(0.0, 1.0, 2)
        found = field.at(6, [here], [0], [v], CLOSING_WEIGHT)[0]
        direct = naive.risk(field.model, PEOPLE, prediction, 6, 0, here, v, CLOSING_WEIGHT)
        errors.append(found - direct)
    assert np.sqrt(np.mean(np.square(errors))) < 0.015
    assert abs(np.mean(errors)) < 0.005


@given(people, points(0.0, 8.0), speeds, st.floats(0.0, 5.0), st.integers(0, 4))
@holds(100, 10)
def test_risk_is_never_negative_and_bounded_by_the_number_of_people(
    crowd, here, velocity, weight, k
) -> None:
    prediction = walking([p for p, _ in crowd], [v for _, v in crowd], slices=4)
    field = field_of(open_grid(8.0), prediction, slices=4)
    risk = field.at(k, [here], [0], [velocity], weight)[0]
    closing = sum(np.hypot(*np.subtract(v, velocity)) for _, v in crowd)
    assert 0.0 <= risk <= len(crowd) + weight * closing + 1e-4


@given(people)
@holds(20, 4)
def test_where_nobody_can_be_there_is_no_risk(crowd) -> None:
    prediction = walking([p for p, _ in crowd], [v for _, v in crowd], slices=2)
    field = field_of(open_grid(40.0), prediction, slices=2)
    assert field.at(1, [(30.0, 30.0)], [0], [(1.0, 1.0)], 1.0)[0] == 0.0


def test_nearer_is_riskier() -> None:
    field = field_of(open_grid(8.0), walking([(4.125, 4.125)], [(0.0, 0.0)]))
    row = [(4.125 + 0.25 * k, 4.125) for k in range(8)]
    risks = field.at(4, row, [0] * 8, [(0.0, 0.0)] * 8, 1.0)
    assert (np.diff(risks) <= 0.0).all()
    assert risks[0] > 10.0 * risks[5]


def test_closing_is_riskier_and_drawing_apart_is_not_rewarded() -> None:
    field = field_of(open_grid(8.0), walking([(4.125, 4.125)], [(0.0, 0.0)]))
    here = [(4.875, 4.125)] * 4
    closing, still, apart, fast = field.at(
        2, here, [0] * 4, [(-1.0, 0.0), (0.0, 0.0), (1.0, 0.0), (-2.0, 0.0)], 1.0
    )
    assert fast > closing > still
    assert still == pytest.approx(apart)


def test_the_shared_form_bounds_the_sum_of_closing_speeds_not_each() -> None:
    """One draws near and one as much apart: the sum is nothing, person by person it is not."""
    both = walking([(3.125, 4.125), (5.125, 4.125)], [(0.0, 0.0), (0.0, 0.0)])
    one = walking([(5.125, 4.125)], [(0.0, 0.0)])
    here, velocity = [(4.125, 4.125)], [(1.0, 0.0)]
    grid = open_grid(8.0)
    shared = field_of(grid, both).at(5, here, [0], velocity, 1.0)[0]
    proximity = field_of(grid, both).at(5, here, [0], velocity, 0.0)[0]
    alone = field_of(grid, one)
    closing = alone.at(5, here, [0], velocity, 1.0)[0] - alone.at(5, here, [0], velocity, 0.0)[0]
    assert shared == pytest.approx(proximity, abs=1e-6)
    assert closing > 0.02


@pytest.mark.parametrize("turn", [1, 2, 3])
def test_risk_turns_with_the_world(turn) -> None:
    rotation = np.linalg.matrix_power(np.array([[0.0, -1.0], [1.0, 0.0]]), turn)
    rng = np.random.default_rng(turn)
    where, way = rng.uniform(-3.0, 3.0, (5, 2)), rng.normal(0.0, 1.0, (5, 2))
    here, velocity = rng.uniform(-3.0, 3.0, (20, 2)), rng.normal(0.0, 1.0, (20, 2))
    grid = open_grid(8.0)
    risks = [
        field_of(grid, walking(4.0 + where @ r.T, way @ r.T)).at(
            3, 4.0 + here @ r.T, [0] * 20, velocity @ r.T, 0.5
        )
        for r in (np.eye(2), rotation)
    ]
    assert risks[0] == pytest.approx(risks[1], abs=1e-4)


def test_people_on_another_floor_do_not_matter() -> None:
    grid = two_floors()
    prediction = walking([(4.0, 4.0)], [(0.0, 0.0)])
    for feet_m, here_m, there_m in ((0.0, 0.0, UPPER_M), (UPPER_M, UPPER_M, 0.0)):
        prediction.heights[:] = feet_m
        field = field_of(grid, prediction)
        assert field.at(0, [(4.0, 4.0)], [here_m], [(0.0, 0.0)], 1.0)[0] > 0.9
        assert field.at(0, [(4.0, 4.0)], [there_m], [(0.0, 0.0)], 1.0)[0] == 0.0


def test_each_floor_has_the_risk_of_its_own_people() -> None:
    grid = two_floors()
    rng = np.random.default_rng(4)
    where, way = rng.uniform(1.0, 7.0, (6, 2)), rng.normal(0.0, 1.0, (6, 2))
    both = walking(where, way, slices=6)
    both.heights[3:] = UPPER_M
    shared = field_of(grid, both, slices=6)
    here, v = rng.uniform(0.0, 8.0, (30, 2)), rng.normal(0.0, 1.0, (30, 2))
    for part, z_m in ((slice(0, 3), 0.0), (slice(3, 6), UPPER_M)):
        alone = field_of(open_grid(8.0), walking(where[part], way[part], slices=6), slices=6)
        found = shared.at(4, here, [z_m] * 30, v, CLOSING_WEIGHT)
        assert found == pytest.approx(alone.at(4, here, [0] * 30, v, CLOSING_WEIGHT), abs=1e-6)
        assert found.max() > 0.05
    shared.fill(walking([], [], slices=6))
    assert not shared.at(4, here, [0.0] * 30, v, CLOSING_WEIGHT).any()


def test_who_is_on_the_stairs_counts_where_bodies_overlap() -> None:
    """Half-way up, the feet are within a body's height of both floors."""
    grid = two_floors()
    prediction = walking([(4.0, 4.0)], [(0.0, 0.0)])
    for feet_m, below, above in ((1.65, True, True), (1.0, True, False), (2.4, False, True)):
        prediction.heights[:] = feet_m
        field = field_of(grid, prediction)
        risks = field.at(0, [(4.0, 4.0)] * 2, [0.0, UPPER_M], [(0.0, 0.0)] * 2, 1.0)
        assert (risks > 0.9).tolist() == [below, above]
        assert ((risks == 0.0) == [not below, not above]).all()


def test_filling_again_leaves_nothing_of_before() -> None:
    grid = open_grid(8.0)
    everywhere = np.stack(np.meshgrid(*[np.arange(0.1, 8.0, 0.25)] * 2), axis=-1).reshape(-1, 2)
    level = [0.0] * len(everywhere)
    field = field_of(grid, walking(np.full((40, 2), 4.0), np.ones((40, 2)), slices=4), slices=4)
    assert field.at(4, everywhere, level, 0 * everywhere, 0.0).max() > 10.0
    field.fill(walking([(2.0, 2.0)], [(0.0, 0.0)], slices=4))
    fresh = field_of(grid, walking([(2.0, 2.0)], [(0.0, 0.0)], slices=4), slices=4)
    for k in range(5):
        here = (k, everywhere, level, 0 * everywhere, 0.0)
        assert np.array_equal(field.at(*here), fresh.at(*here))
        assert field.at(*here).any()
    field.fill(walking([], [], slices=4))
    assert not field.at(4, everywhere, level, 0 * everywhere, 0.0).any()


def test_people_outside_the_bounds_are_no_trouble() -> None:
    field = field_of(open_grid(8.0), walking([(-50.0, 3.0), (8.3, 4.0)], [(1.0, 0.0)] * 2))
    risks = field.at(18, [(0.1, 3.0), (7.9, 4.0)], [0] * 2, [(0.0, 0.0)] * 2, 1.0)
    assert np.isfinite(risks).all()
    assert field.at(0, [(7.9, 4.0)], [0], [(0.0, 0.0)], 0.0)[0] > 0.1


def test_how_work_is_shared_out_does_not_matter() -> None:
    grid = open_grid(8.0)
    prediction = walking([(2.0, 2.0), (5.0, 4.0)], [(1.0, 0.0), (0.0, 1.0)], slices=5)
    whole = field_of(grid, prediction, slices=5)
    parts = RiskField(grid, RiskModel(), 5, PEOPLE)
    parts.make_room(prediction, SLACK_M)
    for k in (2, 0, 1):
        index_people(prediction, 5, EVERYWHERE, k, 3, parts.arrays)
    for ours, theirs in zip(whole.arrays[1:5], parts.arrays[1:5], strict=True):
        assert np.array_equal(ours, theirs)


@given(people)
@holds(20, 4)
def test_one_bucket_for_all_gives_the_same_risk(crowd) -> None:
    grid = open_grid(8.0)
    prediction = walking([p for p, _ in crowd], [v for _, v in crowd], slices=5)
    many, one = field_of(grid, prediction, slices=5), RiskField(grid, RiskModel(), 5, PEOPLE)
    one.make_room(prediction, SLACK_M)
    one.arrays = one.arrays._replace(nx=1, ny=1)
    one.fill(prediction)
    assert many.arrays.nx > 1
    everywhere = np.stack(np.meshgrid(*[np.arange(0.1, 8.0, 0.5)] * 2), axis=-1).reshape(-1, 2)
    for k in range(6):
        here = (k, everywhere, np.zeros(len(everywhere)), 0 * everywhere + 0.5, CLOSING_WEIGHT)
        assert np.array_equal(one.at(*here), many.at(*here))


@given(people, points(1.0, 7.0), points(1.0, 7.0))
@holds(40, 6)
def test_for_those_in_a_box_only_they_are_left_out_whom_nobody_gets_near(crowd, a, b) -> None:
    grid = open_grid(40.0)
    shifted = [(x * 5.0, y * 5.0) for (x, y), _ in crowd]
    prediction = walking(shifted, [v for _, v in crowd], slices=6)
    whole, part = RiskField(grid, RiskModel(), 6, PEOPLE), RiskField(grid, RiskModel(), 6, PEOPLE)
    whole.fill(prediction)
    box = (min(a[0], b[0]), min(a[1], b[1]), max(a[0], b[0]), max(a[1], b[1]))
    part.fill(prediction, around=box)
    step_m = whole.arrays.slack_m / 2.0
    for k in range(7):
        beyond = k * step_m * np.array([-1.0, -1.0, 1.0, 1.0])
        x0, y0, x1, y1 = np.clip(np.array(box) + beyond, 0.0, 40.0)
        here = [(x, y) for x in np.linspace(x0, x1, 7) for y in np.linspace(y0, y1, 7)]
        asked = (k, here, [0.0] * 49, [(0.5, 0.2)] * 49, CLOSING_WEIGHT)
        assert np.array_equal(whole.at(*asked), part.at(*asked))
    assert part.arrays.starts[:, -1].sum() <= whole.arrays.starts[:, -1].sum()


def test_sigma_points_weigh_one_and_centre_on_the_mean() -> None:
    offsets, weights = sigma_points()
    assert weights.sum() == pytest.approx(1.0)
    assert weights @ offsets == pytest.approx([0.0, 0.0], abs=1e-12)
    listed = sorted(naive.sigma_grid())
    assert sorted((*o, w) for o, w in zip(offsets, weights, strict=True)) == pytest.approx(
        np.array(listed)
    )


@pytest.mark.parametrize("spread", [GAUSSIAN, PEOPLE, Spread((0.1, 3.0), (0.5, 0.5))])
def test_tables_are_bounded_and_end_in_nothing(spread) -> None:
    tables = radial_tables(RiskModel(), (0.6,), spread)
    distances = np.sqrt(np.arange(tables.values.shape[2]) * tables.squared_step_m2)
    near, toward = tables.values[0, ..., 0], tables.values[0, ..., 1]
    for table in (near, toward * distances):
        assert table.min() >= 0.0
        assert table.max() <= 1.0 + 1e-6
        assert not table[:, -1].any()
    beyond = distances > tables.reaches[:, None]
    assert near[beyond].max() < 2e-3
    assert (toward * distances)[beyond].max() < 2e-3


def test_tables_of_a_mixture_are_those_of_its_parts_by_weight() -> None:
    exact = RiskModel(sway_m=0.0)
    mixed = radial_tables(exact, (0.6,), Spread((1.0, 2.0), (0.75, 0.25)))
    one = radial_tables(exact, (0.6,))
    rows, columns = np.arange(one.values.shape[1] // 2), one.values.shape[2]
    near = one.values[0, ..., 0]
    expected = 0.75 * near[rows] + 0.25 * near[2 * rows]
    np.testing.assert_allclose(mixed.values[0, rows, :columns, 0], expected, atol=1e-5)


def test_what_seldom_happens_reaches_further() -> None:
    even, heavy = (radial_tables(RiskModel(), (0.6,), spread) for spread in (GAUSSIAN, PEOPLE))
    assert (heavy.reaches >= even.reaches).all()
    assert heavy.reaches[10] > even.reaches[10]


def test_the_model_has_the_two_properties_of_eq_5() -> None:
    model = RiskModel()
    distances = np.linspace(0.0, 3.0, 301)
    for term in (model.near(distances, 0.6), model.toward(distances, 0.6)):
        assert (np.diff(term) <= 0.0).all()
        assert term[0] == 1.0
        assert not term[distances > 0.6 + model.influence_m].any()


def test_what_does_not_fit_is_refused() -> None:
    field = field_of(open_grid(8.0), walking([(4.0, 4.0)], [(0.0, 0.0)]))
    with pytest.raises(ValueError, match=r"the field has [0-9]+ slices, the prediction 5"):
        field.fill(walking([(4.0, 4.0)], [(0.0, 0.0)], slices=4))
    with pytest.raises(ValueError, match=r"slices are 0\.\.[0-9]+"):
        field.at(25, [(4.0, 4.0)], [0], [(0.0, 0.0)], 1.0)
