"""Settings of the command: defaults, where they come from, what does not fit together."""

import os
from pathlib import Path
from typing import Any

import pytest
from pydantic import SecretStr, ValidationError

from esplanade.bots.settings import CLIENTS_PER_PROCESS, BotsSettings


@pytest.fixture(autouse=True)
def _no_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in list(os.environ):
        if name.startswith("ESPLANADE_"):
            monkeypatch.delenv(name)


def test_defaults() -> None:
    """Pinned: scripts rely on them."""
    assert BotsSettings().model_dump() == {
        "url": "ws://localhost:8080",
        "trust": None,
        "token": SecretStr(""),
        "count": 20,
        "duration": 60.0,
        "seed": 0,
        "join_rate": 50.0,
        "stages": None,
        "scenario": None,
        "processes": None,
        "replay": None,
        "speedup": 1.0,
        "limit": None,
        "linger": 0.0,
        "fps": None,
        "unit": None,
        "scale": None,
        "columns": None,
        "strict": False,
        "fail_if": (),
        "json_file": None,
        "csv_file": None,
        "html_file": None,
    }


def test_the_environment_counts_less_than_the_command_line(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("ESPLANADE_BOTS_COUNT", "7")
    monkeypatch.setenv("ESPLANADE_BOTS_SEED", "8")
    settings = BotsSettings(count=9)
    assert (settings.count, settings.seed) == (9, 8)


def test_every_setting_is_explained() -> None:
    for name, field in BotsSettings.model_fields.items():
        assert field.description, name
        assert isinstance(field.json_schema_extra, dict), name
        assert field.json_schema_extra["group"], name


@pytest.mark.parametrize(
    ("given", "fault"),
    [
        ({"count": 0}, "greater than or equal to 1"),
        ({"duration": -1.0}, "greater than or equal to 0"),
        ({"url": "gopher://x"}, "unknown scheme 'gopher'"),
        ({"limit": 3}, "limit: belongs to a replay"),
        ({"linger": 1.0, "speedup": 2.0}, "linger: belongs to a replay"),
        ({"replay": Path("a.csv"), "count": 3}, "count: belongs to a load test"),
        ({"replay": Path("a.csv"), "speedup": 0.0}, "greater than or equal to 0.1"),
    ],
)
def test_what_does_not_fit_is_told(given: dict[str, Any], fault: str) -> None:
    with pytest.raises(ValidationError, match=fault):
        BotsSettings(**given)


@pytest.mark.parametrize(
    ("cores", "given", "processes"),
    [
        (2, {"count": 1}, 1),
        (2, {"count": 10_000}, 1),
        (8, {"count": CLIENTS_PER_PROCESS}, 1),
        (8, {"count": CLIENTS_PER_PROCESS + 1}, 2),
        (8, {"count": 10_000}, 7),
        (1, {"count": 100}, 1),
        (2, {"count": 100, "processes": 4}, 4),
        (2, {"count": 3, "processes": 4}, 3),
    ],
)
def test_processes_follow_the_count_and_leave_a_core_to_the_server(
    monkeypatch: pytest.MonkeyPatch, cores: int, given: dict[str, Any], processes: int
) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: cores)
    assert BotsSettings(**given).process_count == processes
