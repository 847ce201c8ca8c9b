"""`esplanade op login`: against real servers, with a terminal of its own where one is asked."""

import asyncio
import fcntl
import json
import os
import pty
import stat
import subprocess
import sys
import termios
from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from esplanade.operators import login_commands
from esplanade.operators.http import SessionToken
from esplanade.operators.logins import Login, LoginsError, drop_login, keep_login, kept_login
from esplanade.operators.parts import URL
from esplanade.options import op
from esplanade.server.accounts.identity import MACHINE
from tests.operators.test_commands import Told, told
from tests.patience import PATIENCE_S
from tests.server.conftest import Serving, room_file, serving, serving_assets
from tests.server.console.operators import operator

__all__ = ["room_file", "serving", "serving_assets", "told"]

PASSWORD = "correct horse battery"


@pytest.fixture(autouse=True)
def configuration(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's folder for configuration, empty; and no login from elsewhere."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    for name in ("ESPLANADE_URL", "ESPLANADE_TOKEN"):
        monkeypatch.delenv(name, raising=False)
    return tmp_path / "config"


@contextmanager
def on_a_terminal(*words: str) -> Iterator["tuple[subprocess.Popen[bytes], int]"]:
    """A command whose terminal is ours to read and write."""
    ours, theirs = pty.openpty()

    def own_terminal() -> None:
        os.setsid()
        fcntl.ioctl(0, termios.TIOCSCTTY, 0)

    process = subprocess.Popen(
        [sys.executable, "-m", "esplanade", "op", *words],
        stdin=theirs,
        stdout=theirs,
        stderr=theirs,
        preexec_fn=own_terminal,  # noqa: PLW1509 (it only takes the terminal)
    )
    os.close(theirs)
    try:
        yield process, ours
    finally:
        process.kill()
        process.wait(PATIENCE_S)
        os.close(ours)


def type_password(words: tuple[str, ...]) -> tuple[int, str]:
    """Log in on a terminal; the exit code, and all that the terminal has shown."""
    with on_a_terminal(*words) as (process, terminal):
        shown = b""
        while b"password: " not in shown:
            shown += os.read(terminal, 1024)
        os.write(terminal, f"{PASSWORD}\n".encode())
        try:
            while part := os.read(terminal, 1024):
                shown += part
        except OSError:  # the other end is shut
            pass
        return process.wait(PATIENCE_S), shown.decode()


async def test_the_password_is_asked_for_and_a_session_is_kept(
    serving: Serving, told: Told, configuration: Path
) -> None:
    async with serving(actors=1) as server:
        await server.kept.directory.add(MACHINE, "olga", "tuner", PASSWORD)
        url = f"http://127.0.0.1:{server.private_port}"
        code, shown = await asyncio.to_thread(type_password, ("login", "olga", "--url", url))
        assert code == 0, shown
        assert "you are olga, tuner" in shown
        assert PASSWORD not in shown
        file = configuration / "esplanade" / "logins.json"
        assert stat.S_IMODE(file.stat().st_mode) == 0o600
        assert stat.S_IMODE(file.parent.stat().st_mode) == 0o700
        assert PASSWORD not in file.read_text()
        # Neither address nor token is needed from now on, and all kinds of requests work.
        assert "actor-1" in await told("get")
        assert "not set -> 12.0" in await told("set", "risk_weight=12")
        (row,) = [
            row
            for row in (await server.kept.audit.own_rows(0, 100))
            if row.note is None and row.command == "set_parameters" and not row.outcome
        ]
        assert (row.account, row.body["via"]) == ("olga", "session")
        assert "logged out" in await told("logout")
        assert "there is no login" in await told("get", code=2)
        assert json.loads(file.read_text()) == {"logins": []}
        assert "there is no login" in await told("logout", code=1)


async def test_a_session_that_has_ended_is_told_of(serving: Serving, told: Told) -> None:
    async with serving() as server:
        url = f"http://127.0.0.1:{server.private_port}"
        keep_login(Login(url, "olga", SessionToken("x" * 43)))
        assert "call `esplanade op login` again" in await told("get", code=1)


async def test_a_token_is_kept_and_a_wrong_one_is_not(
    serving: Serving, told: Told, configuration: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with serving(actors=1) as server:
        token = (await operator(server, "olga", "tuner")).token
        url = f"http://127.0.0.1:{server.private_port}"
        monkeypatch.setattr(sys, "stdin", Lines("esplanade_wrong"))
        await told("login", "--with-token", "--stdin", "--url", url, code=1)
        assert not (configuration / "esplanade").exists()
        monkeypatch.setattr(sys, "stdin", Lines(token))
        shown = await told("login", "--with-token", "--stdin", "--url", url)
        assert "you are olga, tuner" in shown
        assert token not in shown
        assert "12 hours" not in shown
        assert "actor-1" in await told("get")
        # A token in the environment goes before it.
        monkeypatch.setenv("ESPLANADE_TOKEN", "esplanade_wrong")
        await told("get", code=1)
        monkeypatch.delenv("ESPLANADE_TOKEN")
        monkeypatch.setenv("ESPLANADE_URL", "http://127.0.0.1:1")
        assert "there is no login to http://127.0.0.1:1" in await told("get", code=2)
        monkeypatch.setattr(sys, "stdin", Lines(PASSWORD))
        await told("login", "olga", "--stdin", "--url", url, code=1)
        monkeypatch.setattr(sys, "stdin", Lines(""))
        assert "no password" in await told("login", "olga", "--stdin", "--url", url, code=1)
        await told("login", "--url", url, code=2)
        await told("login", "olga", "--with-token", "--url", url, code=2)


class Lines:
    """A standard input that is no terminal."""

    def __init__(self, line: str) -> None:
        self._line = line

    def readline(self) -> str:
        return f"{self._line}\n"

    def isatty(self) -> bool:
        return False


async def test_without_a_terminal_nothing_is_asked(
    told: Told, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "stdin", Lines(""))
    assert "give --stdin" in await told("login", "olga", code=2)


def test_a_file_that_others_may_read_is_not_used(configuration: Path) -> None:
    file = keep_login(Login("http://one:1/", "olga", "esplanade_a"))
    assert file == configuration / "esplanade" / "logins.json"
    keep_login(Login("http://two:2", "oleg", SessionToken("b")))
    keep_login(Login("http://one:1", "olga", "esplanade_c"))
    assert kept_login() == Login("http://one:1", "olga", "esplanade_c")
    found = kept_login("http://two:2/")
    assert found == Login("http://two:2", "oleg", "b")
    assert found is not None
    assert isinstance(found.token, SessionToken)
    drop_login("http://one:1/")
    assert kept_login("http://one:1") is None
    file.chmod(0o640)
    with pytest.raises(LoginsError, match="chmod 600"):
        kept_login()
    file.chmod(0o600)
    file.write_text("{")
    with pytest.raises(LoginsError, match="log in again"):
        kept_login()


def parsed(*words: str) -> Namespace:
    return op().parse_args(list(words))


def test_which_server_is_meant(
    configuration: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file = keep_login(Login("http://one:1", "olga", "esplanade_a"))
    assert parsed("login", "olga").url == "http://one:1"
    assert (parsed("get").url, parsed("get").token) == ("http://one:1", "esplanade_a")
    # A token is not handed to a server only because it was that of the latest login.
    monkeypatch.setenv("ESPLANADE_TOKEN", "esplanade_b")
    assert (parsed("get").url, parsed("get").token) == (URL, "esplanade_b")
    monkeypatch.delenv("ESPLANADE_TOKEN")
    file.chmod(0o640)
    assert configuration in file.parents
    for words in (["get"], ["login", "olga"], ["logout"]):
        with pytest.raises(SystemExit, match="2"):
            parsed(*words)
        assert "chmod 600" in capsys.readouterr().err


async def test_a_login_that_cannot_be_dropped_is_kept(
    told: Told, monkeypatch: pytest.MonkeyPatch
) -> None:
    def unwritable(_: str) -> None:
        raise LoginsError("the disk is full")

    keep_login(Login("http://one:1", "olga", "esplanade_a"))
    monkeypatch.setattr(login_commands, "drop_login", unwritable)
    said = await told("logout", code=1)
    assert "the disk is full" in said
    assert "kept no more" not in said
