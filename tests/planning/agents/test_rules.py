"""The numbers of the rules: told with units, ranges and effects, and none left in the kernels."""

import ast
from pathlib import Path
from runpy import run_path

import pytest
from pydantic import ValidationError

from esplanade.planning import RuleModel
from esplanade.planning.agents.rules import RULES

ROOT = Path(__file__).parents[3]
AGENTS = ROOT / "planning" / "agents"
NO_RULES = {
    "_search_kernels.py": {"FOUND", "PARTIAL", "NO_PATH"},  # statuses
    "_task_kernels.py": {"SUB", "TOO_MANY"},  # slices that layouts have, and no number
    "_perturb_kernels.py": {"_MOST_EDGES"},  # no number
    "_cost_kernels.py": {"MOST_OTHERS", "MOST_PEOPLE"},  # room
    "_narrow_way_kernels.py": {
        "_MOST_POINTS",
        "_LESS_M",
        "_REACHED_M",
        "_BRAKING_SLICES",
        "_EVERY",
        "_HELD_UP_M",
        "_RINGS",
    },  # room, tolerances
    "_trace_kernels.py": {"COLUMNS"},
}


@pytest.mark.parametrize("name", RuleModel.model_fields)
def test_every_rule_has_a_unit_a_range_and_an_effect(name) -> None:
    field = RuleModel.model_json_schema()["properties"][name]
    if field["type"] != "boolean":
        assert field["minimum"] <= field["default"] <= field["maximum"]
    assert field["unit"]
    assert field["group"]
    assert field["description"].endswith(".")


def test_kernels_know_every_rule_by_its_value() -> None:
    rules = RuleModel(margin_m=0.1, jam_actors=20)
    (row,) = rules.row
    assert RULES.names == tuple(RuleModel.model_fields)
    assert {name: row[name] for name in RULES.names} == rules.model_dump()


def test_a_rule_out_of_its_range_is_refused() -> None:
    with pytest.raises(ValidationError, match="less than or equal to"):
        RuleModel(margin_m=2.0)
    with pytest.raises(ValidationError, match="greater than or equal to"):
        RuleModel(wall_room_m=0.0)


@pytest.mark.parametrize("path", sorted(AGENTS.glob("_*_kernels.py")), ids=lambda path: path.name)
def test_kernels_have_no_numbers_of_their_own(path) -> None:
    names = {
        target.id
        for node in ast.parse(path.read_text()).body
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant | ast.UnaryOp)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    assert names <= NO_RULES.get(path.name, set())


def test_the_page_of_the_rules_is_what_they_are() -> None:
    written = run_path(str(ROOT / "tools" / "write_rules.py"))["page"]()
    assert (ROOT / "docs" / "rules.md").read_text() == written
