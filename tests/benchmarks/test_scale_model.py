"""The simulation of a world of many zones: people are conserved, and costs are those of where they
are."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from benchmarks import scale_model
from benchmarks._scale_constants import Constants
from benchmarks._scale_costs import costs_of
from benchmarks._scale_world import DAY_S, Plan, simulate

PLAN = Plan(
    zones=12,
    people=2400,
    most_in_zone=400,
    seconds=60,
    hop_s=30.0,
    move_s=0.0,
    gateway_people=150,
    host_deaths_a_day=0.0,
    gateway_deaths_a_day=0.0,
)


def seeded() -> np.random.Generator:
    return np.random.default_rng(5)


def test_people_are_conserved_and_no_zone_is_fuller_than_it_may_be() -> None:
    run = simulate(PLAN, Constants(), seeded())
    begun = run.seconds[0].in_zone.max()
    for second in run.seconds:
        assert second.in_zone.sum() == second.at_gateway.sum() == PLAN.people
        # Those who hop in one second do not see each other.
        assert second.in_zone.max() <= max(begun, PLAN.most_in_zone + 40)
    hops = np.mean([second.hops for second in run.seconds])
    # Some find the zone full that they wanted to go to.
    assert 0.5 < hops * PLAN.hop_s / PLAN.people < 1.1
    again = simulate(PLAN, Constants(), seeded())
    assert np.array_equal(again.seconds[-1].in_zone, run.seconds[-1].in_zone)


def test_whoever_stays_at_a_gateway_brings_frames_of_other_zones_to_it() -> None:
    runs = {
        move_s: simulate(replace(PLAN, move_s=move_s), Constants(), seeded())
        for move_s in (0.0, 20.0, math.inf)
    }
    last = {move_s: run.seconds[-1] for move_s, run in runs.items()}
    assert last[0.0].frames <= runs[0.0].gateways
    assert last[0.0].frames < last[20.0].frames < last[math.inf].frames
    assert last[math.inf].frames > 0.9 * PLAN.zones * runs[math.inf].gateways


def test_costs_are_sums_of_the_constants() -> None:
    constants = Constants()
    second = simulate(replace(PLAN, zones=1, people=100), constants, seeded()).seconds[-1]
    costs = costs_of(second, constants)
    ticks = constants.tick_hz
    tick_us = constants.host_tick_us + constants.zone_tick_us + 100 * constants.zone_person_us
    made_us = constants.message_us + 100 * constants.frame_make_us
    pairs = second.frames
    batches_us = pairs * constants.message_us
    assert costs.zone_cores == pytest.approx(1e-6 * ticks * (tick_us + made_us + batches_us))
    gateways_us = len(second.at_gateway) * constants.gateway_tick_us
    shown_us = constants.gateway_zone_us + constants.message_us
    read_us = pairs * (shown_us + 100 * constants.frame_read_us)
    edge_us = gateways_us + read_us + batches_us + 100 * constants.viewer_us
    assert costs.gateway_cores == pytest.approx(1e-6 * ticks * edge_us)
    carried = 1 + 2 * pairs
    assert costs.broker_cores == pytest.approx(1e-6 * ticks * carried * constants.broker_message_us)
    frame = constants.frame_head_bytes + 100 * constants.frame_avatar_bytes
    upward = 100 * constants.inputs_s * constants.input_bytes
    assert costs.inside_bytes == pytest.approx(ticks * frame + upward)
    seen_bytes = constants.seen_avatar_bytes_s * constants.seen_part * 99
    assert costs.out_bytes == pytest.approx(100 * (constants.lone_viewer_bytes_s + seen_bytes))
    crowd = simulate(replace(PLAN, zones=1, people=400), constants, seeded()).seconds[-1]
    assert costs_of(crowd, constants).out_bytes == pytest.approx(400 * constants.viewer_bytes_s)


def test_pauses_are_of_those_who_were_there() -> None:
    plan = replace(PLAN, host_deaths_a_day=DAY_S / 20.0, gateway_deaths_a_day=DAY_S / 20.0)
    constants = Constants()
    run = simulate(plan, constants, seeded())
    pauses = run.host_pauses_s
    assert len(pauses) == pytest.approx(PLAN.people * PLAN.seconds / 20.0, rel=0.4)
    least = constants.lease_s - constants.renew_s + 0.5 * constants.take_over_s
    assert pauses.min() >= least
    assert pauses.max() <= constants.lease_s + 1.5 * constants.take_over_s
    assert run.gateway_pauses_s.min() >= 0.5 * constants.come_back_s


def test_the_command_prints_figures_and_refuses_unknown_constants(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = ["--zones", "4", "--people", "50", "--seconds", "10"]
    assert scale_model.main([*given, "--plots", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    assert "4 zones, 200 people, 10 s" in told
    assert "inside, MB/s" in told
    path = tmp_path / "constants.json"
    for wrong, why in (
        ({"lease": 3}, "there is no constant 'lease'"),
        ({"lease_s": 0}, "lease_s: 0"),
    ):
        path.write_text(json.dumps(wrong))
        assert scale_model.main([*given, "--constants", str(path)]) == 2
        assert why in capsys.readouterr().err
