"""The table of agents: rows come and go, and what is saved comes back the same."""

import json

import numpy as np
import pytest

from esplanade.planning import PARAMETERS, AgentTable, SavedAgentsError
from esplanade.planning.agents.agents import WAITING

SLICES = 4


def parameters(radius_m: float = 0.25):
    row = np.zeros((), dtype=PARAMETERS)
    row["radius_m"] = radius_m
    return row


def add(table, agent_id, place, row) -> None:
    sevens = np.full(1, 7)
    table.add(
        [agent_id],
        np.array([place]),
        row[None],
        cells=sevens,
        layers=np.ones(1, dtype=np.int64),
        headings=np.full(1, 0.3),
    )


def table_of(*ids) -> AgentTable:
    table = AgentTable(SLICES)
    for number, agent_id in enumerate(ids):
        add(table, agent_id, (float(number), 2.0, 0.5), parameters(0.2 + 0.1 * number))
    return table


def test_a_new_agent_stands_where_it_was_put() -> None:
    table = table_of("a", "b")
    agents, row = table.agents, table.row("b")
    assert agents.positions[row].tolist() == [1.0, 2.0]
    assert agents.goals[row].tolist() == [1.0, 2.0]
    assert (agents.cells[row], agents.layers[row], agents.heights[row]) == (7, 1, 0.5)
    assert (agents.headings[row], agents.reasons[row]) == (0.3, WAITING)
    assert agents.planned[row].tolist() == [[1.0, 2.0, 0.5]] * (SLICES + 1)
    assert agents.potential_rows[row] == -1
    assert not agents.velocities[row].any()
    assert np.isnan(agents.left_m[row])
    assert table.wanted(row) is None
    assert table.points_at(row) is None


def test_the_last_row_takes_no_ones_place_when_an_agent_leaves() -> None:
    table = table_of("a", "b", "c")
    before = table.version
    table.trips.wanted[2] = 3.0, 4.0, 5.0
    table.remove(["b"])
    assert table.version > before
    assert table.ids == ["a", "c"]
    assert table.row("c") == 1
    assert table.agents.positions[1].tolist() == [2.0, 2.0]
    assert table.agents.parameters["radius_m"].tolist() == pytest.approx([0.2, 0.4])
    assert table.wanted(1) == (3.0, 4.0, 5.0)
    assert "b" not in table
    with pytest.raises(KeyError, match="no actor 'b'"):
        table.row("b")
    with pytest.raises(ValueError, match="already is an actor 'a'"):
        add(table, "a", (0.0, 0.0, 0.0), parameters())


def test_every_column_has_a_row_for_each_agent() -> None:
    table = table_of("a", "b", "c")
    for columns in (table.agents, table.trips):
        assert {len(column) for column in columns} == {3}


def test_what_was_saved_comes_back() -> None:
    table = table_of("a", 7)
    rng = np.random.default_rng(1)
    for column in (*table.agents, *table.trips):
        if column.dtype == np.float64:
            column[:] = rng.normal(size=column.shape)
    header, arrays = table.save()
    header = json.loads(json.dumps(header))
    saved = {name: column.copy() for name, column in arrays.items()}
    table.agents.positions[:] = 0.0
    loaded = AgentTable.load(header, arrays)
    assert loaded.ids == ["a", 7]
    again_header, again = loaded.save()
    assert again_header == header
    assert again.keys() == saved.keys()
    for name, column in saved.items():
        assert again[name].dtype == column.dtype
        np.testing.assert_array_equal(again[name], column)


def test_an_id_that_json_would_change_is_not_saved() -> None:
    with pytest.raises(TypeError, match=r"saved as ids: \(1, 2\)"):
        table_of((1, 2)).save()


def without(mapping, name):
    return {key: value for key, value in mapping.items() if key != name}


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda h, a: ({**h, "version": 1}, a), "of version 1, this program reads 4"),
        (lambda h, a: ({**h, "format": "x"}, a), "no saved agents: format is 'x'"),
        (lambda h, a: ({**h, "slices": 0}, a), "slices of saved agents"),
        (lambda h, a: ({**h, "ids": ["a", "a"]}, a), "occur twice"),
        (lambda h, a: ({**h, "ids": "ab"}, a), "must be a list"),
        (lambda h, a: (h, without(a, "goals")), "lack the column 'goals'"),
        (lambda h, a: (h, {**a, "mood": a["goals"]}), "'mood' that is not known"),
        (lambda h, a: (h, {**a, "goals": a["goals"][:1]}), r"'goals' .* \(2, 2\), got .* \(1, 2\)"),
        (lambda h, a: (h, {**a, "ages": a["left_m"]}), "'ages' of saved agents must be int64"),
    ],
)
def test_a_fault_in_what_was_saved_is_named(spoil, message) -> None:
    with pytest.raises(SavedAgentsError, match=message):
        AgentTable.load(*spoil(*table_of("a", "b").save()))
