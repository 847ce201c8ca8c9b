"""Whether rings cross themselves: for few corners and for many, the same pair of edges."""

import math

from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning.scene.rings import (
    _crossing_edges_of_few,
    _crossing_edges_of_many,
    crossing_edges,
)

GRID = st.integers(-3, 3).map(float)
ANYWHERE = st.floats(-1e6, 1e6)
CORNERS = st.one_of(st.tuples(GRID, GRID), st.tuples(ANYWHERE, ANYWHERE))


@given(st.lists(CORNERS, min_size=3, max_size=9).map(tuple))
def test_few_corners_are_judged_as_many_are(ring: tuple[tuple[float, float], ...]) -> None:
    assert _crossing_edges_of_few(ring) == _crossing_edges_of_many(ring)


def test_the_first_edges_that_meet_are_named_at_any_size() -> None:
    for n in (8, 9, 40):
        ring = tuple(
            (math.cos(2.0 * math.pi * k / n), math.sin(2.0 * math.pi * k / n)) for k in range(n)
        )
        assert crossing_edges(ring) is None
        swapped = (*ring[:3], ring[4], ring[3], *ring[5:])
        assert crossing_edges(swapped) == (2, 4)
