"""Overrides of parameters: the narrower scope prevails, and every value says where it is from."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from esplanade.actors import ActorParameters, Overrides, Scope
from esplanade.actors.overrides import WORLD, Difference, Source
from tests.actors.worlds import holds

GUIDES, OWN = Scope("group", "guides"), Scope("own", "main/a1")
NUMBERS = st.floats(0.0, 10.0)
VALUES = st.dictionaries(st.sampled_from(["risk_weight", "turn_weight", "speed_mps"]), NUMBERS)
SCOPES = st.sampled_from([WORLD, GUIDES, OWN, Scope("group", "late"), Scope("own", "main/a2")])
OVERRIDES = st.dictionaries(SCOPES, VALUES.filter(bool)).map(Overrides)


def test_the_narrower_scope_prevails_and_says_so() -> None:
    overrides = (
        Overrides()
        .with_values(OWN, {"speed_mps": 1.0})
        .with_values(WORLD, {"speed_mps": 1.2, "risk_weight": 12.0, "turn_weight": 0.5})
        .with_values(GUIDES, {"risk_weight": 20.0})
    )
    effective = overrides.effective("main/a1", ("guides",))
    assert effective["speed_mps"] == Source(1.0, "own")
    assert effective["risk_weight"] == Source(20.0, "group", "guides")
    assert effective["turn_weight"] == Source(0.5, "world")
    assert effective["hurry_weight"] == Source(0.2, "default")
    assert overrides.effective("main/a2")["risk_weight"] == Source(12.0, "world")
    assert overrides.parameters("main/a1", ("guides",)).risk_weight == 20.0
    assert list(overrides.shadowed(WORLD, "speed_mps")) == [OWN]


def test_of_two_groups_the_last_prevails() -> None:
    overrides = Overrides(
        {GUIDES: {"risk_weight": 20.0}, Scope("group", "late"): {"risk_weight": 5.0}}
    )
    assert overrides.effective("x", ("late", "guides"))["risk_weight"].value == 20.0
    assert overrides.effective("x", ("guides", "late"))["risk_weight"].value == 5.0


def test_values_that_do_not_go_together_are_found_for_the_actor() -> None:
    overrides = Overrides({WORLD: {"max_speed_mps": 1.5}, GUIDES: {"speed_mps": 1.6}})
    assert overrides.parameters("main/a2").max_speed_mps == 1.5
    with pytest.raises(ValidationError, match="must not be below speed_mps"):
        overrides.parameters("main/a1", ("guides",))


def test_unknown_names_and_scopes_are_refused() -> None:
    with pytest.raises(KeyError, match="'colour' is no parameter"):
        Overrides().with_values(WORLD, {"colour": 1.0})
    for scope in (("world", "x"), ("group", ""), ("own", "")):
        with pytest.raises(ValueError, match="cannot have the name"):
            Scope(*scope)


@holds(50)
@given(OVERRIDES, SCOPES, VALUES)
def test_what_is_set_is_there_and_can_be_taken_back(overrides, scope, values) -> None:
    changed = overrides.with_values(scope, values)
    assert changed.of(scope) == {**overrides.of(scope), **values}
    bare = changed.without(scope)
    assert bare.of(scope) == {}
    assert bare.with_values(scope, overrides.of(scope)).differences(overrides) == []


@holds(50)
@given(OVERRIDES, OVERRIDES)
def test_differences_lead_from_one_to_the_other(before, after) -> None:
    changed = before
    for scope, name, old, new in before.differences(after):
        assert changed.of(scope).get(name) == old
        if new is None:
            changed = changed.without(scope, name)
        else:
            changed = changed.with_values(scope, {name: new})
    assert changed == after
    assert all(isinstance(each, Difference) for each in before.differences(after))


@holds(50)
@given(OVERRIDES)
def test_every_value_is_that_of_the_scope_it_names(overrides) -> None:
    defaults = ActorParameters().model_dump()
    for name, (value, level, group) in overrides.effective("main/a1", ("late", "guides")).items():
        scope = {"world": WORLD, "own": OWN}.get(level, Scope("group", group or "none"))
        assert value == (defaults[name] if level == "default" else overrides.of(scope)[name])
        narrower = {"own": [], "group": [OWN], "world": [OWN, GUIDES], "default": [WORLD, OWN]}
        assert not any(name in overrides.of(each) for each in narrower[level])
