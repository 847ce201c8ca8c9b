"""Straight stretches: as legal as the way they replace, and never longer."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning import Body, LayeredPath, PathStatus
from esplanade.planning.routes._straightening_kernels import Line, trace
from esplanade.planning.routes.stable_bfp import stable_bfp
from esplanade.planning.routes.straightening import headings, line_of_cells, straighten
from esplanade.planning.traversal._anchor_kernels import anchor_of
from esplanade.planning.traversal.stability import Stability
from esplanade.planning.traversal.wavefront import spread_wave
from tests.planning.storeys import bodies, box, cluttered, grid_of, traversability, walk_through
from tests.planning.worlds import holds


def length(xy) -> float:
    return sum(math.dist(p, q) for p, q in pairwise(xy))


def found_line(feet, start, goal):
    """The way over cells between two, or None."""
    path = stable_bfp(feet, spread_wave(feet, goal), start, goal)
    if not len(path.cells):
        return None
    return line_of_cells(
        feet,
        path.cells,
        path.counts,
        anchor(feet, start),
        anchor(feet, goal),
    )


def traced(feet, a, b):
    """The straight way between two cells, or None if it is not legal."""
    line = Line(
        np.array([anchor(feet, a), anchor(feet, b)]),
        np.array([a, b], dtype=np.int32),
        np.zeros(2, dtype=np.int32),
    )
    out = Line(np.zeros((99, 2)), np.zeros(99, dtype=np.int32), np.zeros(99, dtype=np.int32))
    used = trace(feet, line, 0, 1, 0, out, 0)
    return None if used < 0 else (out.xy[:used], out.cells[:used], out.counts[:used])


def anchor(feet, cell):
    return anchor_of(feet.arrays, feet.near.first, feet.offsets, cell)


@given(cluttered(), bodies, st.integers(0, 10**6))
@holds(25, 4)
def test_a_straightened_way_is_walkable_and_no_longer(grid, body, pick) -> None:
    feet = traversability(grid, body)
    standing = np.flatnonzero(feet.classes)
    if not len(standing):
        return
    for start, goal in np.random.default_rng(pick).choice(standing, (4, 2)):
        before = found_line(feet, int(start), int(goal))
        if before is None:
            continue
        after = straighten(feet, before)
        assert length(after.xy) <= length(before.xy) + 1e-9
        assert after.xy[0] == pytest.approx(before.xy[0])
        assert after.xy[-1] == pytest.approx(before.xy[-1])
        points = np.column_stack([after.xy, feet.arrays.floors[after.cells].astype(float)])
        layers = feet.arrays.places["layer"][after.cells].astype(np.int64)
        path = LayeredPath(PathStatus.FOUND, points, layers, headings(after.xy))
        walk_through(path, grid, body)


@given(cluttered(), bodies, st.integers(0, 10**6))
@holds(25, 4)
def test_a_straight_way_crosses_the_cells_that_lie_under_it(grid, body, pick) -> None:
    feet = traversability(grid, body)
    standing = np.flatnonzero(feet.classes)
    if not len(standing):
        return
    for a, b in np.random.default_rng(pick).choice(standing, (20, 2)):
        found = traced(feet, int(a), int(b))
        if found is None:
            continue
        xy, cells, counts = found
        p, q = (
            np.array(anchor(feet, a)),
            np.array(anchor(feet, b)),
        )
        samples = p + np.linspace(0.0, 1.0, 4001)[:, None] * (q - p)
        crossed = {(int(y / 0.25), int(x / 0.25)) for x, y in samples if x % 0.25 and y % 0.25}
        places = [place[1:] for place in feet.arrays.places[[a, *cells]].tolist()]
        assert crossed <= set(places)
        count = 0
        for before, cell, reported in zip([a, *cells], cells, counts, strict=False):
            if cell != before:
                count = 0 if feet.classes[cell] == Stability.STABLE else count + 1
            assert reported == count < max(1, body.edge_cells)
        assert np.abs(np.cross(np.append(q - p, 0), np.c_[xy - p, 0 * xy[:, 0]])).max() < 1e-9


def test_in_the_open_the_way_becomes_one_straight_line() -> None:
    feet = traversability(grid_of(12.0), Body.adult())
    start, goal = (feet.arrays.places.tolist().index(p) for p in ((0, 3, 2), (0, 40, 20)))
    line = straighten(feet, found_line(feet, start, goal))
    assert length(line.xy) == pytest.approx(math.hypot(37 * 0.25, 18 * 0.25))
    assert np.ptp(headings(line.xy)) < 1e-9


def test_around_a_block_the_way_is_within_three_percent_of_the_shortest() -> None:
    block = [box(3.0, 0.0, 5.0, 5.0, 3.0)]
    feet = traversability(grid_of(8.0, block), Body.adult())
    start, goal = (feet.arrays.places.tolist().index(p) for p in ((0, 4, 4), (0, 4, 27)))
    line = straighten(feet, found_line(feet, start, goal))
    corners = [
        anchor(feet, start),
        (2.75, 5.25),
        (5.25, 5.25),
        anchor(feet, goal),
    ]
    assert length(corners) * 0.98 < length(line.xy) < length(corners) * 1.03


def test_headings_follow_the_way() -> None:
    xy = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [2.0, 2.0]])
    assert headings(xy) == pytest.approx([0.0, 0.0, math.pi / 4, math.pi / 2, math.pi / 2])
    assert headings(xy[:1]).tolist() == [0.0]
    assert len(headings(xy[:0])) == 0
