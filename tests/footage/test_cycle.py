"""The cycle of far figures: what the client has is what Python makes."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from esplanade.actors.locomotion.reference.keyframes import KEYS, walked
from esplanade.footage.cycle import STEP, as_text, cycle

COMMITTED = Path(__file__).resolve().parents[2] / "client_web" / "src" / "world" / "cycle.json"


def numbers(value: Any, path: str = "") -> dict[str, float]:
    """Every number by its path in the value."""
    if isinstance(value, dict):
        parts = value.items()
    elif isinstance(value, list):
        parts = enumerate(value)
    else:
        return {path: value}
    return {k: v for key, part in parts for k, v in numbers(part, f"{path}/{key}").items()}


def mixed(made: dict[str, Any], phase: float, side: str) -> np.ndarray:
    """The place that the client gives a heel: on the straight line between two keys."""
    keys = made["keys"]
    k = max(n for n in range(KEYS) if keys[n]["phase"] <= phase)
    a, b = keys[k], keys[(k + 1) % KEYS]
    share = (phase - a["phase"]) / ((b["phase"] - a["phase"]) % 1.0)
    return np.array(a[side]["heel"]) * (1.0 - share) + np.array(b[side]["heel"]) * share


def test_the_client_has_the_cycle_that_python_makes():
    committed, made = numbers(json.loads(COMMITTED.read_text())), numbers(cycle())
    assert committed.keys() == made.keys()
    for where, value in made.items():
        assert committed[where] == pytest.approx(value, abs=2e-4), where


def test_text_is_json_with_rows_of_numbers_on_a_line():
    made = cycle()
    text = as_text(made)
    assert json.loads(text) == made
    assert max(map(len, text.splitlines())) < 80
    assert '    "root": [' in text


def test_keys_are_feet_on_the_ground_and_unit_quaternions():
    made = cycle()
    assert len(made["keys"]) == KEYS
    assert made["keys"][0]["left"]["heel"][2] == 0.0
    for posture in (made["stand"], *made["keys"]):
        for part in ("pelvis", "chest"):
            assert np.linalg.norm(posture[part]) == pytest.approx(1.0, abs=1e-3)
        assert 0.0 <= min(posture["left"]["heel"][2], posture["right"]["heel"][2]) < 0.03


def test_the_second_half_is_the_first_with_sides_exchanged():
    keys = cycle()["keys"]
    for first, second in zip(keys[:4], keys[4:], strict=True):
        assert second["phase"] == pytest.approx(first["phase"] + 0.5)
        assert second["root"] == pytest.approx(np.array(first["root"]) * [1, -1, 1], abs=2e-4)
        heel = np.array(first["left"]["heel"]) * [1, -1, 1]
        assert second["right"]["heel"] == pytest.approx(heel, abs=2e-4)


def test_standing_feet_hardly_slide_between_keys():
    made = cycle()
    phases = np.linspace(0.02, 0.45, 87)
    heels = np.array([mixed(made, phase, "left") for phase in phases])
    _, legs = walked(STEP, phases)
    assert np.max(np.abs(heels[:, :2] - legs.ankles[:, 0, :2])) < 0.02
