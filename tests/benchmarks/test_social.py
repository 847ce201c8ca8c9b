"""The scenes in which actors change sides, and one that is run to its end."""

import json
from importlib.util import find_spec

import numpy as np
import pytest
from benchmarks import social
from benchmarks._flow import crossings_s, fair_wait_s, flow_of, one_way
from benchmarks._swaps import SWAPS
from benchmarks._walks import Walks

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


def test_flow_and_waits_of_a_file_that_goes_through_one_by_one() -> None:
    swap = one_way(SWAPS["doorway"](20, 2.0, np.random.default_rng(0)))
    assert len(swap.starts) == 10
    door_x, tick_s = (swap.scene.bounds[0] + swap.scene.bounds[2]) / 2.0, 0.05
    crossed_s = 5.0 + 2.0 * np.arange(10)
    times = tick_s * np.arange(600)
    positions = np.repeat(swap.starts[None], 600, axis=0)
    positions[:, :, 0] = np.where(times[:, None] >= crossed_s, door_x + 1.0, door_x - 1.0)
    positions[:, :, 1] = np.arange(10)
    walks = Walks(positions, np.ones((600, 10)), tick_s, 0.25, 1.3, 0.3)
    np.testing.assert_allclose(crossings_s(positions, door_x, tick_s), crossed_s, atol=tick_s)
    flow = flow_of(swap, 2.0, walks)
    assert (flow.both_ways, flow.crossed, flow.contacts) == (False, 10, 0)
    assert flow.flow == pytest.approx(0.5 / 2.0, rel=0.05)
    assert flow.last_s == pytest.approx(23.0, abs=tick_s)
    assert flow.longest_wait_s > flow.fair_wait_s > 10.0
    assert fair_wait_s(np.array([3.0, 0.0, 0.5]), 1.0) == 0.5
    assert fair_wait_s(np.zeros(5), 2.0) == 2.0


def test_flows_through_doorways_are_printed_and_judged(tmp_path, capsys) -> None:
    file = tmp_path / "flows.json"
    options = ["--actors", "8", "--widths", "1.2", "--until", "25", "--threads", "1"]
    assert social.main([*options, "--json", str(file)]) == 0
    one, both = json.loads(file.read_text())
    assert (one["crossed"], both["crossed"], both["both_ways"]) == (4, 8, True)
    assert "0 pairs in contact" in capsys.readouterr().out
    assert social.main([*options[:4], "--until", "2", "--threads", "1"]) == 1
