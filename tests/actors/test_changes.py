"""Parameters of many actors at once: all or none, and nothing is left of what was refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.actors import ActorParameters, GoTo, Guide, Idle, ParameterError, Population
from esplanade.actors.parameter_records import NAMES
from esplanade.actors.warming import tables_ahead
from esplanade.planning import Body, LayeredGrid, Polygon
from esplanade.planning.people import risk
from esplanade.planning.scene.bodies import MOST_BODIES
from esplanade.planning.traversal import cache
from tests.actors.worlds import holds, plaza

SCENE = plaza()
IDS = ("a", "b", "c")
SCHEMA = ActorParameters.model_json_schema()["properties"]
BEYOND = 1.3


def numbers(name):
    """Values of a parameter, some of them out of its range or no numbers."""
    least, most = SCHEMA[name]["minimum"], SCHEMA[name]["maximum"]
    return st.one_of(
        st.floats(least, most), st.floats(least - BEYOND, BEYOND * most), st.just(float("nan"))
    )


CHANGES = st.lists(st.sampled_from(NAMES), min_size=1, max_size=3, unique=True).flatmap(
    lambda names: st.fixed_dictionaries(
        {
            name: st.one_of(numbers(name), st.lists(numbers(name), min_size=3, max_size=3))
            for name in names
        }
    )
)


def populated(grid=None) -> Population:
    population = Population(grid or LayeredGrid.from_scene(SCENE), SCENE, tick_s=0.05)
    population.add("a", GoTo("fountain"), position=(2.0, 2.0))
    population.add("b", GoTo("stage"), position=(4.0, 2.0))
    population.add("c", Idle(), position=(6.0, 6.0))
    population.tick({})
    return population


def traces(population: Population) -> dict[str, object]:
    """All that a change of parameters may have changed."""
    navigator, table = population.navigator, population.table
    columns = {**table.agents._asdict(), **table.trips._asdict()}
    return {
        **{name: column.tobytes() for name, column in columns.items()},
        "agents": id(table.agents),
        "users of potentials": [n for n in navigator.potentials.users if n],
        "users of bodies": {k: n for k, n in population.grid._rows._users.items() if n},
    }


POPULATION = populated()


@holds(120)
@given(CHANGES, st.sampled_from([IDS, (*IDS[:2], "nobody"), ("a", "a", "b")]))
def test_a_refused_change_leaves_no_trace_and_a_change_is_whole(changes, ids) -> None:
    before = traces(POPULATION)
    expected = [
        {**POPULATION.navigator.parameters(each).model_dump(), **_nth(changes, k)}
        for k, each in enumerate(IDS)
    ]
    try:
        POPULATION.set_many(ids, changes)
    except (ParameterError, KeyError, ValueError):
        assert traces(POPULATION) == before
        with pytest.raises((ValueError, KeyError)):
            _ = [ActorParameters(**values) for values in expected] if ids == IDS else [{}["x"]]
    else:
        assert ids == IDS
        for each, values in zip(IDS, expected, strict=True):
            assert POPULATION.navigator.parameters(each) == ActorParameters(**values)
            row = POPULATION.table.row(each)
            body = ActorParameters(**values).body
            assert POPULATION.table.agents.bodies[row] == POPULATION.grid.row_of(body)


def _nth(changes, k):
    return {name: v[k] if isinstance(v, list) else v for name, v in changes.items()}


def test_a_change_to_one_kind_of_body_too_many_leaves_no_trace() -> None:
    population = populated()
    grid = population.grid
    for k in range(MOST_BODIES - 1):
        grid.claim(Body(height_m=0.4 + 0.05 * k if k != 28 else 3.9, radius_m=0.1))
    before = traces(population)
    with pytest.raises(ValueError, match="64 kinds walk"):
        population.set_many(IDS, {"radius_m": [0.25, 0.4, 0.45]})
    assert traces(population) == before
    grid.release(Body(height_m=0.4, radius_m=0.1))
    population.set_many(IDS, {"radius_m": [0.25, 0.4, 0.4]})
    assert population.navigator.parameters("c").radius_m == 0.4
    population.close()


def test_bodies_that_are_almost_alike_share_their_potentials() -> None:
    population = populated()
    slots = population.table.agents.potential_rows.copy()
    population.set_many(["a"], {"radius_m": 0.248, "edge_cells": 20, "leg_length_m": 0.93})
    assert np.array_equal(population.table.agents.potential_rows, slots)
    population.set_many(["a"], {"radius_m": 0.27})
    assert population.table.agents.potential_rows[0] != slots[0]
    population.close()


# --- a tick that fails -----------------------------------------------------------------------


def walked(population: Population, ticks: int, failing: set[int], stands: set[int]) -> list[bytes]:
    story = []
    advance = population.navigator.advance

    def fail() -> None:
        advance()
        raise MemoryError("told to fail")

    for tick in range(ticks):
        people = {1: (2.0 + 0.05 * tick, 2.5, 0.0)}
        population.navigator.advance = fail if tick in failing else advance
        if tick in stands:
            population.stand(people)
        else:
            try:
                population.advance(people)
            except MemoryError:
                assert tick in failing
        story.append(population.table.agents.positions.tobytes())
    return story


def guided() -> Population:
    population = populated()
    population.add("g", Guide(["gate", "fountain", "stage"]), position=(2.0, 3.0))
    return population


def test_a_tick_in_which_planning_fails_is_like_one_in_which_all_stand() -> None:
    failing, standing, whole = guided(), guided(), guided()
    bad = {20, 21, 45}
    stories = [
        walked(failing, 90, bad, set()),
        walked(standing, 90, set(), bad),
        walked(whole, 90, set(), set()),
    ]
    assert stories[0] == stories[1]
    assert stories[0][19] == stories[0][20] == stories[0][21] != stories[0][22]
    assert stories[0] != stories[2]
    for population in (failing, standing, whole):
        population.close()


def test_no_table_of_risk_is_made_for_a_radius_once_they_are_made_ahead():
    navigator = populated().navigator
    for work in tables_ahead(navigator):
        work()
    least, most = SCHEMA["radius_m"]["minimum"], SCHEMA["radius_m"]["maximum"]
    made = risk._radial_table.cache_info().misses
    radii = np.linspace(least, most, 30)
    navigator.prepare_contacts(Body(radius_m=radius) for radius in radii)
    for radius in radii:
        navigator.set_parameters("a", ActorParameters(radius_m=radius))
    assert risk._radial_table.cache_info().misses == made


def test_asking_for_new_bodies_derives_nothing(monkeypatch):
    """It is asked between two ticks, and the ground of a body is as much as a tick may take."""
    step = Polygon(points=((4.5, 4.5), (5.5, 4.5), (5.5, 5.5), (4.5, 5.5)), height_m=0.3)
    scene = SCENE.model_copy(update={"name": "another", "polygons": (*SCENE.polygons, step)})
    population = populated(LayeredGrid.from_scene(scene))
    assert not population.grid.arrays.flat

    def fail(*_):
        raise AssertionError("ground is derived")

    monkeypatch.setattr(cache, "find_traversability", fail)
    found = population.new_bodies(("a", "b"), {"radius_m": [0.31, 0.25]})
    assert found == [(population.table.wanted(0), Body(radius_m=0.31))]
