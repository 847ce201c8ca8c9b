"""The order of priority, against that of looking at everyone."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning.agents._priority_kernels import empty_jams
from tests.naive import reservations as naive
from tests.planning.worlds import holds, open_grid, reserved

SLICES = 3


def _jammed(rng, actors):
    """Two crowds that want against each other, some held up; ways left, some about there."""
    places = rng.uniform(1.0, 15.0, (actors, 2))
    paths = np.repeat(places[:, None], SLICES + 1, axis=1)
    heights = rng.choice([0.0, 3.0], actors, p=[0.8, 0.2])
    r = reserved(open_grid(16.0), paths, [0.25] * actors, range(actors), heights=heights)
    turns = rng.normal(0.0, 0.7, actors) + np.pi * (rng.random(actors) < 0.5)
    r.courses[:] = np.column_stack([np.cos(turns), np.sin(turns)])
    r.held_up[:] = rng.random(actors) < 0.7
    return r, np.where(rng.random(actors) < 0.1, np.inf, rng.uniform(1.0, 30.0, actors))


@given(st.integers(0, 10_000), st.sampled_from([5, 30, 60]))
@holds(60, 10)
def test_jams_are_emptied_in_the_order_of_looking_at_everyone(seed, actors) -> None:
    r, left_m = _jammed(np.random.default_rng(seed), actors)
    expected = naive.jam_order(r, left_m.tolist())
    empty_jams(left_m, r)
    assert left_m == pytest.approx(expected, abs=1e-5)


def test_the_order_in_a_jam_does_not_depend_on_the_order_of_actors() -> None:
    r, left_m = _jammed(np.random.default_rng(3), 60)
    turned = r._replace(**{n: getattr(r, n)[::-1] for n in ("paths", "heights", "courses")})
    turned = turned._replace(
        **{n: np.ascontiguousarray(getattr(turned, n)) for n in ("paths", "heights", "courses")},
        held_up=r.held_up[::-1].copy(),
    )
    other = left_m[::-1].copy()
    empty_jams(left_m, r)
    empty_jams(other, turned)
    assert (left_m < 0.0).any(), "somebody has come through"
    assert (other[::-1] == left_m).all()
