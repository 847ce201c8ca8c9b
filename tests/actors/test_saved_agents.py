"""Saved actors that cannot be are refused by name, and those that are there stay."""

from typing import Any

import numpy as np
import pytest

from esplanade.actors import Navigator
from esplanade.planning import PARAMETERS, SavedAgentsError
from tests.actors.worlds import BODY, navigator, plaza

DISC = [4.0, 4.0, 0.0, 0.5]


def walking(*ids: str) -> Navigator:
    nav = navigator(plaza())
    for k, actor_id in enumerate(ids):
        nav.add_actor(actor_id, (2.0 + k, 3.0), (10.0, 8.0))
    nav.tick()
    return nav


@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf])
def test_a_way_on_edges_that_cannot_be_is_refused(value: float) -> None:
    header, arrays = walking("a").save()
    other = walking("b")
    with pytest.raises(SavedAgentsError, match="'on_edges' of saved agents has a value"):
        other.load(header, {**arrays, "on_edges": np.full(1, value)})
    assert list(other.table) == ["b"]


@pytest.mark.parametrize(
    "detours",
    [
        [[0, [[np.nan, 4.0, 0.0, 0.5]]]],
        [[0, [[4.0, 4.0, 0.5]]]],
        [[0, [DISC], None, [[4.0, 4.0, 0.0, np.inf]], None, 0.0]],
        [[0, [DISC], -1.0, [DISC], None, 0.0]],
        [[0, [DISC], None, [DISC], None, np.nan]],
        [[1, [DISC]]],
        [[-1, [DISC]]],
        [[0, [DISC]]] * 17,
        [[0]],
        [7],
    ],
)
def test_ways_around_people_that_cannot_be_are_refused_and_nothing_changes(detours: Any) -> None:
    header, arrays = walking("a").save()
    other = walking("b")
    before = other.table.agents.potential_rows.copy()
    with pytest.raises(SavedAgentsError, match="ways around people cannot be read"):
        other.load({**header, "detours": detours}, arrays)
    assert list(other.table) == ["b"]
    assert np.array_equal(other.table.agents.potential_rows, before)
    assert sum(other.potentials.users) == 1
    other.tick()


def test_actors_saved_before_a_parameter_was_known_get_its_usual_value() -> None:
    header, arrays = walking("a").save()
    older = [name for name in PARAMETERS.names or () if name != "stride"]
    known = np.zeros(1, dtype=[(name, "f8") for name in older])
    for name in older:
        known[name] = arrays["parameters"][name]
    known["radius_m"] = 0.3
    other = walking("b")
    other.load(header, {**arrays, "parameters": known})
    assert other.parameters("a") == BODY.model_copy(update={"radius_m": 0.3})
    with pytest.raises(SavedAgentsError, match="column 'parameters' of saved agents must be"):
        other.load(header, {**arrays, "parameters": known[older[1:]]})
