"""Settings by name: the known names, the allowed values, and the models made of them."""

import math
from pathlib import Path

import pytest

from esplanade.actors import ActorParameters
from esplanade.evaluation import setting_names
from esplanade.evaluation.settings import (
    DEFAULTS,
    SettingError,
    check,
    models_of,
    parameters_of,
    read_changes,
    read_choices,
)
from esplanade.planning import PlanModel, PredictionModel, RiskModel, RuleModel


def test_every_parameter_and_every_number_of_a_model_is_a_setting_with_its_default() -> None:
    assert DEFAULTS["risk_weight"] == ActorParameters().risk_weight
    assert DEFAULTS["risk.contact_margin_m"] == RiskModel().contact_margin_m
    assert DEFAULTS["prediction.samples"] == PredictionModel().samples
    assert DEFAULTS["plan.steps"] == PlanModel().steps
    assert DEFAULTS["rules.margin_m"] == RuleModel().margin_m
    assert not {"plan.threads", "prediction.spread"} & set(DEFAULTS)
    assert check(DEFAULTS) == DEFAULTS


def test_text_gets_the_type_of_its_setting() -> None:
    found = read_changes(
        [
            "risk_weight=12",
            "risk.contact_margin_m=0.05",
            "plan.steps=8",
            "prediction.calibration_s=inf",
        ]
    )
    assert found == {
        "risk_weight": 12.0,
        "risk.contact_margin_m": 0.05,
        "plan.steps": 8,
        "prediction.calibration_s": math.inf,
    }
    assert isinstance(found["plan.steps"], int)


def test_choices_are_several_values_or_a_mere_name() -> None:
    assert read_choices(["risk_weight=6,8", "foresight_s"]) == {
        "risk_weight": (6.0, 8.0),
        "foresight_s": None,
    }


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("risk_weigth=3", "--set risk_weigth: there is no such setting; did you mean risk_weight?"),
        ("plan.threads=2", "--set plan.threads: there is no such setting"),
        ("risk.contact_margin_m=x", "--set risk.contact_margin_m: Input should be a valid number"),
        ("risk.contact_margin_m=-1", "--set risk.contact_margin_m: -1.0 is negative"),
        ("risk.contact_margin_m=nan", "--set risk.contact_margin_m: nan is negative, or no number"),
        ("plan.steps=1.5", "--set plan.steps: Input should be a valid integer"),
        ("rules.margin_m=2", "--set rules.margin_m: Input should be less than or equal to 0.5"),
        ("speed_mps=3", "max_speed_mps (1.7) must not be below speed_mps (3.0)"),
        ("risk_weight", "--set 'risk_weight' is not NAME=VALUE"),
    ],
)
def test_settings_that_cannot_be_set_are_refused_with_a_reason(text: str, fault: str) -> None:
    with pytest.raises(SettingError) as caught:
        read_changes([text])
    assert fault in str(caught.value)


def test_the_command_line_knows_all_names() -> None:
    assert tuple(DEFAULTS) == setting_names.NAMES


def test_choices_are_checked_too() -> None:
    with pytest.raises(SettingError, match=r"--vary risk_weight: Input should be a valid number"):
        read_choices(["risk_weight=8,"])


def test_models_and_parameters_are_made_of_settings() -> None:
    settings = {
        "risk.contact_margin_m": 0.05,
        "plan.steps": 8,
        "rules.jam_actors": 20,
        "risk_weight": 12.0,
        "radius_m": 0.3,
    }
    models = models_of(settings)
    assert models.risk == RiskModel(contact_margin_m=0.05)
    assert models.plan == PlanModel(steps=8)
    assert models.prediction == PredictionModel()
    assert models.rules == RuleModel(jam_actors=20)
    made = parameters_of(settings, {"radius_m": 0.25, "speed_mps": 1.1})
    assert made == ActorParameters(risk_weight=12.0, radius_m=0.3, speed_mps=1.1)


def test_documents_name_settings_that_exist() -> None:
    text = (Path(__file__).parents[2] / "docs" / "evaluation.md").read_text()
    named = [part.split("=")[0] for part in text.split("--vary ")[1:]]
    assert named
    assert {name.strip("`\n").split()[0] for name in named} - {"NAME"} <= set(DEFAULTS)
