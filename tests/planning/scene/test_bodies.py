"""The measures that a body may have."""

import dataclasses
import math

import pytest

from esplanade.planning.scene.bodies import LIMITS, Body


def test_presets_are_those_of_the_paper() -> None:
    adult, child = Body.adult(), Body.child()
    assert (adult.height_m, adult.step_on_m) == (1.80, 0.60)
    assert (child.height_m, child.step_on_m) == (1.30, 0.30)
    assert (adult.radius_m, adult.leg_length_m, adult.edge_cells) == (0.25, 0.90, 64)
    assert (child.radius_m, child.leg_length_m, child.edge_cells) == (0.20, 0.65, 64)


def test_equal_bodies_are_one_key() -> None:
    assert {Body.adult(): 1}[Body()] == 1
    with pytest.raises(dataclasses.FrozenInstanceError):
        Body().height_m = 2.0  # type: ignore[misc]


@pytest.mark.parametrize("name", LIMITS)
@pytest.mark.parametrize("value", [-1.0, math.nan, math.inf, 1e6])
def test_measures_outside_their_limits_are_refused_by_name(name, value) -> None:
    with pytest.raises(ValueError, match=name):
        Body(**{name: value})


def test_parts_of_cells_and_legs_shorter_than_steps_are_refused() -> None:
    with pytest.raises(ValueError, match="whole number"):
        Body(edge_cells=2.5)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="leg_length_m"):
        Body(step_on_m=0.8, leg_length_m=0.5)
