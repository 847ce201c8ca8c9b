"""Variants are equal if they behave the same."""

from dataclasses import replace
from pathlib import Path

from esplanade.evaluation.runner import run_trials
from esplanade.evaluation.settings import DEFAULTS
from esplanade.evaluation.studies.measures import MEASURES
from esplanade.evaluation.studies.variants import LIMIT, Variant, tables_of, trials_of
from esplanade.evaluation.trials import Source
from tests.evaluation.worlds import RULES, busy_plaza, write_csv


def test_default_values_change_nothing() -> None:
    assert Variant.of(RULES, {"risk_weight": DEFAULTS["risk_weight"]}) == Variant(RULES)
    assert Variant.of(RULES, {"risk_weight": 1.0}) == Variant(RULES, (("risk_weight", 1.0),))


def test_settings_of_the_body_are_kept_even_at_their_defaults() -> None:
    slow = replace(RULES, speed_mps=0.8)
    assert Variant.of(slow, {"speed_mps": DEFAULTS["speed_mps"]}) != Variant(slow)


def test_the_rules_follow_the_limit_of_the_body() -> None:
    variant = Variant.of(RULES, {LIMIT: 0.7, "risk.comfort": 0.2})
    assert variant == Variant(replace(RULES, max_acceleration_mps2=0.7), (("risk.comfort", 0.2),))
    assert Variant.of(RULES, {LIMIT: RULES.max_acceleration_mps2}) == Variant(RULES)


def test_every_variant_walks_the_same_episodes_once(tmp_path: Path) -> None:
    sources = [Source(write_csv(tmp_path, busy_plaza(), name)) for name in ("plaza", "market")]
    wary = Variant.of(RULES, {"risk_weight": 30.0})
    trials = trials_of([Variant(RULES), wary, wary], sources, 2, 0)
    assert len(trials) == 4
    assert len({trial.episodes for trial in trials}) == 1
    tables = tables_of(run_trials(trials, 1, lambda _: None))
    assert list(tables) == [Variant(RULES), wary]
    assert [list(rows) for rows in tables.values()] == [sources, sources]
    assert all(t.shape == (2, len(MEASURES)) for rows in tables.values() for t in rows.values())
