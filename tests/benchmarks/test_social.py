"""The scenes in which actors change sides, and one that is run to its end."""

import json
from importlib.util import find_spec

import numpy as np
import pytest
from benchmarks import social
from benchmarks._swaps import SWAPS

from esplanade.planning import LayeredGrid
from tests.planning.worlds import COMPILED

RADIUS_M = 0.25


@pytest.mark.parametrize("name", SWAPS)
@pytest.mark.parametrize("actors", [1, 12, 50])
def test_starts_and_goals_leave_room_for_each_other(name, actors) -> None:
    swap = SWAPS[name](actors, 2.0, np.random.default_rng(0))
    grid = LayeredGrid.from_scene(swap.scene)
    for points in (swap.starts, swap.goals):
        assert points.shape == (actors, 2)
        assert grid.is_free(points, np.zeros(actors, dtype=int), RADIUS_M).all()
        away = np.hypot(*np.moveaxis(points[:, None] - points[None], -1, 0))
        assert away[~np.eye(actors, dtype=bool)].min(initial=9.0) > 2.0 * RADIUS_M + 0.05


@pytest.mark.parametrize("name", SWAPS)
def test_everyone_changes_sides(name) -> None:
    swap = SWAPS[name](12, 2.0, np.random.default_rng(0))
    middle = np.array(swap.scene.bounds[2:]) / 2.0
    before, after = swap.starts - middle, swap.goals - middle
    across = before[:, 0] * after[:, 0] if name == "doorway" else (before * after).sum(axis=1)
    assert (across < 0.0).all()


def test_twelve_on_a_circle_change_places(tmp_path, capsys) -> None:
    file = tmp_path / "figures.json"
    options = ["--actors", "12", "--scenes", "circle", "--until", "40", "--threads", "1"]
    assert social.main([*options, "--json", str(file)]) == 0
    (figures,) = json.loads(file.read_text()).values()
    assert (figures["actors"], figures["contacts"], figures["stuck"]) == (12, 0, 0)
    assert figures["clearance_m"] > 0.0
    assert 0.9 < figures["time_ratio"] <= figures["worst_time_ratio"] < 4.0
    assert "contacts, pairs" in capsys.readouterr().out


@pytest.mark.skipif(not COMPILED, reason="takes minutes uncompiled")
def test_two_crowds_come_through_a_doorway_and_nobody_is_stuck(capsys) -> None:
    options = ["--actors", "60", "--scenes", "doorway", "--until", "60", "--threads", "1"]
    assert social.main(options) == 0, capsys.readouterr().out


def test_actors_that_do_not_arrive_in_time_are_reported(capsys) -> None:
    options = ["--actors", "2", "--scenes", "circle", "--until", "1", "--threads", "1"]
    assert social.main(options) == 1
    assert "–" in capsys.readouterr().out


@pytest.mark.skipif(find_spec("matplotlib") is None, reason="matplotlib is absent")
def test_ways_are_drawn(tmp_path) -> None:
    swap = SWAPS["doorway"](4, 1.2, np.random.default_rng(0))
    walks, _ = social.walk(swap, seed=0, until_s=2.0)
    social.draw(tmp_path / "new" / "ways.png", swap, walks)
    assert (tmp_path / "new" / "ways.png").read_bytes().startswith(b"\x89PNG")
