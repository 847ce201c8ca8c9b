"""Two minutes of a zone to which all happens that may, run again on one thread and on two."""

import random
import time
from functools import partial
from pathlib import Path

import pytest

from esplanade import cli
from esplanade.actors import navigator
from esplanade.planning import PlanModel
from esplanade.planning.agents import batch
from esplanade.server.recording.head import Built, Head
from esplanade.server.recording.zone_recording import ZoneRecording
from tests.server.recording.happenings import MAKERS, OFTEN, Happening, hall, input_of

SECONDS = 120
TICKS = 20 * SECONDS
HAPPENS = 0.1
"""The share of ticks in which something happens."""


def test_all_digests_of_two_minutes_are_equal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    # Without the time that work takes there is no rest after it; few actors are worth a thread.
    monkeypatch.setattr("esplanade.server.net.ground_work.taken_s", lambda: 0.0)
    monkeypatch.setattr(batch, "_WORTH_A_THREAD", 1)
    path, chance, world = tmp_path / "soak.mcap", random.Random(5), hall()
    built = Built.of(world.zone, "soak", 3, 0.25)
    faults: list[object] = []
    recording = ZoneRecording(world.zone, Head.of(world.zone, built), path, faults.append)
    for number in range(1, TICKS + 1):
        given = []
        if chance.random() < HAPPENS:
            kind = chance.choice([*MAKERS, *OFTEN])
            happening = Happening(0, kind, chance.randrange(12), chance.random())
            given = [input_of(world, happening, number)]
        frame = world.frame(*given)
        while recording.waiting > 5:  # this world is faster than the clock
            time.sleep(0.01)
        recording.take(frame, world.inputs[-1])
    recording.close()
    world.population.close()
    assert not faults
    for threads in (1, 2):
        monkeypatch.setattr(navigator, "PlanModel", partial(PlanModel, threads=threads))
        code = cli.main(["replay", str(path), "--verify"])
        told = capsys.readouterr()
        assert code == 0, told.err
        assert f"{SECONDS + 1} digests, all equal" in told.out
