"""The benchmark of walking: everyone's steps, every way of reaching, and the verdict."""

import json
from pathlib import Path

import pytest
from benchmarks import walking
from benchmarks.walking import PRODUCT, TICK_LIMIT_MS, Cost, Work


@pytest.mark.parametrize("ground", walking.GROUNDS)
def test_everyone_takes_steps(ground: str) -> None:
    cost = walking.cost_of(ground, avatars=5, ticks=20)
    assert (cost.ground, cost.avatars) == (ground, 5)
    # About two steps a second and avatar.
    assert 0.2 < cost.steps_a_tick < 1.0
    assert 0.0 < cost.tick_p50_ms <= cost.tick_p99_ms


def work(turned: float, reached_percent: float = 100.0) -> Work:
    return Work(reached_percent, turned, 10, 5.0, 1.0)


@pytest.mark.parametrize(
    ("tick_ms", "turned", "reached", "short"),
    [
        (1.0, 10.0, 100.0, False),
        (TICK_LIMIT_MS + 1.0, 10.0, 100.0, True),
        (1.0, 90.0, 100.0, True),
        (1.0, 10.0, 98.0, True),
    ],
)
def test_verdict(tick_ms: float, turned: float, reached: float, short: bool) -> None:
    cost = Cost("level", 1000, tick_ms, 2.0 * tick_ms, 100.0, 1.0, 1.0, 0.2, 1.0)
    ways = {"plain CCD": work(100.0), PRODUCT: work(turned, reached)}
    reaching = dict.fromkeys(walking.LEAST_SAVED, ways)
    assert walking.falls_short([cost], reaching) is short


def test_figures_are_shown_and_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(walking, "TARGETS", 40)
    file = tmp_path / "walking.json"
    walking.main(["--avatars", "2", "--ticks", "4", "--json", str(file)])
    shown = capsys.readouterr().out
    assert "15 (15) of 15" in shown
    assert "limb is enough" in shown
    figures = json.loads(file.read_text())
    assert figures["costs"][0]["avatars"] == 2
    assert set(figures["reaching"]) == set(walking.LEAST_SAVED)
    assert [15, 15] in figures["table3"].values()
