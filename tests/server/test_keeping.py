"""Tests what a server keeps while it runs and after, and how it says so at the start."""

from pathlib import Path

import pytest
import structlog

from esplanade.commandline.errors import CommandError
from esplanade.server import keeping as module
from esplanade.server.accounts.identity import MACHINE
from esplanade.server.accounts.sessions import WrongPasswordError
from esplanade.server.app import running
from esplanade.server.audit.log import Filter
from esplanade.server.audit.verifying import verify
from esplanade.server.cli import run
from esplanade.server.keeping import keeping
from esplanade.server.metrics import Metrics
from esplanade.server.options import parser
from esplanade.server.settings import ServerSettings
from esplanade.server.store.location import FILE
from esplanade.server.store.store import StoreError
from tests.server.conftest import Serving
from tests.server.http import get

PASSWORD = "correct horse battery"


async def test_what_is_kept_is_there_after_a_restart(serving: Serving, tmp_path: Path) -> None:
    async with serving(data=tmp_path / "world", durable=True) as server:
        await server.kept.directory.add(MACHINE, "olga", "tuner", PASSWORD)
        token = await server.kept.sessions.log_in("olga", PASSWORD, "here")
    async with serving(data=tmp_path / "world") as server:
        found = await server.kept.sessions.identity(token)
        assert found is not None
        assert found.account == "olga"
        page = await server.kept.audit.page(Filter())
        assert [row.command for row in page.rows] == [
            *("server_start", "server_stop", "log_in", "user_add", "server_start")
        ]
        assert [chain.fault for chain in await verify(server.kept.store)] == [None]


@pytest.fixture
def fresh_log(monkeypatch: pytest.MonkeyPatch) -> None:
    """A logger that has not been used yet: one that has keeps how lines were written then."""
    monkeypatch.setattr(module, "log", structlog.get_logger(__name__))


@pytest.mark.usefixtures("fresh_log")
async def test_without_a_folder_nothing_is_kept_and_the_start_says_so() -> None:
    with structlog.testing.capture_logs() as lines:
        for _ in range(2):
            async with keeping(ServerSettings(), Metrics()) as kept:
                assert await kept.directory.list() == []
                await kept.directory.add(MACHINE, "olga", "tuner", None)
    told = [line["event"] for line in lines]
    assert told == ["nothing is kept when this ends; --data keeps the world and its operators"] * 2


@pytest.mark.usefixtures("fresh_log")
async def test_the_start_names_the_store(
    tmp_path: Path,
) -> None:
    with structlog.testing.capture_logs() as lines:
        async with keeping(ServerSettings(data=tmp_path / "world"), Metrics()):
            pass
    assert lines == [
        {"event": "kept", "store": str(tmp_path / "world" / FILE), "log_level": "info"}
    ]


async def test_the_metrics_tell_of_the_store_and_of_guessing(serving: Serving) -> None:
    async with serving() as server:
        for _ in range(5):
            with pytest.raises(WrongPasswordError):
                await server.kept.sessions.log_in("olga", PASSWORD, "here")
        answer = await get(server.private_port, "/metrics")
    figures = dict(
        line.rsplit(" ", 1)
        for line in answer.body.decode().splitlines()
        if not line.startswith("#")
    )
    assert figures["esplanade_passwords_wrong_total"] == "5.0"
    assert figures["esplanade_password_locks_total"] == "2.0"
    assert figures["esplanade_passwords_unread_total"] == "0.0"
    assert figures["esplanade_store_waiting"] == "0.0"
    assert figures["esplanade_store_refused_total"] == "0.0"
    assert float(figures["esplanade_store_commits_total"]) >= 6


async def test_a_store_that_cannot_be_used_ends_the_start(room_file: Path, tmp_path: Path) -> None:
    (tmp_path / FILE).write_text("no database, but text " * 100)
    with pytest.raises(StoreError, match="file is not a database"):
        async with running(ServerSettings(scene=room_file, data=tmp_path)):
            pass


def test_the_command_says_why_in_one_line(room_file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ESPLANADE_STORE", "postgresql://ann:secret@127.0.0.1:1/world")
    options = parser().parse_args(["--scene", str(room_file), "--port", "0"])
    with pytest.raises(CommandError, match=r"127\.0\.0\.1:1/world: ") as raised:
        run(options)
    assert "secret" not in str(raised.value)
