"""Scenes at any angle: triangles, the judgement of plans, and a short run of the benchmark."""

import numpy as np
import pytest
from benchmarks import turned as benchmark
from benchmarks._four_answers import ANSWERS
from benchmarks._scene_triangles import triangles_of
from benchmarks._turned_plans import KINDS, Plan, random_plan
from benchmarks._turned_scenes import Turn, doorway, flight, ramp

from esplanade.planning import Body, LayeredGrid


@pytest.mark.parametrize("degrees", [0.0, 18.0, 90.0])
def test_a_building_keeps_its_shape_when_it_is_turned(degrees) -> None:
    turn = Turn(degrees, (0.1, -0.2))
    ring = np.array(turn.rectangle(-1.0, -2.0, 3.0, 2.0))
    sides = np.linalg.norm(np.diff([*ring, ring[0]], axis=0), axis=1)
    assert sides == pytest.approx([4.0, 4.0, 4.0, 4.0])
    assert turn.at(0.0) == (0.1, -0.2)


def test_triangles_have_the_tops_and_the_sides_of_a_scene() -> None:
    case = flight(Turn(30.0), 1.0, Body.adult(), steps=4)
    triangles = triangles_of(case.scene)
    a, b, c = (triangles[:, k] for k in range(3))
    normals = np.cross(b - a, c - a)
    areas = 0.5 * np.linalg.norm(normals, axis=1)
    level = normals[:, 2] > 0.999 * 2.0 * areas
    tops = [areas[level & np.isclose(a[:, 2], 0.2 * k)].sum() for k in range(1, 5)]
    assert tops == pytest.approx([0.3, 0.3, 0.3, 0.3 + 3.6 * 4.0])
    assert np.isclose(normals[~level][:, 2], 0.0).all()
    rising = triangles_of(ramp(Turn(30.0), 1.0, Body.adult()).scene)
    assert rising[:, :, 2].max() == pytest.approx(1.6)


def test_every_kind_of_plan_comes_with_a_way_and_without() -> None:
    plans = [random_plan(np.random.default_rng(seed)) for seed in range(60)]
    assert {plan.kind for plan in plans} == set(KINDS)
    assert {plan.has_way for plan in plans} == {True, False}
    again = random_plan(np.random.default_rng(7))
    assert again == plans[7]


def test_the_four_answer_as_the_plan_says() -> None:
    for has_way, width in ((True, 1.0), (False, 0.4)):
        case = doorway(Turn(33.0, (0.07, 0.11)), width, Body.adult())
        grid = LayeredGrid.from_scene(case.scene)
        assert {name: answer(grid, case) for name, answer in ANSWERS.items()} == dict.fromkeys(
            ANSWERS, has_way
        )


def test_a_wrong_judgement_is_seen(monkeypatch, capsys) -> None:
    sealed = Plan(
        "doors", (), (((0.0, -4.0), (0.0, 4.0)),), (-2.0, 0.0), (2.0, 0.0), 0.25, True, 0.1
    )
    monkeypatch.setattr("benchmarks._turned_trials.random_plan", lambda random: sealed)
    assert benchmark.main(["plans", "--scenes", "1", "--angles", "20", "--ours"]) == 1
    assert "tool misses a way: plan 0 (doors), 20 degrees" in capsys.readouterr().out


def test_a_short_run_prints_its_tables(tmp_path, capsys) -> None:
    figures = tmp_path / "figures.json"
    command = ["doors", "plans", "--scenes", "1", "--angles", "20", "--ours", "--json"]
    assert benchmark.main([*command, str(figures)]) == 0
    out = capsys.readouterr().out
    assert "doors: 4 each" in out
    assert "plans at 1 angles" in out
    assert figures.exists()


def test_a_part_that_is_none_is_refused() -> None:
    with pytest.raises(SystemExit, match="'door' is no part"):
        benchmark.main(["door"])
