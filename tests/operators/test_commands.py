"""The parts of `esplanade op` that ask a server, against real ones."""

import asyncio
import json
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import Any

import pytest

from esplanade.cli import main
from esplanade.protocol import VERSION, CloseCode, NoticeCode
from esplanade.protocol.messages import Hello, Notice
from tests.server.client import Client, connected, joined
from tests.server.conftest import Serving, room_file, serving, serving_assets
from tests.server.console.operators import operator

__all__ = ["room_file", "serving", "serving_assets"]

Told = Callable[..., Coroutine[Any, Any, str]]


@pytest.fixture
def told(capsys: pytest.CaptureFixture[str]) -> Told:
    """The output of `esplanade op`; its exit code is `code`, and faults are printed too."""

    async def tell(*words: str, code: int = 0) -> str:
        try:
            found = await asyncio.to_thread(main, ["op", *words])
        except SystemExit as end:
            found = int(end.code or 0)
        shown = capsys.readouterr()
        assert found == code, shown.err
        return shown.out + shown.err

    return tell


def _here(server: Any, token: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ESPLANADE_URL", f"http://127.0.0.1:{server.private_port}")
    monkeypatch.setenv("ESPLANADE_TOKEN", token)


async def _notice(client: Client, code: NoticeCode) -> Notice:
    """The next notice of a kind that somebody reads."""
    while True:
        found = await client.until(Notice)
        assert isinstance(found, Notice)
        if found.notice is code:
            return found


async def test_presets_go_to_files_and_come_back(
    serving: Serving, told: Told, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    async with serving(actors=2) as server:
        _here(server, (await operator(server, "olga", "tuner")).token, monkeypatch)
        assert "timid" in await told("preset", "list")
        assert "risk_weight" in await told("preset", "show", "timid")
        assert "once" in await told("preset", "apply", "timid", "--dry-run")
        shown = await told("preset", "apply", "timid", "--guard", "people>50/10s")
        assert "world risk_weight: not set -> 25.0" in shown
        await told("preset", "save", "mine", "risk_weight=11", "--note", 'said "so"')
        await told("preset", "save", "mine", "--from", "world")
        assert "usage" not in await told("preset", "save", "mine", code=2)
        file = tmp_path / "mine.toml"
        toml, plain = str(file), str(tmp_path / "mine.json")
        await told("preset", "export", "mine", "--out", toml, "--version", "1")
        await told("preset", "export", "timid", "--out", plain)
        assert 'note = "said \\"so\\""' in file.read_text()
        assert 'name = "mine"' in await told("preset", "export", "mine")
        await told("preset", "delete", "mine")
        shown = await told("preset", "import", toml, plain)
        assert shown.count("change ") == 2
        found = json.loads(await told("preset", "list", "--json"))["presets"]
        versions = {each["name"]: each["version"] for each in found}
        assert (versions["mine"], versions["timid"]) == (3, 2)
        file.write_text("name = 3")
        assert "mine.toml: name" in await told("preset", "import", toml, code=1)
        await told("preset", "export", "timid", "--out", str(tmp_path / "x.txt"), code=2)


async def test_groups_history_and_schedules(
    serving: Serving, told: Told, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    async with serving(actors=2) as server:
        _here(server, (await operator(server, "olga", "tuner")).token, monkeypatch)
        await told("group", "set", "kind:hurried", "actor-1", "actor-2")
        await told("group", "remove", "kind:hurried", "actor-2")
        assert "kind:hurried" in await told("group", "list")
        await told("set", "risk_weight=4", "--group", "kind:hurried", "--note", "why")
        await told("set", "wall_weight=1", "--over", "1s")
        shown = await told("get", "actor-1")
        assert "kind:hurried" in shown
        shown = await told("changes")
        assert "why" in shown
        assert "can be" in shown
        shown = await told("diff", "default", "group:kind:hurried")
        assert "risk_weight" in shown
        assert "foresight_s" not in shown
        assert "foresight_s" in await told("diff", "default", "--all")
        await told("undo", "--anybody")
        commands = tmp_path / "list.json"
        commands.write_text(json.dumps({"op": "hold_actor", "actor": "actor-1"}))
        await told(
            *("schedule", "add", "--in", "10m", "foresight_s=4", "--preset", "brisk"),
            *("--commands", str(commands), "--again", "5m", "--guard", "people>9"),
        )
        await told("schedule", "add", "--when", "people>40/30s", "--preset", "courteous")
        await told("schedule", "add", "--at", "23:59", "--preset", "courteous")
        await told("schedule", "add", "--at-tick", "9999999", "risk_weight=3")
        await told("schedule", "add", "--in", "10m", code=2)
        await told("schedule", "cancel", "s2")
        shown = await told("schedule", "list")
        assert "apply_preset, set_parameters, hold_actor" in shown
        assert "people > 40 for 30 s" in shown
        assert "cancelled" in shown
        assert "contacts_per_minute" in shown


async def test_actors_doors_and_people(
    serving: Serving, told: Told, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with serving(actors=1) as server:
        _here(server, (await operator(server, "dora", "director")).token, monkeypatch)
        await told("send", "actor-1", "2", "2", "0")
        await told("hold", "actor-1")
        await told("hold", "actor-1", "--release")
        await told("behaviour", "idle", "actor-1")
        await told("behaviour", '{"kind": "wander"}', "actor-1")
        await told(
            "add", "--count", "2", "--behaviour", "idle", "--preset", "brisk", "--tag", "wave"
        )
        assert server.world.parameters("main/actor-2").speed_mps == 1.6
        await told("add", "--id", "extra", "--name", "Ada", "--at", "2", "2", "0")
        await told("remove", "extra", "actor-3")
        await told("add", "--count", "2", "--id", "extra", code=2)
        assert "no door" in await told("door", "nowhere", "open", code=1)
        assert "no place" in (await told("send", "actor-1", "the", "moon", code=1)).lower()
        await told("pace", "step", code=1)
        await told("pace", "pause")
        await told("pace", "step", "--ticks", "3")
        await told("pace", "go")
        await told("pace", "0.5", "--note", "look closely")
        assert server.console.pace.state.factor == 0.5
        await told("pace", "9", code=2)
        await told("announce", "hello")
        await told("mark", "now")


async def test_people_are_warned_muted_sent_out_and_banned(
    serving: Serving, told: Told, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with serving(actors=1) as server:
        _here(server, (await operator(server, "mara", "moderator")).token, monkeypatch)
        async with joined(server.port, "Eve") as eve, joined(server.port, "Ann") as ann:
            shown = await told("people")
            assert "Eve" in shown
            assert str(ann.id) in shown
            await told("announce", "The tour begins.", "--near", "actor-1", "--radius", "1000")
            assert (await _notice(eve, NoticeCode.ANNOUNCEMENT)).text == "The tour begins."
            await told("announce", "Up there", "--storey", "50", "--dry-run")
            await told("warn", "Eve", "--text", "Please let others speak.")
            assert (await _notice(eve, NoticeCode.WARNED)).text == "Please let others speak."
            await told("mute", "Eve", "--for", "1m", "--text", "a while")
            assert "a while" in (await _notice(eve, NoticeCode.MUTED)).text
            muted = json.loads(await told("people", "--json"))["people"]
            assert {each["name"]: each["muted_s"] > 0 for each in muted} == {
                "Eve": True,
                "Ann": False,
            }
            assert "nobody is called" in await told("mute", "Adam", code=1)
            await told("walk-out", str(ann.id), "--text", "We are closing.")
            assert "We are closing." in (await _notice(ann, NoticeCode.WALKED_OUT)).text
            await told("ban", "Eve", "--for", "7d", "--by", "name", "--text", "No shouting.")
            assert (await eve.last_words())[1] == CloseCode.BANNED
        shown = await told("bans")
        assert "name Eve" in shown
        assert "No shouting." in shown
        async with connected(server.port) as again:
            await again.send(Hello(name="Eve", version=VERSION))
            assert (await again.refusal())[1] == CloseCode.BANNED
        await told("unban", "1")
        assert "No shouting." not in await told("bans")
        assert "over" in await told("bans", "--all")
        async with joined(server.port, "Eve") as eve:
            await told("kick", "Eve", "--text", "Come back tomorrow.")
            assert (await eve.last_words())[1] == CloseCode.KICKED
        await told("ban", "--name", "Ev*", "--for", "1h", "--note", "third time")
        await told("ban", "--address", "192.0.2.0/24")
        shown = await told("bans")
        assert "name Ev*" in shown
        assert "address 192.0.2.0/24" in shown
        assert "for ever" in shown
        await told("ban", code=2)
        await told("ban", "--by", "name", "--address", "192.0.2.1", code=2)
