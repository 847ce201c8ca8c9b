import numpy as np
import pytest

from esplanade.server.metrics import Durations, Metrics


def test_percentiles_are_those_of_the_latest_durations() -> None:
    durations = Durations()
    assert durations.percentile(50) == 0.0
    values = np.random.default_rng(1).uniform(0.0, 0.05, 30_000).astype(np.float32)
    for value in values:
        durations.add(float(value))
    assert durations.percentile(99) == pytest.approx(np.percentile(values[-24_000:], 99))
    assert durations.percentile(50, 1_200) == pytest.approx(np.percentile(values[-1_200:], 50))


def test_traffic_is_read_when_it_is_asked_for() -> None:
    metrics = Metrics()
    metrics.traffic.bytes_out += 1234
    assert b"esplanade_bytes_out_total 1234.0" in metrics.exposition()


def test_a_tick_shows_in_histogram_percentiles_and_stages() -> None:
    metrics = Metrics()
    metrics.tick_took(0.012, {"people": 0.002, "actors": 0.009})
    text = metrics.exposition().decode()
    assert 'esplanade_tick_duration_seconds_bucket{le="0.015"} 1.0' in text
    assert 'esplanade_tick_stage_seconds_total{stage="actors"} 0.009' in text
    assert metrics.ticks.percentile(50) == pytest.approx(0.012)


def test_two_servers_in_one_process_do_not_share_metrics() -> None:
    one, other = Metrics(), Metrics()
    one.chat_lines.inc()
    assert b"esplanade_chat_lines_total 0.0" in other.exposition()


def test_figures_of_zones_have_the_zone_as_a_label() -> None:
    metrics = Metrics(["yard", "hall"])
    yard, hall = metrics.of_zone("yard"), metrics.of_zone("hall")
    metrics.gauge("connections", "Of all zones", lambda: 3)
    yard.gauge("people", "In each zone", lambda: 2)
    hall.gauge("people", "In each zone", lambda: 1)
    yard.tick_took(0.012, {"people": 0.002})
    lines = metrics.exposition().decode().splitlines()
    assert "esplanade_connections 3.0" in lines
    assert 'esplanade_people{zone="yard"} 2.0' in lines
    assert 'esplanade_people{zone="hall"} 1.0' in lines
    assert 'esplanade_tick_stage_seconds_total{stage="people",zone="yard"} 0.002' in lines
    assert 'esplanade_tick_duration_seconds_count{zone="yard"} 1.0' in lines
    assert yard.ticks.percentile(50) == pytest.approx(0.012)
    assert hall.ticks.percentile(50) == 0.0


def test_a_world_has_ticked_when_all_of_its_zones_have() -> None:
    metrics = Metrics(["yard", "hall"])
    begun = metrics.ticked_at
    metrics.of_zone("yard").tick_took(0.01, {})
    assert metrics.ticked_at == begun
    metrics.of_zone("hall").stood()
    assert metrics.ticked_at > begun


def test_a_figure_has_one_value_for_a_zone() -> None:
    metrics = Metrics()
    metrics.gauge("people", "In the world", lambda: 2)
    with pytest.raises(ValueError, match="the figure esplanade_people is there already"):
        metrics.gauge("people", "In the world", lambda: 2)
