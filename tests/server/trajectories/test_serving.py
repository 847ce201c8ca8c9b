"""Trajectories of a served world: people and actors, without names, and a world that goes on."""

import asyncio
from pathlib import Path

import pytest

from esplanade import bots
from esplanade.recordings import read_crowd
from esplanade.server.app import Running, running
from esplanade.server.loading import LoadingError
from esplanade.server.settings import ServerSettings
from esplanade.server.trajectories import writer as module
from esplanade.server.trajectories.keeping import command_of
from tests.patience import PATIENCE_S
from tests.server.worlds import ROOM


@pytest.fixture
def settings(tmp_path: Path) -> ServerSettings:
    scene = tmp_path / "room.json"
    scene.write_text(ROOM.model_dump_json(exclude_defaults=True))
    return ServerSettings(
        scene=scene,
        actors=2,
        seed=4,
        port=0,
        private_port=0,
        operator_key="secret",
        trajectories=tmp_path / "day.csv",
        trajectories_hz=10.0,
    )


async def ticks(server: Running, count: int) -> None:
    """Wait until the world has gone on by so many ticks."""
    until = server.world.tick + count
    while server.world.tick < until:  # noqa: ASYNC110 - a world has no event for its ticks
        await asyncio.sleep(0.05)


async def test_people_and_actors_are_written_while_the_world_runs(
    settings: ServerSettings, tmp_path: Path
) -> None:
    async with asyncio.timeout(PATIENCE_S), running(settings) as server:
        async with bots.connect(f"ws://localhost:{server.port}", name="Narcissus"):
            await ticks(server, 40)
        metrics = server.metrics.exposition().decode()
    assert "esplanade_trajectories_ended 0.0" in metrics
    text = (tmp_path / "day.csv").read_text()
    crowd = read_crowd(tmp_path / "day.csv")
    assert len(crowd.tracks) == 3
    assert crowd.report is not None
    assert crowd.report.sample_s == pytest.approx(0.1)
    assert '"kind":"person"' in text
    assert "Narcissus" not in text
    assert "# command: esplanade serve --scene room.json --actors 2 --seed 4\n" in text
    assert "secret" not in text
    assert text.rstrip().endswith("end: {}")


async def test_a_world_goes_on_when_its_file_ends(
    settings: ServerSettings, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "MOST_BYTES", 0)
    async with asyncio.timeout(PATIENCE_S), running(settings) as server:
        await ticks(server, 20)
        while not list(server.live.events):  # they are told of by another thread
            await ticks(server, 2)
        events = [event.told(names=False) for event in server.live.events]
        metrics = server.metrics.exposition().decode()
    assert "esplanade_trajectories_ended 1.0" in metrics
    (event,) = [event for event in events if event["kind"] == "trajectories"]
    assert event["arguments"] == {"code": "too_slow", "file": "day.csv"}
    assert "takes less than the world gives" in event["text"]


async def test_a_file_that_cannot_be_written_is_said_at_the_start(
    settings: ServerSettings, tmp_path: Path
) -> None:
    gone = settings.model_copy(update={"trajectories": tmp_path / "no" / "day.csv"})
    with pytest.raises(LoadingError, match=r"trajectories: .*No such file or directory"):
        async with running(gone):
            pass


def test_a_command_without_what_may_be_secret(settings: ServerSettings) -> None:
    assert command_of(settings) == "esplanade serve --scene room.json --actors 2 --seed 4"
