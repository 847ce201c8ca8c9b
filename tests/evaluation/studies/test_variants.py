"""Variants are equal if they behave the same."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from esplanade.evaluation.measures import MEASURES
from esplanade.evaluation.runner import run_trials
from esplanade.evaluation.settings import DEFAULTS
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
    results = run_trials(trials, 1, lambda _: None)
    tables = tables_of(results, {source: source.path.stem for source in sources})
    assert list(tables) == [Variant(RULES), wary]
    assert [list(rows) for rows in tables.values()] == [["plaza", "market"]] * 2
    shapes = {there.values.shape for rows in tables.values() for there in rows.values()}
    assert shapes == {(2, len(MEASURES))}
    (town,) = tables_of(results, dict.fromkeys(sources, "town"))[wary].values()
    apart = [there.values for there in tables[wary].values()]
    np.testing.assert_array_equal(town.values, np.concatenate(apart))
    assert town.count == sum(there.count for there in tables[wary].values())
