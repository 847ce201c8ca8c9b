"""Rosters: read from files, checked as a whole, and the one that a scene has without one."""

import json
from pathlib import Path
from typing import Any

import pytest

from esplanade.actors.overrides import Source
from esplanade.planning import LayeredGrid
from esplanade.server.populating import populate_from
from esplanade.server.roster import Roster, RosterError, read_roster
from tests.server.populated import HALL

ANN: dict[str, Any] = {
    "id": "main/ann",
    "name": "Ann",
    "behaviour": {"kind": "patrol", "stops": ["west", [12.0, 2.0, 0.0]], "pause_s": 1.0},
    "tags": ["guides"],
    "overrides": {"speed_mps": 1.0},
    "place": [3.0, 3.0, 0.0],
}
ROSTER: dict[str, Any] = {
    "actors": [ANN, {"id": "main/ben", "name": "Ben"}],
    "world": {"risk_weight": 12.0},
    "groups": {"guides": {"risk_weight": 20.0}},
}


def written(folder: Path, roster: Any) -> Path:
    path = folder / "roster.json"
    path.write_text(roster if isinstance(roster, str) else json.dumps(roster))
    return path


def test_actors_come_in_as_a_roster_says(tmp_path: Path) -> None:
    roster = read_roster(written(tmp_path, ROSTER))
    population = populate_from(roster, LayeredGrid.from_scene(HALL), HALL, 0.05, 1)
    assert list(population.table) == ["main/ann", "main/ben"]
    kinds = [population.explain(each).behaviour for each in population.table]
    assert kinds == ["patrol", "wander"]
    ann, ben = (population.navigator.parameters(each) for each in population.table)
    assert (ann.speed_mps, ann.risk_weight, ben.risk_weight) == (1.0, 20.0, 12.0)
    assert population.navigator.state("main/ann").position == (3.0, 3.0)
    effective = roster.overrides.effective("main/ann", ("guides",))
    assert effective["risk_weight"] == Source(20.0, "group", "guides")
    population.close()


@pytest.mark.parametrize(
    ("roster", "fault"),
    [
        ("{", "Invalid JSON"),
        ({"actors": [ANN, ANN]}, "2 actors have the id 'main/ann'"),
        ({"actors": [{**ANN, "id": "ann"}]}, r"actors\.0\.id: String should match"),
        ({"actors": [{**ANN, "overrides": {"colour": 1}}]}, "'colour' is no parameter"),
        ({"actors": [{**ANN, "overrides": {"speed_mps": 9}}]}, "main/ann: .*less than or equal"),
        ({"actors": [{**ANN, "behaviour": {"kind": "fly"}}]}, r"actors\.0\.behaviour"),
        ({"groups": {"guides": {"colour": 1}}}, "'colour' is no parameter"),
        ({"people": []}, "people: Extra inputs"),
    ],
)
def test_a_fault_in_a_roster_is_named(tmp_path: Path, roster: Any, fault: str) -> None:
    with pytest.raises(RosterError, match=fault):
        read_roster(written(tmp_path, roster))


def test_a_roster_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(RosterError, match=r"none\.json: cannot be read: No such file"):
        read_roster(tmp_path / "none.json")


def test_a_place_that_the_scene_does_not_have_is_named() -> None:
    lost = {**ANN, "behaviour": {"kind": "go_to", "target": "moon"}}
    roster = Roster.model_validate({"actors": [lost]})
    with pytest.raises(ValueError, match="main/ann: no place named 'moon'"):
        populate_from(roster, LayeredGrid.from_scene(HALL), HALL, 0.05, 1)


def test_a_roster_has_a_schema_that_a_form_can_be_made_of() -> None:
    schema = Roster.model_json_schema()["$defs"]["ActorSpec"]["properties"]
    mapping = schema["behaviour"]["discriminator"]["mapping"]
    assert set(mapping) == {"idle", "go_to", "wander", "patrol", "guide", "follow"}
