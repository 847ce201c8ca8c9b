"""Feet as a client sees them: the judge sees what slides, and a recorded crowd's feet do not."""

import asyncio
import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from benchmarks import steps as benchmark
from benchmarks._slide import judge
from benchmarks._step_log import Seen, cost_of
from benchmarks._treads import Flight, judge_treads
from benchmarks._turned_scenes import Turn

from esplanade.actors.locomotion.motion.key_poses import ANKLE
from esplanade.planning import Scene
from esplanade.planning.scene.scene_file import read_scene
from esplanade.protocol.steps import RE_AIMED
from esplanade.recordings import Crowd, Track, read_crowd
from esplanade.server.settings import ServerSettings
from esplanade.server.world.inputs import Steer
from esplanade.server.world.step_records import from_records
from tests.recordings.data import recorded
from tests.server.worlds import FIELD, Trial

TICK_RATE = 20
WALK_S = 6


def a_walk(
    speed_mps: float = 1.3,
    scene: Scene = FIELD,
    start: tuple[float, float] = (50.0, 50.0),
    heading: float = 0.3,
) -> Seen:
    """Somebody who stands, walks straight on and stops, as the world itself has it."""
    trial = Trial(scene=scene)
    (ann,) = trial.join(start)
    world = trial.world
    slot = world.state.slot(ann)
    seen = Seen(float(world.state.legs_m[slot]), float(world.state.statures_m[slot]))
    for k in range(WALK_S * TICK_RATE):
        steering = {10: speed_mps, (WALK_S - 2) * TICK_RATE: 0.0}
        trial.tick(*([Steer(ann, k, heading, steering[k])] if k in steering else []))
        if world.steps.begun[slot] == world.tick or not seen.records:
            seen.records.append(world.steps.records[slot].copy())
            seen.heard.append(world.tick)
        seen.places.append((world.tick, *trial.position(ann)))
    seen.until = world.tick
    return seen


def spoilt(seen: Seen, change: Callable[[np.void], None]) -> Seen:
    """The same walk; in its middle a record comes again, with something changed."""
    row = len(seen.records) // 2
    record = seen.records[row].copy()
    record["tick"] += 2
    record["ticks"] -= 2
    record["flags"] |= RE_AIMED
    change(record)
    records = [*seen.records[: row + 1], record, *seen.records[row + 1 :]]
    heard = [*seen.heard[: row + 1], int(record["tick"]), *seen.heard[row + 1 :]]
    return Seen(seen.leg_m, seen.stature_m, records, heard, seen.places, seen.until)


def test_the_feet_of_a_walk_stay_where_they_stand() -> None:
    found = judge([a_walk()], TICK_RATE)
    assert len(found.slide) > 2 * WALK_S * 60 * 0.5
    assert found.slide.max() < 1e-3
    assert found.drift.max() < 2e-3
    assert found.landing.max() < 0.2e-3
    assert found.jump_feet.max() < 2e-3
    assert found.jump_root.max() < 2e-3
    assert len(found.drift) >= 6
    assert np.median(np.abs(found.step_m - found.travel_m)) < 0.05
    assert np.median(found.off_body) < 0.1


def test_a_footprint_that_moves_is_seen_as_a_slide() -> None:
    def slide(record: np.void) -> None:
        record["standing"]["position"][0] += 200
        record["landing"]["offset"][0] -= 200

    found = judge([spoilt(a_walk(), slide)], TICK_RATE)
    assert found.slide.max() == pytest.approx(0.02, abs=0.003)
    assert found.drift.max() > 0.015


def test_a_pose_that_jumps_is_seen() -> None:
    def jump(record: np.void) -> None:
        for end in ("first", "last"):
            record[end]["root"][2] -= 500

    found = judge([spoilt(a_walk(), jump)], TICK_RATE)
    assert found.jump_root.max() > 0.045


def test_a_foot_that_misses_its_footprint_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = a_walk()
    row = len(seen.records) // 2
    steps = from_records(seen.steps)
    steps.keys[row, -1, ANKLE.start + 1] -= 0.03
    monkeypatch.setattr("benchmarks._slide.from_records", lambda _: steps)
    assert judge([seen], TICK_RATE).landing.max() == pytest.approx(0.03, abs=0.003)


def test_feet_are_held_against_the_treads_of_a_turned_flight(tmp_path: Path) -> None:
    degrees, path = 30.0, tmp_path / "flight.json"
    flight = Flight.at_angle(degrees)
    flight.write(path)
    seen = a_walk(0.9, read_scene(path), flight.turn.at(-1.0), math.radians(degrees))
    found = judge_treads([seen], TICK_RATE, flight)
    assert len(found.off_tread) >= 6
    assert found.off_tread.max() < 1e-3
    assert found.hanging.max() < 1e-3
    assert np.percentile(found.cut, 95) < 0.01
    elsewhere = Flight(Turn(degrees, flight.turn.at(-0.15)))
    other = judge_treads([seen], TICK_RATE, elsewhere)
    assert other.hanging.max() > 0.05
    assert np.percentile(other.cut, 95) > 0.01


def test_the_busiest_stretch_of_a_recording_is_replayed() -> None:
    def track(name: str, start_s: float, end_s: float) -> Track:
        return Track(name, np.array([start_s, end_s]), np.zeros((2, 2)))

    alone = [track("early", 0.0, 5.0), track("late", 90.0, 95.0)]
    crowd = [track(f"c{k}", 40.0 + k, 50.0 + k) for k in range(4)]
    found = benchmark.busiest(Crowd("made up", (*alone, *crowd)), 10.0)
    assert [one.id for one in found] == ["c0", "c1", "c2", "c3"]


def test_a_recorded_crowd_is_seen_to_walk_without_sliding() -> None:
    """Over real sockets, live; judged from what one bot receives and nothing else."""
    path = recorded("zara1")
    settings = ServerSettings(
        crowd=path, actors=5, host="127.0.0.1", port=0, private_port=0, log_level="error"
    )
    log, everyone, seconds = asyncio.run(benchmark.watch(settings, read_crowd(path), 12.0))
    found, cost = judge(everyone, log.tick_rate), cost_of(log, everyone, seconds)
    assert cost.steps > 200
    assert cost.visible_at_once > 10
    assert np.percentile(found.slide, 99) < 0.2e-3
    assert found.slide.max() < 2e-3
    assert found.landing.max() < 0.2e-3
    assert np.percentile(found.jump_feet, 99) < 1e-3
    assert abs(found.step_m.mean() / found.travel_m.mean() - 1.0) < 0.03
    assert 100.0 < cost.for_each_visible < 1500.0


def test_the_figures_are_written_for_programs(tmp_path, capsys) -> None:
    file = tmp_path / "figures.json"
    assert benchmark.main(["--seconds", "2", "--actors", "2", "--json", str(file)]) == 0
    found = json.loads(file.read_text())
    assert set(found["mm"]) == {name for _, name in benchmark.MILLIMETRES}
    assert found["cost"]["step_bytes"] > 0
    assert "bytes/s for each visible" in " ".join(capsys.readouterr().out.split())
