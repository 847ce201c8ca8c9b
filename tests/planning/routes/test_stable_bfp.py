"""STABLE_BFP against trying every state."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning import Body
from esplanade.planning.routes.stable_bfp import stable_bfp
from esplanade.planning.traversal.stability import Stability
from esplanade.planning.traversal.wavefront import spread_toward, spread_wave
from tests.naive.floors import Floors, legal_ways
from tests.planning.storeys import bodies, box, cluttered, grid_of, traversability
from tests.planning.worlds import holds


def way_of(feet, cells) -> float:
    """Length in cells."""
    places = np.column_stack([feet.arrays.places[name][cells] for name in ("row", "column")])
    diagonal = (np.diff(places, axis=0) != 0).all(axis=1)
    return float(np.where(diagonal, 99 / 70, 1.0).sum())


def check(feet, path) -> None:
    """A path goes along steps, and never stays on edges for too long."""
    count = 0
    for a, b in zip(path.cells, path.cells[1:], strict=False):
        d = feet.arrays.links[a].tolist().index(b)
        assert feet.steps[a] >> d & 1
        assert feet.classes[b] != Stability.FORBIDDEN
        count = 0 if feet.classes[b] == Stability.STABLE else count + 1
        assert count < feet.edge_cells
    assert path.counts[-1] == count


@given(cluttered(), bodies, st.integers(1, 6), st.integers(0, 10**6))
@holds(25, 4)
def test_it_finds_the_shortest_legal_way_wherever_there_is_one(grid, body, most, pick) -> None:
    body = dataclasses.replace(body, edge_cells=most)
    feet = traversability(grid, body)
    standing = np.flatnonzero(feet.classes)
    if not len(standing):
        return
    random = np.random.default_rng(pick)
    steps = Floors(grid.layered, grid.barriers, body).steps()
    for start in random.choice(standing, 3):
        legal = legal_ways(steps, feet.classes, int(start), most)
        for goal in random.choice(standing, 6):
            path = stable_bfp(feet, spread_wave(feet, goal), start, goal)
            assert bool(len(path.cells)) == (int(goal) in legal)
            if len(path.cells):
                check(feet, path)
                assert way_of(feet, path.cells) == pytest.approx(legal[int(goal)])
                shortest = spread_wave(feet, goal)[start]
                for longer in (1.0, 1.2, 1.5, math.inf):
                    left = spread_toward(feet, goal, start, longer)
                    found = stable_bfp(feet, left, start, goal, longer)
                    if round(70 * legal[int(goal)]) > longer * float(shortest):
                        assert not len(found.cells)
                    elif longer > 1.0:
                        assert len(found.cells)
                    if len(found.cells):
                        check(feet, found)
                        assert way_of(feet, found.cells) == pytest.approx(legal[int(goal)])


def along_a_kerb(length_cells: int) -> tuple[Floors, object, int, int]:
    """A corridor so narrow that all of it is edge: a kerb along its middle."""
    side = 6.0
    x1 = 1.0 + 0.25 * length_cells
    walls = [box(1.0, 0.0, x1, 2.5, 3.0), box(1.0, 3.5, x1, 6.0, 3.0)]
    grid = grid_of(side, [*walls, box(1.0, 3.0, x1, 3.5, 0.25)])
    body = Body(edge_cells=9)
    feet = traversability(grid, body)
    cells = Floors(grid.layered, grid.barriers, body).cells
    return feet, cells[0, 11, 1], cells[0, 11, 22]


@pytest.mark.parametrize(("cells", "passes"), [(8, True), (9, False)])
def test_fewer_than_m_cells_in_a_row_may_lie_on_edges(cells, passes) -> None:
    """The kerb is not felt before and behind it, from the middle of the way: 8 are below M = 9."""
    feet, start, goal = along_a_kerb(cells)
    path = stable_bfp(feet, spread_wave(feet, goal), start, goal)
    assert bool(len(path.cells)) == passes
    if passes:
        assert path.counts.max() == 8


def test_who_sets_out_on_an_edge_counts_from_there() -> None:
    feet, start, goal = along_a_kerb(12)
    path = stable_bfp(feet, spread_wave(feet, goal), start, goal)
    assert not len(path.cells)
    row = feet.arrays.places["row"][start]
    cells = {tuple(place): cell for cell, place in enumerate(feet.arrays.places.tolist())}
    amid = cells[0, int(row), 10]
    assert feet.classes[amid] == Stability.UNSTABLE
    out = stable_bfp(feet, spread_wave(feet, goal), amid, goal)
    assert out.counts[0] == 0
    assert not len(out.cells) or out.counts.max() < 9
    back = stable_bfp(feet, spread_wave(feet, start), amid, start)
    assert len(back.cells)
    check(feet, back)


def test_in_the_open_only_the_way_itself_is_looked_at() -> None:
    feet = traversability(grid_of(16.0), Body.adult())
    cells = {tuple(place): cell for cell, place in enumerate(feet.arrays.places.tolist())}
    start, goal = cells[0, 5, 3], cells[0, 40, 60]
    path = stable_bfp(feet, spread_wave(feet, goal), start, goal)
    assert path.expansions == len(path.cells) - 1
