"""Decisions made once more: the very same as in the tick, and what they are told to be made of."""

import math
from collections import Counter
from collections.abc import Iterator

import numpy as np
import pytest

from esplanade.actors import Navigator
from esplanade.actors.traces import COST_PARTS, PricedPath, Trace
from esplanade.actors.tracing import MOST_NODES, NotKeptError, Tracing
from esplanade.planning import SearchStatus
from tests.actors.worlds import BODY, TICK_S, along, navigator, plaza
from tests.planning.worlds import scaled

ACTORS = 6
WALKS = [along((10.0, 1.0 + k), (1.0, 9.0 - k)) for k in range(6)]


def crowded(threads: int = 1) -> Navigator:
    """Actors in two streams against each other, among people who cross."""
    made = navigator(plaza(), threads=threads)
    made.tracing.wanted = True
    for n in range(ACTORS):
        start, goal = (2.0, 10.0)[:: 1 if n % 2 else -1]
        made.add_actor(n, (start, 3.0 + n), (goal, 7.0), BODY)
    return made


def ticks(made: Navigator, number: int, first: int = 0) -> Iterator[int]:
    for k in range(first, first + number):
        made.observe({f"p{n}": walk(k * TICK_S) for n, walk in enumerate(WALKS)})
        made.advance()
        yield k


def traces(made: Navigator, number: int) -> Iterator[tuple[int, Trace]]:
    for _ in ticks(made, number):
        for actor in range(ACTORS):
            yield actor, made.trace(actor)


def paths_of(trace: Trace) -> list[PricedPath]:
    found = (trace.decided.taken, trace.decided.previous, trace.searched, trace.perturbed)
    return [path for path in found if path is not None]


@pytest.mark.parametrize("threads", [1, 2])
def test_deciding_once_more_leads_to_the_very_same(threads: int) -> None:
    made, winners = crowded(threads), Counter[str]()
    for actor, trace in traces(made, scaled(60, 4)):
        assert trace.exact
        zone, row = made._batch.zone, made.table.row(actor)
        places = trace.decided.taken.places
        assert np.array_equal(places[:, :2], zone.decisions.paths[row])
        assert trace.tree.expansions == zone.decisions.expansions[row]
        winners[trace.winner] += 1
    made.close()
    assert winners["first"] == ACTORS
    assert {"kept", "search"} <= winners.keys() or scaled(0, 1)


def test_looking_changes_nothing() -> None:
    looked, alone = crowded(), crowded()
    alone.tracing.wanted = False
    for _ in zip(ticks(looked, scaled(40, 3)), ticks(alone, scaled(40, 3)), strict=True):
        for actor in range(ACTORS):
            looked.trace(actor)
            looked.decided(actor)
    for ours, theirs in zip(looked.table.agents, alone.table.agents, strict=True):
        assert ours.tobytes() == theirs.tobytes()
    looked.close()
    alone.close()


def test_parts_of_a_cost_add_up_to_the_whole() -> None:
    made, some = crowded(), np.zeros(len(COST_PARTS))
    for _, trace in traces(made, scaled(40, 3)):
        for path in paths_of(trace):
            assert path.cost.shape == (len(COST_PARTS),)
            if math.isfinite(path.total_s):
                assert path.cost[:-1].sum() == pytest.approx(path.total_s, abs=1e-9)
                some += np.abs(path.cost)
    made.close()
    at = COST_PARTS.index
    assert (some[[at("time"), at("risk"), at("others"), at("turn")]] > 0.0).all()


def test_the_winner_is_better_by_what_is_told() -> None:
    made = crowded()
    for _, trace in traces(made, scaled(60, 3)):
        taken = trace.decided.taken
        if trace.winner == "search":
            assert trace.searched is not None
            assert trace.perturbed is not None
            assert np.array_equal(taken.places, trace.searched.places)
            assert taken.total_s < trace.perturbed.total_s - trace.hysteresis_s
        elif trace.winner in {"kept", "perturbation"}:
            assert trace.perturbed is not None
            assert trace.decided.previous is not None
            assert np.array_equal(taken.places, trace.perturbed.places)
            is_bent = not np.array_equal(taken.places, trace.decided.previous.places)
            assert is_bent == (trace.winner == "perturbation")
            if is_bent:
                assert taken.total_s < trace.decided.previous.total_s
        elif trace.winner == "forced":
            assert trace.decided.previous is not None
            assert not trace.decided.previous.legal
    made.close()


def test_a_tree_has_its_nodes_in_the_order_of_their_expansion() -> None:
    made = crowded()
    for actor, trace in traces(made, scaled(20, 2)):
        nodes, parents = trace.tree.nodes, trace.tree.nodes[:, 4].astype(int)
        order = nodes[:, 6]
        expanded = trace.tree.expansions
        assert sorted(order[order >= 0].tolist()) == list(range(expanded))
        assert trace.tree.budget == made.parameters(actor).max_expansions
        if len(nodes):
            assert parents[0] == -1
            assert nodes[0, 3] == nodes[0, 5] == 0.0
            assert (parents[1:] >= 0).all()
            # Steps of the followed path are nodes from the beginning.
            known = set(parents[1:][order[parents[1:]] < 0].tolist())
            assert len({nodes[n, 3] for n in known}) == len(known) <= made.plan.steps
            assert (parents[1:] < np.arange(1, len(nodes))).all()
            assert nodes[1:, 3] == pytest.approx(nodes[parents[1:], 3] + made.plan.step_s)
            assert (nodes[1:, 5] >= nodes[parents[1:], 5]).all()
        if trace.tree.status is SearchStatus.FOUND:
            assert nodes[:, 3].max() == pytest.approx(made.plan.steps * made.plan.step_s)
    made.close()


def test_a_large_tree_is_cut(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("esplanade.actors.tracing.MOST_NODES", 20)
    made = crowded()
    cut = [trace.tree for _, trace in traces(made, 2) if trace.tree.left_out]
    made.close()
    assert cut
    assert all(len(tree.nodes) == 20 < MOST_NODES for tree in cut)


def test_risk_around_an_actor_is_that_of_the_field() -> None:
    made = crowded()
    k = list(ticks(made, 12))[-1]
    risk = made.trace(0).risk
    assert risk.times_s == pytest.approx(np.arange(10) * 0.4)
    people = np.array([walk(k * TICK_S) for walk in WALKS])
    steps = risk.cell_m * (np.arange(risk.values.shape[1]) + 0.5)
    gx, gy = np.meshgrid(risk.origin_m[0] + steps, risk.origin_m[1] + steps)
    inside = (gx > 0.0) & (gx < 12.0) & (gy > 0.0) & (gy < 12.0)
    away = np.hypot(gx[..., None] - people[:, 0], gy[..., None] - people[:, 1]).min(axis=2)
    # People whom no actor can come near yet are in it too, since it is filled anew.
    assert (risk.values[0][inside & (away < 0.3)] > 0.5).all()
    assert (risk.values[0][away > 2.5] == 0.0).all()
    assert (risk.values[:, ~inside] == 0.0).all()
    made.close()


def test_what_was_not_kept_is_not_told() -> None:
    made = crowded()
    made.tracing.wanted = False
    for _ in ticks(made, 1):
        pass
    with pytest.raises(NotKeptError):
        made.trace(0)
    made.tracing.wanted = True
    for _ in ticks(made, 1, first=1):
        pass
    assert made.trace(0).exact
    made.remove_actor(3)  # rows are others from now on
    with pytest.raises(NotKeptError):
        made.decided(0)
    with pytest.raises(KeyError):
        made.trace(3)
    made.close()


def test_a_tick_that_was_undone_is_not_told() -> None:
    made = crowded()
    for _ in ticks(made, 1):
        pass
    undo = made.undo_point()
    for _ in ticks(made, 1, first=1):
        pass
    undo()
    assert isinstance(made.tracing, Tracing)
    with pytest.raises(NotKeptError):
        made.trace(0)
    made.close()
