"""Parameters say what they are, keep their ranges, and reach the kernels."""

import math

import pytest
from pydantic import ValidationError

from esplanade.actors import ActorParameters
from esplanade.actors.parameter_records import MEASURES
from esplanade.planning import PARAMETERS

FIELDS = ActorParameters.model_fields
SCHEMA = ActorParameters.model_json_schema()["properties"]


@pytest.mark.parametrize("name", FIELDS)
def test_every_field_has_a_unit_a_range_and_a_description(name) -> None:
    schema = SCHEMA[name]
    assert schema["unit"]
    assert schema["minimum"] < schema["maximum"]
    assert schema["minimum"] <= schema["default"] <= schema["maximum"]
    assert len(schema["description"]) > 20


@pytest.mark.parametrize("name", FIELDS)
def test_every_field_says_where_it_belongs_and_when_a_change_applies(name) -> None:
    schema = SCHEMA[name]
    assert schema["group"] in {"body", "speed", "comfort", "planning"}
    assert (schema["applies"] == "prepared") == (name in MEASURES)
    wide = schema["minimum"] > 0.0 and schema["maximum"] / schema["minimum"] > 50.0
    assert schema["scale"] == ("log" if wide else "linear")


def test_all_groups_and_scales_are_used() -> None:
    assert {SCHEMA[name]["group"] for name in FIELDS} == {"body", "speed", "comfort", "planning"}
    assert SCHEMA["max_expansions"]["scale"] == "log"
    assert SCHEMA["speed_mps"]["scale"] == "linear"


@pytest.mark.parametrize("name", FIELDS)
def test_values_outside_their_range_are_refused_by_name(name) -> None:
    schema = SCHEMA[name]
    for value in (schema["minimum"] - 1.0, schema["maximum"] + 1.0, math.nan, math.inf, "much"):
        with pytest.raises(ValidationError, match=name):
            ActorParameters(**{name: value})


def test_the_defaults_are_those_that_everything_was_measured_with() -> None:
    body = ActorParameters()
    assert (body.radius_m, body.speed_mps, body.max_speed_mps) == (0.25, 1.3, 1.7)
    assert (body.max_acceleration_mps2, body.goal_tolerance_m) == (2.0, 0.2)


def test_the_greatest_speed_is_not_below_the_preferred_one() -> None:
    with pytest.raises(ValidationError, match=r"max_speed_mps \(1.0\) must not be below"):
        ActorParameters(max_speed_mps=1.0)


def test_unknown_fields_are_refused_and_known_ones_fixed() -> None:
    with pytest.raises(ValidationError, match="colour"):
        ActorParameters(colour="red")
    with pytest.raises(ValidationError, match="frozen"):
        ActorParameters().radius_m = 0.3


def test_kernels_get_every_field_they_name() -> None:
    row = ActorParameters(radius_m=0.3, max_expansions=123).row()
    assert set(PARAMETERS.names) <= set(FIELDS)
    assert row["radius_m"] == 0.3
    assert row["max_expansions"] == 123.0
