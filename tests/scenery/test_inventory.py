"""The inventory counts the contents of a scene."""

import json
from io import StringIO

import numpy as np
import pytest
from rich.console import Console

from esplanade.scenery.inventory import show, take_inventory
from tests.scenery.worlds import loft


def test_extent_layers_cells_and_parts_are_counted() -> None:
    found = take_inventory(loft(), 0.25)
    assert found.name == "Loft"
    assert found.extent_m == pytest.approx((12.0, 8.0, 3.0))
    assert len(found.layers) == 2
    assert found.cells == sum(layer.cells for layer in found.layers)
    upper = found.layers[1]
    assert upper.area_m2 == pytest.approx(4 * 8)
    assert (upper.lowest_m, upper.highest_m) == pytest.approx((3.0, 3.0))
    assert found.memory_bytes > 40 * found.cells
    assert found.parts["polygons"] == 5
    assert found.parts["stairs"] == 1
    assert found.faults == ()


def test_a_place_that_only_children_reach_is_no_fault_but_one_that_nobody_reaches_is() -> None:
    walls = [{"start": [3, 6], "end": [4.5, 6]}]
    assert take_inventory(loft(), 0.25).reach["adult"].places_missed == ("den",)
    found = take_inventory(loft(walls=walls), 0.25)
    assert found.faults == ("place 'den': nobody gets there from the spawns",)


def test_closed_doors_are_taken_to_be_open() -> None:
    door = {"name": "den door", "start": [3, 6], "end": [4.5, 6], "open": False}
    assert take_inventory(loft(doors=[door]), 0.25).faults == ()


def test_a_spawn_where_nobody_can_stand_is_a_fault() -> None:
    spawns = [{"position": [6, 6.25], "radius_m": 0}, {"position": [1, 2]}]
    assert take_inventory(loft(spawns=spawns), 0.25).faults == ("spawns.0: nobody can stand there",)


def test_a_scene_without_floor_is_at_fault() -> None:
    solid = [{"height_m": 3, "kind": "water", "points": [[-1, -1], [13, -1], [13, 9], [-1, 9]]}]
    faults = take_inventory(loft(polygons=solid, stairs=[]), 0.25).faults
    assert faults[0] == "there is no floor to stand on"
    assert "spawns.0: nobody can stand there" in faults


def test_figures_are_json() -> None:
    found = take_inventory(loft(), 0.25)
    figures = json.loads(json.dumps(found.figures()))
    assert figures["cells"] == found.cells
    assert figures["reach"]["adult"]["places_missed"] == ["den"]
    assert figures["faults"] == []
    assert np.isclose(figures["reach"]["child"]["reached"], found.reach["child"].reached)


def test_people_read_all_of_it() -> None:
    console = Console(width=100, file=StringIO())
    with console.capture() as captured:
        show(console, take_inventory(loft(), 0.25))
    text = captured.get()
    for words in ("Loft", "12 m × 8 m", "1 stairs", "MiB", "adult", "child", "but not den"):
        assert words in text
