"""Tuning: the cost, the folds of the cross-validation, and files of candidates."""

import math
from pathlib import Path

import numpy as np
import pytest

from esplanade.evaluation.measures import MEASURES, Floats
from esplanade.evaluation.settings import SettingError
from esplanade.evaluation.studies import tuning
from esplanade.evaluation.studies.variants import Variant
from esplanade.stats import Sample
from tests.evaluation.worlds import RULES

GOALS = {measure.name: measure.goal for measure in MEASURES}
PLACES = ["plaza", "market", "station"]


def measures(**changes: float) -> Floats:
    """Measures that just meet all goals, except for some changes."""
    return np.array([{**GOALS, **changes}[measure.name] for measure in MEASURES])


def test_the_cost_of_just_meeting_all_goals_and_of_nothing_to_better() -> None:
    assert tuning.cost(measures()) == pytest.approx(4 * tuning.WEIGHT_BEYOND_GOALS)
    perfect = np.array([measure.best for measure in MEASURES])
    assert tuning.cost(perfect) == 0.0


def test_short_of_a_goal_costs_more_than_beyond_it_is_worth() -> None:
    just = tuning.cost(measures())
    assert tuning.cost(measures(contacts_percent=2.0)) - just == pytest.approx(1.1)
    assert just - tuning.cost(measures(contacts_percent=0.0)) == pytest.approx(0.1)
    assert tuning.cost(measures(time_ratio=1.18)) - just == pytest.approx(1.1)
    assert tuning.cost(measures(missed_percent=0.5)) - just == pytest.approx(0.5)


def test_candidates_that_never_arrive_are_never_chosen() -> None:
    assert tuning.cost(measures(time_ratio=math.nan)) == np.inf


def test_candidates_are_the_baseline_all_combinations_and_those_listed() -> None:
    grid = {"risk_weight": (6.0, 12.0), "risk.comfort": (0.0, 0.1)}
    found = tuning.candidates(grid, [{"foresight_s": 2}], {"turn_weight": 0.2})
    assert found[0] == {"turn_weight": 0.2}
    assert found[1] == {"turn_weight": 0.2, "risk_weight": 6.0, "risk.comfort": 0.0}
    assert found[-1] == {"turn_weight": 0.2, "foresight_s": 2.0}
    assert len(found) == 6


def test_without_a_grid_there_are_only_those_listed() -> None:
    assert tuning.candidates({}, [{"foresight_s": 2.0}], {}) == [{}, {"foresight_s": 2.0}]


def test_candidates_are_read_line_by_line(tmp_path: Path) -> None:
    path = tmp_path / "candidates.jsonl"
    path.write_text('{"risk_weight": 12}\n\n{"risk.comfort": 0.1, "plan.steps": 8}\n')
    assert tuning.read_candidates(path) == [
        {"risk_weight": 12.0},
        {"risk.comfort": 0.1, "plan.steps": 8},
    ]


@pytest.mark.parametrize(
    ("line", "fault"),
    [
        ("risk_weight", "Expecting value"),
        ("[1]", "a line must be one object of settings"),
        ('{"tempo": 3}', "tempo: there is no such setting"),
        ('{"risk_weight": -1}', "risk_weight: Input should be greater"),
    ],
)
def test_a_line_that_is_no_candidate_is_named(tmp_path: Path, line: str, fault: str) -> None:
    path = tmp_path / "candidates.jsonl"
    path.write_text('{"risk_weight": 12}\n' + line + "\n")
    with pytest.raises(SettingError) as caught:
        tuning.read_candidates(path)
    assert str(caught.value).startswith(f"{path}:2: ")
    assert fault in str(caught.value)


def test_a_file_of_candidates_that_is_missing_is_named(tmp_path: Path) -> None:
    with pytest.raises(SettingError, match=r"none.jsonl: cannot be read"):
        tuning.read_candidates(tmp_path / "none.jsonl")


def rows(contacts_percent: float) -> Sample:
    return Sample.of([measures(contacts_percent=contacts_percent)] * 10, range(10))


UNCHANGED = Variant(RULES)
EVEN = Variant(RULES, (("risk_weight", 9.0),))
LUCKY = Variant(RULES, (("risk_weight", 99.0),))
"""A candidate that is excellent on the plaza and poor elsewhere."""

CONTACTS = {UNCHANGED: (4.0, 4.0, 4.0), EVEN: (3.0, 3.0, 3.0), LUCKY: (0.0, 4.0, 3.5)}


def test_the_choice_for_a_place_is_not_made_there() -> None:
    tables = {
        variant: dict(zip(PLACES, map(rows, contacts), strict=True))
        for variant, contacts in CONTACTS.items()
    }
    found = tuning.tune(tables, UNCHANGED, seed=0)
    assert [variant for variant, _, _ in found.ranked] == [LUCKY, EVEN, UNCHANGED]
    assert found.confidence_percent == 100.0
    plaza, market, station = found.folds
    assert [fold.left_out for fold in found.folds] == PLACES
    assert plaza.chosen == EVEN  # without the plaza the lucky candidate is the worse one
    assert plaza.cost == pytest.approx(float(tuning.cost(measures(contacts_percent=3.0))))
    assert plaza.least_cost == pytest.approx(float(tuning.cost(measures(contacts_percent=0.0))))
    assert market.chosen == station.chosen == LUCKY
    assert market.cost == pytest.approx(market.baseline_cost)
    figures = tuning.figures(found)
    assert [fold["left_out"] for fold in figures["folds"]] == ["plaza", "market", "station"]
    assert figures["candidates"][0]["settings"] == {"risk_weight": 99.0}
    assert figures["folds"][0]["contacts_percent"] == pytest.approx(3.0)


def test_equal_candidates_leave_all_as_it_is() -> None:
    tables = {v: {place: rows(2.0) for place in PLACES} for v in (UNCHANGED, EVEN)}
    found = tuning.tune(tables, UNCHANGED, seed=0)
    assert found.ranked[0][0] == UNCHANGED
    assert {fold.chosen for fold in found.folds} == {UNCHANGED}
    assert found.confidence_percent == 0.0
