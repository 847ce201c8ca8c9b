"""Beams, lintels and slits between low ceilings, at odd angles and offsets: the four agree.

What hangs above decides by exact lines, as walls do, and by the floor that the body comes from.
"""

import pytest
from benchmarks import _four_answers as four
from benchmarks._turned_scenes import Case, Turn, flight, scene_of

from esplanade.planning import Body, LayeredGrid, Scene
from tests.planning.worlds import of_all

TURNS = of_all([Turn(33.0, (0.2, 0.07)), Turn(0.0, (0.03, 0.11)), Turn(61.0, (0.11, 0.02))])
FAR_M = 20.0


def box(turn: Turn, along: float, low: float, high: float, bottom: float, height: float) -> dict:
    """A solid across the way, `along` to each side, from `low` to `high` across."""
    points = turn.rectangle(-along, low, along, high)
    return {"kind": "wall", "points": points, "offset_m": bottom, "height_m": height}


def answers(case: Case) -> dict[str, bool]:
    """The four answers, on one grid."""
    grid = LayeredGrid.from_scene(case.scene)
    return {name: answer(grid, case) for name, answer in four.ANSWERS.items()}


def across(turn: Turn, parts: list[dict]) -> Case:
    """The way from one side of something to the other."""
    scene = scene_of({"polygons": parts}, 9.0)
    return Case(scene, (*turn.at(-3.0, 0.4), 0.0), (*turn.at(3.0, -0.3), 0.0), Body.adult())


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize(("width", "passes"), [(0.6, True), (0.45, False)])
def test_a_slit_between_low_ceilings_is_as_wide_as_it_is(turn, width, passes) -> None:
    half = 0.5 * width
    sides = [(-FAR_M, -half), (half, FAR_M)]
    case = across(turn, [box(turn, 0.6, low, high, 1.2, 0.3) for low, high in sides])
    assert answers(case) == dict.fromkeys(four.ANSWERS, passes)


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize(("under", "passes"), [(2.0, True), (1.75, False)])
def test_a_lintel_is_as_high_as_it_is(turn, under, passes) -> None:
    sides = [box(turn, 0.1, low, high, 0.0, 3.0) for low, high in ((-FAR_M, -0.33), (0.33, FAR_M))]
    case = across(turn, [*sides, box(turn, 0.1, -0.33, 0.33, under, 3.0 - under)])
    assert answers(case) == dict.fromkeys(four.ANSWERS, passes)


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize(("under", "passes"), [(2.85, True), (2.7, False)])
def test_a_beam_over_a_flight_matters_from_the_treads_that_one_meets_it_on(
    turn, under, passes
) -> None:
    """Its edge is above the third of eight treads, 5 cm too low for the fifth's neighbour."""
    case = flight(turn, 1.2, Body.adult())
    beam = {
        "kind": "wall",
        "points": turn.rectangle(-0.6, -1.2, 0.0, 1.2),
        "offset_m": under,
        "height_m": 0.3,
    }
    parts = case.scene.model_dump(mode="json")
    parts["polygons"].append(beam)
    case = Case(Scene.model_validate(parts), case.start, case.goal, case.body)
    assert answers(case) == dict.fromkeys(four.ANSWERS, passes)


@pytest.mark.parametrize("turn", TURNS)
def test_no_passage_that_is_8_mm_narrower_than_a_body_is_a_way(turn) -> None:
    half = 0.25 - 0.004
    walls = [
        {"start": turn.at(0.0, low), "end": turn.at(0.0, high), "height_m": 3.0}
        for low, high in ((-FAR_M, -half), (half, FAR_M))
    ]
    case = across(turn, [])
    case = Case(scene_of({"walls": walls}, 9.0), case.start, case.goal, case.body)
    assert answers(case) == dict.fromkeys(four.ANSWERS, False)
