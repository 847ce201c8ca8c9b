"""Operators begin and end recordings of a world that runs, each of which runs again bit for bit."""

import asyncio
from pathlib import Path
from typing import Any

import pytest

from esplanade import bots, cli
from esplanade.server.app import Running, running
from esplanade.server.recording.folder import is_being_written
from esplanade.server.settings import ServerSettings
from tests.patience import COMPILING_PATIENCE_S
from tests.server.console.operators import Operator, operator
from tests.server.populated import HALL


@pytest.fixture
def settings(tmp_path: Path) -> ServerSettings:
    path = tmp_path / "hall.json"
    path.write_text(HALL.model_copy(update={"name": "hall"}).model_dump_json(exclude_defaults=True))
    return ServerSettings(
        scene=path,
        actors=3,
        seed=4,
        port=0,
        private_port=0,
        record=tmp_path / "recordings",
        record_later=True,
    )


async def told(by: Operator) -> Any:
    return (await by.get("/world"))[1]["recording"]


async def recorded(by: Operator, seconds: int) -> dict[str, Any]:
    """Wait until so many seconds of the world are written."""
    while (found := await told(by))["seconds"] < seconds:  # noqa: ASYNC110 - no event tells of it
        await asyncio.sleep(0.05)
    return dict(found)


def events_of(server: Running) -> list[tuple[str, str]]:
    """The codes and files of the events of recordings so far."""
    found = [event.told(names=False) for event in server.live.events]
    return [
        (each["arguments"]["code"], each["arguments"]["file"])
        for each in found
        if each["kind"] == "recording"
    ]


async def test_recordings_begin_and_end_while_people_are_there(
    settings: ServerSettings, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "recordings"
    async with asyncio.timeout(COMPILING_PATIENCE_S), running(settings) as server:
        olga = await operator(server, "olga", "director")
        off = {"state": "off", "file": None, "bytes": 0, "seconds": 0, "fault": None}
        assert await told(olga) == off
        async with bots.connect(f"ws://localhost:{server.port}", name="Narcissus") as bot:
            await bot.move(0.5, 1.2)
            for file in ("hall.mcap", "hall-2.mcap"):
                status, answer = await olga.send({"op": "record", "on": True, "note": "look"})
                assert status == 200, answer
                found = await recorded(olga, 2)
                assert (found["state"], found["file"], found["fault"]) == ("on", file, None)
                assert found["bytes"] > 1000
                assert is_being_written(folder / file)
                assert (await olga.send({"op": "record", "on": False}))[0] == 200
                assert not is_being_written(folder / file)
                assert await told(olga) == off
        assert (await olga.send({"op": "record", "on": True}))[0] == 200
        assert (await olga.send({"op": "revert"}))[0] == 200
        assert (await told(olga))["state"] == "off"
        audit = (await (await operator(server, "ada", "auditor")).get("/audit"))[1]["rows"]
        while len(found_events := events_of(server)) < 6:  # noqa: ASYNC110 - a thread tells of them
            await asyncio.sleep(0.05)
    files = ["hall.mcap", "hall-2.mcap", "hall-3.mcap"]
    assert found_events == [(code, file) for file in files for code in ("begun", "complete")]
    assert [row["command"] for row in audit].count("record") >= 5
    for file in files[:2]:
        assert cli.main(["replay", str(folder / file), "--verify"]) == 0
    assert "all equal" in capsys.readouterr().out


async def test_what_cannot_be_recorded_is_refused(settings: ServerSettings, tmp_path: Path) -> None:
    wrong = tmp_path / "recordings"
    wrong.write_text("this is no folder")
    command = {"op": "record", "on": True}
    async with asyncio.timeout(COMPILING_PATIENCE_S), running(settings) as server:
        olga = await operator(server, "olga", "director")
        tom = await operator(server, "tom", "tuner")
        assert (await tom.send(command))[0] == 403
        assert (await olga.send({"op": "record"}))[0] == 422
        _, answer = await olga.send([command, {"op": "mark", "text": "now"}])
        assert [fault["code"] for fault in answer["faults"]] == ["not_alone"]
        _, answer = await olga.send(command)
        (fault,) = answer["faults"]
        assert fault["code"] == "not_recorded"
        assert "recordings" in fault["text"]
        assert (await told(olga))["state"] == "off"
        assert (await olga.send({**command, "on": False}))[0] == 200
    nowhere = settings.model_copy(update={"record": None, "record_later": False})
    async with asyncio.timeout(COMPILING_PATIENCE_S), running(nowhere) as server:
        olga = await operator(server, "olga", "director")
        assert await told(olga) is None
        _, answer = await olga.send(command)
        (fault,) = answer["faults"]
        assert (fault["code"], fault["path"]) == ("no_recordings", ["on"])


async def test_a_shell_records(
    settings: ServerSettings, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    async def op(*words: str) -> str:
        assert await asyncio.to_thread(cli.main, ["op", *words]) == 0
        return capsys.readouterr().out

    async with asyncio.timeout(COMPILING_PATIENCE_S), running(settings) as server:
        olga = await operator(server, "olga", "director")
        monkeypatch.setenv("ESPLANADE_URL", f"http://127.0.0.1:{server.private_port}")
        monkeypatch.setenv("ESPLANADE_TOKEN", olga.token)
        assert "the world is not recorded" in await op("record")
        await op("record", "start", "--note", "the afternoon")
        await recorded(olga, 1)
        assert "on: hall.mcap, " in await op("record")
        await op("record", "stop")
        assert "the world is not recorded" in await op("record")
