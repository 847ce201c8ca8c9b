"""The order of priority, against that of looking at everyone."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning.agents._priority_kernels import order_in_jams, put_in_order
from esplanade.planning.agents.priorities import Priorities, Turn
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
    turns = np.where(rng.random(actors) < 0.1, int(Turn.SETTLED), int(Turn.WALKS))
    return r, Priorities(turns, rng.uniform(1.0, 30.0, actors))


@given(st.integers(0, 10_000), st.sampled_from([5, 30, 60]))
@holds(60, 10)
def test_jams_are_emptied_in_the_order_of_looking_at_everyone(seed, actors) -> None:
    r, who = _jammed(np.random.default_rng(seed), actors)
    expected = naive.jam_order(r, who)
    order_in_jams(who, r)
    assert who.turns.tolist() == [turn for turn, _ in expected]
    assert who.keys_m == pytest.approx([key for _, key in expected], abs=1e-5)


def test_the_order_in_a_jam_does_not_depend_on_the_order_of_actors() -> None:
    r, who = _jammed(np.random.default_rng(3), 60)
    turned = r._replace(**{n: getattr(r, n)[::-1] for n in ("paths", "heights", "courses")})
    turned = turned._replace(
        **{n: np.ascontiguousarray(getattr(turned, n)) for n in ("paths", "heights", "courses")},
        held_up=r.held_up[::-1].copy(),
    )
    other = Priorities(who.turns[::-1].copy(), who.keys_m[::-1].copy())
    order_in_jams(who, r)
    order_in_jams(other, turned)
    assert (who.turns == Turn.LEAVES_JAM).any(), "somebody has come through"
    assert (other.turns[::-1] == who.turns).all()
    assert (other.keys_m[::-1] == who.keys_m).all()


@given(st.integers(0, 10_000))
@holds(60, 20)
def test_agents_go_by_turn_then_key_then_rank(seed) -> None:
    rng = np.random.default_rng(seed)
    who = Priorities(rng.integers(0, len(Turn), 40), rng.choice([-2.0, 0.0, 0.5, 7.0], 40))
    ranks, order = rng.permutation(40), np.empty(40, dtype=np.int64)
    put_in_order(who, ranks, order)
    assert order.tolist() == sorted(
        range(40), key=lambda a: (who.turns[a], who.keys_m[a], ranks[a])
    )
