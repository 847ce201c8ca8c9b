"""The values of each setting, the curves, and their picture."""

from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from esplanade.actors import ActorParameters
from esplanade.evaluation.measures import MEASURES
from esplanade.evaluation.settings import DEFAULTS, SettingError, check
from esplanade.evaluation.studies import sensitivity, sensitivity_plot
from esplanade.evaluation.studies.sensitivity import (
    BEHAVIOUR_PARAMETERS,
    BODY_PARAMETERS,
    MULTI_ACTOR_PARAMETERS,
    Curve,
)
from esplanade.evaluation.studies.variants import Tables
from esplanade.stats import Sample
from tests.evaluation.worlds import RULES

NEAR = [measure.name for measure in MEASURES].index("near_s")
BASE = {"risk_weight": 8.0}


def test_every_parameter_belongs_to_one_of_three_groups() -> None:
    assert set(BEHAVIOUR_PARAMETERS) | BODY_PARAMETERS | MULTI_ACTOR_PARAMETERS == set(
        ActorParameters.model_fields
    )
    assert "risk_weight" in BEHAVIOUR_PARAMETERS


def test_by_default_values_double_around_the_baseline_within_limits() -> None:
    taken = sensitivity.ranges(dict.fromkeys(BEHAVIOUR_PARAMETERS), {})
    for name, values in taken.items():
        assert DEFAULTS[name] in values
        assert list(values) == sorted(set(values))
        assert [check({name: value})[name] for value in values] == list(values)
    weight = DEFAULTS["risk_weight"]
    assert taken["risk_weight"] == tuple(weight * 2.0**k for k in range(-2, 3))
    assert all(isinstance(value, int) for value in taken["max_expansions"])
    (wide,) = sensitivity.ranges({"person_room_m": None}, {"person_room_m": 0.4}).values()
    assert wide == (0.1, 0.2, 0.4, 0.75)


def test_given_values_are_taken_beside_the_baseline() -> None:
    choices = {"risk_weight": (3.0, 100.0), "risk.comfort": None}
    taken = sensitivity.ranges(choices, {"risk_weight": 5.0, "risk.comfort": 0.2})
    assert taken == {"risk_weight": (3.0, 5.0, 100.0), "risk.comfort": (0.05, 0.1, 0.2, 0.4, 0.8)}


def test_a_setting_that_is_zero_takes_fractions_of_its_limit() -> None:
    taken = sensitivity.ranges({"wall_weight": None}, {"wall_weight": 0.0})
    assert taken == {"wall_weight": (0.0, 0.625, 1.25, 2.5, 5.0)}


def test_a_setting_that_cannot_be_scaled_needs_values() -> None:
    with pytest.raises(SettingError, match=r"prediction.printed is False: give its values"):
        sensitivity.ranges({"prediction.printed": None}, {})
    with pytest.raises(SettingError, match=r"risk.comfort is 0.0: give its values"):
        sensitivity.ranges({"risk.comfort": None}, {"risk.comfort": 0.0})


def measured(shift: float) -> Tables:
    """Tables of three places; `shift` is added to the time near people."""
    found: dict[str, Sample] = {}
    for k in range(3):
        rows = np.random.default_rng(k).uniform(0.0, 1.0, (40, len(MEASURES)))
        rows[:, NEAR] += shift
        found[f"{k}"] = Sample.of(rows, range(len(rows)))
    return found


@pytest.fixture
def curve() -> Curve:
    tables = {
        sensitivity.variant_of(RULES, BASE, "risk_weight", value): measured(shift)
        for value, shift in ((4.0, 0.3), (8.0, 0.0), (16.0, -1e-3))
    }
    values = {"risk_weight": (4.0, 8.0, 16.0)}
    (found,) = sensitivity.curves(values, BASE, RULES, tables, seed=0)
    return found


def test_a_difference_on_all_episodes_is_beyond_chance_however_much_these_scatter(
    curve: Curve,
) -> None:
    less, baseline, more = curve.points
    assert less.means[NEAR] == pytest.approx(baseline.means[NEAR] + 0.3)
    assert baseline.lows[NEAR] < more.means[NEAR] < baseline.highs[NEAR]
    assert [point.differs[NEAR] for point in curve.points] == [True, False, True]
    assert not any(differs for k, differs in enumerate(more.differs) if k != NEAR)


def test_every_point_is_in_the_json(curve: Curve) -> None:
    rows = sensitivity.figures([curve])
    assert [row["value"] for row in rows] == [point.value for point in curve.points]
    assert rows[0]["near_s"]["differs"] is True
    assert rows[0]["unit"] == "s/s"
    assert rows[0]["near_s"]["low"] < rows[0]["near_s"]["mean"] < rows[0]["near_s"]["high"]


@pytest.mark.skipif(find_spec("matplotlib") is None, reason="matplotlib is absent")
def test_the_picture_is_the_same_for_the_same_figures(curve: Curve, tmp_path: Path) -> None:
    pictures = [tmp_path / "one.svg", tmp_path / "two.svg"]
    for path in pictures:
        sensitivity_plot.draw(path, [curve, curve])
    one, two = (path.read_text() for path in pictures)
    assert one == two
    assert one.count("risk_weight") == 2
    assert all(measure.label in one for measure in MEASURES[: sensitivity_plot.SHOWN])


def test_labels_of_values_are_short() -> None:
    labels = [sensitivity_plot._short(value) for value in (0.0375, 0.75, 12.0, 100, 250.0, False)]
    assert labels == [".037", ".75", "12", "100", "250", "false"]
