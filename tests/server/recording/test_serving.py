"""A served world is recorded with people in it, and runs again bit for bit."""

import asyncio
from pathlib import Path

import pytest

from esplanade import bots, cli
from esplanade.server.app import Running, running
from esplanade.server.loading import LoadingError
from esplanade.server.recording import zone_recording
from esplanade.server.recording.reader import Recording
from esplanade.server.settings import ServerSettings
from tests.patience import COMPILING_PATIENCE_S
from tests.server.client import joined
from tests.server.http import get
from tests.server.populated import HALL
from tests.server.recording.recorded import inputs_of_file
from tests.server.test_process import served


@pytest.fixture
def hall_file(tmp_path: Path) -> Path:
    path = tmp_path / "hall.json"
    scene = HALL.model_copy(update={"name": "The hall of /../ doors"})
    path.write_text(scene.model_dump_json(exclude_defaults=True))
    return path


@pytest.fixture
def settings(hall_file: Path, tmp_path: Path) -> ServerSettings:
    return ServerSettings(
        scene=hall_file,
        actors=3,
        seed=4,
        port=0,
        private_port=0,
        operator_key="secret",
        record=tmp_path / "recordings",
    )


async def ticks(server: Running, count: int) -> None:
    """Wait until the world has gone on by so many ticks."""
    until = server.world.tick + count
    while server.world.tick < until:  # noqa: ASYNC110 - a world has no event for its ticks
        await asyncio.sleep(0.05)


async def walk(server: Running) -> None:
    """A person who steers, goes to a point, has a door moved, and leaves."""
    url = f"ws://localhost:{server.port}"
    async with bots.connect(url, name="Narcissus", operator="secret") as bot:
        await bot.move(0.5, 1.2)
        await ticks(server, 15)
        await bot.set_door("gate", is_open=False)
        await bot.walk_to(3.0, 6.0)
        await ticks(server, 30)
        await bot.set_door("gate", is_open=True)
        await ticks(server, 30)
    await ticks(server, 10)


async def test_a_world_with_people_runs_again_bit_for_bit(
    settings: ServerSettings, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    async with asyncio.timeout(COMPILING_PATIENCE_S), running(settings) as server:
        await walk(server)
        metrics = server.metrics.exposition().decode()
    assert "esplanade_recording_ended 0.0" in metrics
    path = tmp_path / "recordings" / "The-hall-of-..-doors.mcap"
    given = inputs_of_file(path)
    kinds = {each["kind"] for each in given}
    assert {"join", "follow", "move_door", "door_derived", "potential_derived"} <= kinds
    assert "Narcissus" not in str(given)
    code = await asyncio.to_thread(cli.main, ["replay", str(path), "--verify"])
    told = capsys.readouterr()
    assert code == 0, told.err
    assert "all equal" in told.out
    page = tmp_path / "out.html"
    words = ["--set", "risk_weight=20", "--seeds", "2", "--report", str(page)]
    code = await asyncio.to_thread(cli.main, ["replay", str(path), *words])
    told = capsys.readouterr()
    assert code == 0, told.err
    assert "changed: risk_weight = 20." in told.out
    assert "<h1>What if: risk_weight = 20</h1>" in page.read_text()


async def test_a_killed_server_leaves_a_recording_up_to_its_last_second(
    hall_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "recordings"
    with served(hall_file, "--record", str(folder)) as server:
        async with joined(server.port, "Ann") as ann:
            written = 0.0
            while written < 4.0:
                await ann.ticks(10)
                page = (await get(server.private_port, "/metrics")).body.decode()
                line = next(one for one in page.splitlines() if one.startswith(WRITTEN))
                written = float(line.split()[1])
            server.process.kill()
            server.process.wait()
    (path,) = folder.glob("*.mcap")
    assert cli.main(["replay", str(path), "--verify"]) == 0
    told = capsys.readouterr().out
    assert "cut off" in told
    with Recording(path) as recording:
        assert len(list(recording.seconds())) >= int(written)


WRITTEN = "esplanade_recording_written_total "


async def test_a_world_goes_on_when_its_recording_ends(
    settings: ServerSettings, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(zone_recording, "MOST_SECONDS", 0)
    async with asyncio.timeout(COMPILING_PATIENCE_S), running(settings) as server:
        await ticks(server, 20)
        while len(list(server.live.events)) < 2:  # they are told of by another thread
            await ticks(server, 2)
        events = [event.told(names=False) for event in server.live.events]
        metrics = server.metrics.exposition().decode()
    assert "esplanade_recording_ended 1.0" in metrics
    begun, ended = [event for event in events if event["kind"] == "recording"]
    assert begun["arguments"]["code"] == "begun"
    assert ended["arguments"] == {"code": "too_slow", "file": "The-hall-of-..-doors.mcap"}


async def test_a_folder_that_cannot_be_written_is_said_at_the_start(
    settings: ServerSettings, tmp_path: Path
) -> None:
    (tmp_path / "file").touch()
    gone = settings.model_copy(update={"record": tmp_path / "file" / "recordings"})
    with pytest.raises(LoadingError, match=r"record: .*Not a directory"):
        async with running(gone):
            pass
