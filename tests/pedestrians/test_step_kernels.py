"""The kernels do what their plain twin does, whoever is where."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from esplanade.pedestrians import SocialForce
from esplanade.pedestrians.compiled import _step_kernels as kernels
from esplanade.pedestrians.compiled._neighbour_kernels import (
    NEAREST,
    cells_of,
    find_nearest,
    sort_into_buckets,
)
from esplanade.pedestrians.compiled.records import State, Surroundings
from esplanade.pedestrians.paths import checked_walls, joined_paths, walls_passed
from tests.naive import reacting as naive
from tests.planning.worlds import holds

TICK_S = 0.1
MODEL = SocialForce()


def as_complex(place: np.ndarray) -> complex:
    return complex(*place)


@given(seed=st.integers(0, 2**32 - 1), people=st.integers(1, 24), actors=st.integers(0, 3))
@holds(60, 8)
def test_one_tick_is_that_of_the_plain_twin(seed: int, people: int, actors: int) -> None:
    rng = np.random.default_rng(seed)
    paths, first = [], []
    for _ in range(people):
        length = int(rng.integers(1, 9))
        start, pace = rng.uniform(-4, 4, 2), rng.uniform(-1.5, 1.5, 2) * rng.integers(0, 2)
        bends = np.cumsum(rng.normal(0, 0.03, (length, 2)), axis=0)
        paths.append(start + pace * TICK_S * np.arange(length)[:, None] + bends)
        first.append(int(4 - rng.integers(0, length)))
    walls = checked_walls(rng.uniform(-4, 4, (int(rng.integers(0, 4)), 4)))
    joined = joined_paths(paths, first)
    passes = walls_passed(joined, walls)
    now = State(
        np.zeros((people, 2)), np.zeros((people, 2)), np.zeros(people), np.zeros(people, np.bool_)
    )
    plain = []
    for k in range(people):
        here = paths[k][4 - first[k]]
        person = naive.Person([as_complex(p) for p in paths[k]], first[k], as_complex(here))
        person.own = float(4 - first[k])
        person.passes = set(np.flatnonzero(passes[k]).tolist())
        person.strength = float(rng.uniform(3, 6))
        if rng.random() < 0.6:
            person.place += complex(*rng.normal(0, 0.3, 2))
            person.deviation = complex(*rng.normal(0, 0.4, 2))
            person.own = max(0.0, person.own - float(rng.uniform(0, 3)))
            now.moved[k] = True
        now.places[k] = person.place.real, person.place.imag
        now.deviations[k] = person.deviation.real, person.deviation.imag
        now.own_ticks[k] = person.own
        plain.append(person)
    places, velocities = rng.uniform(-4, 4, (actors, 2)), rng.uniform(-1.5, 1.5, (actors, 2))
    wider_m = rng.uniform(0, 0.6, actors)
    stand_ins = rng.integers(-1, people, actors)
    around = Surroundings(
        np.column_stack([places, velocities, wider_m]),
        stand_ins,
        walls,
        passes,
        np.array([person.strength for person in plain]),
    )
    after = State(*(part.copy() for part in now))
    kernels.step(np.arange(people), 4, joined, now, after, around, MODEL.numbers(TICK_S))
    expected = naive.step(
        plain,
        [
            naive.Actor(
                as_complex(places[a]),
                as_complex(velocities[a]),
                0.25 + wider_m[a],
                plain[stand_ins[a]] if stand_ins[a] >= 0 else None,
            )
            for a in range(actors)
        ],
        [(complex(*wall[:2]), complex(*wall[2:])) for wall in walls],
        MODEL,
        4,
        TICK_S,
    )
    found = after.places[:, 0] + 1j * after.places[:, 1]
    np.testing.assert_allclose(found, [place for place, *_ in expected], atol=1e-9)
    found = after.deviations[:, 0] + 1j * after.deviations[:, 1]
    np.testing.assert_allclose(found, [deviation for _, deviation, _ in expected], atol=1e-8)
    np.testing.assert_allclose(after.own_ticks, [own for *_, own in expected], atol=1e-7)


@given(seed=st.integers(0, 2**32 - 1), bodies=st.integers(1, 80), spread_m=st.floats(0.1, 60.0))
@holds(60, 8)
def test_the_nearest_are_found_in_order(seed: int, bodies: int, spread_m: float) -> None:
    rng = np.random.default_rng(seed)
    places = np.round(rng.normal(0, spread_m, (bodies, 2)), 1)
    cells = cells_of(places, 8.0)
    order, begins = sort_into_buckets(cells)
    found, squares = np.empty(NEAREST, np.int64), np.empty(NEAREST)
    for body in range(bodies):
        count = find_nearest(body, places, cells, order, begins, 8.0, found, squares)
        away = ((places - places[body]) ** 2).sum(axis=1)
        near = [k for k in np.lexsort((np.arange(bodies), away)) if k != body and away[k] < 64.0]
        assert found[:count].tolist() == near[:NEAREST]
