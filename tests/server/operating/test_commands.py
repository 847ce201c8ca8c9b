"""The commands `op` and `data`, called as a person does, on both kinds of store."""

import asyncio
import csv
import io
import json
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from sqlalchemy import text

from esplanade.cli import main
from esplanade.commandline import exit_codes
from esplanade.server.accounts.lockout import Lockout
from esplanade.server.accounts.passwords import Passwords
from esplanade.server.accounts.rights import ROLES, Right
from esplanade.server.accounts.sessions import Sessions
from esplanade.server.accounts.tokens import Tokens
from esplanade.server.audit.entries import Entry
from esplanade.server.audit.log import AuditLog
from esplanade.server.store.location import FILE, Location
from esplanade.server.store.sql_store import SqlStore, open_store
from esplanade.server.store.tables import REVISION
from tests.server.databases import new_database

PASSWORD = "correct horse battery"


class Shell:
    """Calls commands with the place of one store, and gives exit code, output and errors."""

    def __init__(
        self,
        place: list[str],
        capsys: pytest.CaptureFixture[str],
        monkeypatch: pytest.MonkeyPatch,
    ) -> None:
        self.place = place
        self._capsys = capsys
        self._monkeypatch = monkeypatch

    def __call__(self, *words: str, given: str = "") -> tuple[int, str, str]:
        self._monkeypatch.setattr(sys, "stdin", io.StringIO(given))
        try:
            code = main([*words, *self.place])
        except SystemExit as end:
            code = int(str(end.code))
        shown = self._capsys.readouterr()
        return code, shown.out, shown.err

    def done(self, *words: str, given: str = "") -> str:
        code, out, err = self(*words, given=given)
        assert (code, err) == (exit_codes.OK, ""), err
        return out

    def refused(self, *words: str, given: str = "") -> str:
        code, out, err = self(*words, given=given)
        assert (code, out) == (exit_codes.FAILED, "")
        return err


@pytest.fixture(autouse=True)
def _no_variables(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("ESPLANADE_DATA", "ESPLANADE_STORE"):
        monkeypatch.delenv(name, raising=False)


@pytest.fixture
def folder(location: Location, tmp_path: Path) -> Path:
    return tmp_path / "data"


@pytest.fixture
def shell(
    location: Location,
    folder: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> Shell:
    """A shell on a store that has its tables."""
    if location.is_sqlite:
        made = Shell(["--data", str(folder)], capsys, monkeypatch)
        code, _, err = made("op", "user", "add", "first", "--role", "viewer", "--token")
        assert (code, err) == (0, f"{folder / FILE} is new\n")
    else:
        address = location.url.set(drivername="postgresql").render_as_string(hide_password=False)
        made = Shell(["--store", address], capsys, monkeypatch)
        assert "run `esplanade data upgrade`" in made.refused("op", "user", "list")
        assert f"revision none, now {REVISION}" in made.done("data", "upgrade")
        made.done("op", "user", "add", "first", "--role", "viewer", "--token")
    made.done("op", "user", "remove", "first")
    return made


def users(shell: Shell) -> dict[str, str]:
    found = json.loads(shell.done("op", "user", "list", "--json"))
    return {each["name"]: each["role"] for each in found}


def test_an_account_with_a_password(shell: Shell) -> None:
    add = ("op", "user", "add", "olga", "--role", "tuner", "--password-stdin")
    assert shell.done(*add, given=f"{PASSWORD}\n") == ""
    assert users(shell) == {"olga": "tuner"}
    assert "there is an account 'olga' already" in shell.refused(*add, given=PASSWORD)
    assert "fewer than 12" in shell.refused("op", "user", "password", "olga", "--password-stdin")
    shell.done("op", "user", "password", "olga", "--password-stdin", given="another one, longer\n")
    shell.done("op", "user", "role", "olga", "admin")
    table = shell.done("op", "user", "list")
    assert [word for word in ("olga", "admin", "yes", "never") if word not in table] == []
    shell.done("op", "user", "remove", "olga")
    assert users(shell) == {}
    for words in (("remove", "olga"), ("role", "olga", "viewer")):
        assert "there is no account 'olga'" in shell.refused("op", "user", *words)


def test_without_a_terminal_a_password_must_be_given(shell: Shell) -> None:
    code, out, err = shell("op", "user", "add", "olga", "--role", "tuner")
    assert (code, out) == (exit_codes.USAGE, "")
    assert "there is no terminal to ask for a password: give --password-stdin" in err
    assert users(shell) == {}


def test_a_token_is_all_that_is_printed_and_works_at_once(shell: Shell, location: Location) -> None:
    printed = shell.done("op", "user", "add", "olga", "--role", "tuner", "--token")
    token = printed.rstrip("\n")
    assert printed == f"{token}\n"
    assert " " not in token

    async def rights(store: SqlStore) -> frozenset[Right] | None:
        found = await Tokens(store, AuditLog(store, "server")).identity(token)
        return None if found is None else found.rights

    async def while_a_server_runs() -> None:
        async with open_store(location) as store:
            assert await rights(store) == ROLES["tuner"]
            await asyncio.to_thread(shell.done, "op", "user", "role", "olga", "viewer")
            assert await rights(store) == {Right.WATCH}
            await asyncio.to_thread(shell.done, "op", "token", "revoke", "olga", "command-line")
            assert await rights(store) is None

    asyncio.run(while_a_server_runs())


def test_a_server_that_runs_lets_in_who_was_just_added(shell: Shell, location: Location) -> None:
    async def while_a_server_runs() -> None:
        async with open_store(location) as store:
            passwords = Passwords()
            sessions = Sessions(store, AuditLog(store, "server"), passwords, Lockout())
            add = ("op", "user", "add", "olga", "--role", "tuner", "--password-stdin")
            await asyncio.to_thread(shell.done, *add, given=PASSWORD)
            token = await sessions.log_in("olga", PASSWORD, "here")
            assert await sessions.identity(token) is not None
            await asyncio.to_thread(shell.done, "op", "user", "remove", "olga")
            assert await sessions.identity(token) is None
            passwords.close()

    asyncio.run(while_a_server_runs())


def test_tokens_are_made_listed_and_revoked(shell: Shell) -> None:
    shell.done("op", "user", "add", "olga", "--role", "tuner", "--token")
    add = ("op", "token", "add", "olga", "nightly", "--right", "watch", "--expires", "12h")
    token = shell.done(*add).strip()
    listed = json.loads(shell.done("op", "token", "list", "olga", "--json"))
    nightly = next(each for each in listed if each["name"] == "nightly")
    assert nightly["rights"] == ["watch"]
    assert nightly["expires_us"] - nightly["created_us"] == 12 * 3600 * 10**6
    table = shell.done("op", "token", "list")
    assert "usable" in table
    assert token not in table
    shell.done("op", "token", "revoke", "olga", "nightly")
    assert "revoked" in shell.done("op", "token", "list")
    assert "has no token 'daily'" in shell.refused("op", "token", "revoke", "olga", "daily")
    doors = ("op", "token", "add", "olga", "doors", "--right", "doors")
    assert "the role tuner does not have the right doors" in shell.refused(*doors)


def test_an_account_that_cannot_have_its_token_is_not_added(shell: Shell) -> None:
    add = ("op", "user", "add", "olga", "--role", "tuner", "--token", "--expires", "400d")
    assert "a token lasts up to 366 days" in shell.refused(*add)
    assert users(shell) == {}


def test_the_audit_is_shown_written_out_and_checked(shell: Shell, location: Location) -> None:
    shell.done("op", "user", "add", "olga", "--role", "tuner", "--token")
    rows = list(csv.DictReader(io.StringIO(shell.done("op", "audit", "--since", "1h", "--csv"))))
    assert [(row["command"], row["person"]) for row in rows[:2]] == [
        ("token_add", "olga"),
        ("user_add", "olga"),
    ]
    lines = shell.done(
        "op", "audit", "--json", "--command", "user_add", "--limit", "1"
    ).splitlines()
    assert [json.loads(line)["person"] for line in lines] == ["olga"]
    assert "user_remove" in shell.done("op", "audit", "--person", "first")
    assert shell.done("op", "audit", "--until", "1h", "--json") == ""
    assert "command line" in shell.done("op", "audit", "--verify")

    async def tamper() -> None:
        forbid = (
            "DROP TRIGGER audit_kept" + ("" if location.is_sqlite else " ON audit"),
            "UPDATE audit SET command = 'mark' WHERE seq = 2",
        )
        async with open_store(location) as store:
            for statement in map(text, forbid):
                await store.write(lambda c, s=statement: c.execute(s).rowcount)  # type: ignore[misc]

    asyncio.run(tamper())
    code, _, err = shell("op", "audit", "--verify")
    assert code == exit_codes.FAILED
    assert err == "esplanade op audit: row 2 of writer 'command line': it was changed\n"


def test_what_people_write_does_not_steer_the_terminal(shell: Shell, location: Location) -> None:
    async def write() -> None:
        async with open_store(location) as store:
            await AuditLog(store, "server").record(
                Entry(command="kick", person="\x1b[2J[red]Eve", note="a\nb\x9b1m")
            )

    asyncio.run(write())
    shown = shell.done("op", "audit")
    assert "[2J[red]Eve" in shown
    assert not {"\x1b", "\x9b"} & set(shown + shell.done("op", "audit", "--json"))


def other_place(kind: str, tmp_path: Path, request: pytest.FixtureRequest) -> list[str]:
    if kind == "sqlite":
        return ["--data", str(tmp_path / "other")]
    return ["--store", new_database(request.getfixturevalue("database_server"))]


@pytest.mark.parametrize("kind", ["sqlite", "postgresql"])
def test_a_copy_restores_into_either_kind_of_store(
    shell: Shell, kind: str, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    shell.done("op", "user", "add", "olga", "--role", "tuner", "--password-stdin", given=PASSWORD)
    shell.done("op", "token", "add", "olga", "nightly")
    shell.done("data", "forget", "first")
    before = shell.done("op", "user", "list", "--json"), shell.done("op", "audit", "--json")
    file = tmp_path / "copy.zip"
    assert "1 in accounts" in shell.done("data", "backup", str(file))
    assert file.stat().st_mode & 0o777 == 0o600
    assert "is there already; a backup replaces nothing" in shell.refused(
        "data", "backup", str(file)
    )
    source = shell.place
    shell.place = other_place(kind, tmp_path, request)
    shell.done("data", "restore", str(file))
    shell.done("op", "audit", "--verify")
    assert shell.done("op", "user", "list", "--json") == before[0]
    kept = shell.done("op", "audit", "--json").splitlines()
    told = [json.loads(line) for line in kept]
    assert told[0]["command"] == "data_restore"
    without_id = [{**row, "id": 0} for row in told[1:]]
    assert without_id == [{**json.loads(line), "id": 0} for line in before[1].splitlines()]
    for place in (source, shell.place):
        shell.place = place
        assert "restored into a new folder or an empty database only" in shell.refused(
            "data", "restore", str(file)
        )
    assert shell.done("op", "user", "list", "--json") == before[0]


@pytest.mark.parametrize("damage", ["cut", "text", "row", "newer"])
def test_a_damaged_copy_changes_nothing(
    shell: Shell, damage: str, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    file, damaged = tmp_path / "copy.zip", tmp_path / "damaged.zip"
    shell.done("data", "backup", str(file))
    if damage == "cut":
        damaged.write_bytes(file.read_bytes()[:-40])
    elif damage == "text":
        damaged.write_text("no archive")
    else:
        with zipfile.ZipFile(file) as old, zipfile.ZipFile(damaged, "w") as new:
            for name in old.namelist():
                content = old.read(name)
                if damage == "row" and name == "audit.jsonl":
                    content = content[: content.index(b"\n") + 1]
                if damage == "newer" and name == "manifest.json":
                    content = content.replace(f'"{REVISION}"'.encode(), b'"9999"')
                new.writestr(name, content)
    kind = "sqlite" if "--data" in shell.place else "postgresql"
    shell.place = other_place(kind, tmp_path, request)
    told = shell.refused("data", "restore", str(damaged))
    assert "damaged.zip" in told
    assert ("newer program" if damage == "newer" else "is no backup, or it is damaged") in told
    if kind == "sqlite":
        assert not (tmp_path / "other" / FILE).exists()
    shell.done("data", "restore", str(file))


def test_a_person_is_forgotten_and_the_audit_still_holds(
    shell: Shell, location: Location, folder: Path
) -> None:
    shell.done("op", "user", "add", "olga", "--role", "tuner", "--password-stdin", given=PASSWORD)

    async def kick() -> None:
        async with open_store(location) as store:
            entry = Entry(command="kick", account="olga", person="Eve Harrington", note="rude")
            await AuditLog(store, "server").record(entry)

    asyncio.run(kick())
    if location.is_sqlite:
        assert any(b"Harrington" in file.read_bytes() for file in folder.iterdir())
    told = shell.done("data", "forget", "Eve Harrington")
    assert "0 in accounts" in told
    assert "1 in audit" in told
    told = shell.done("data", "forget", "olga")
    assert "1 in accounts" in told
    assert "2 in audit" in told
    shell.done("op", "audit", "--verify")
    for name in ("Harrington", "olga", "rude"):
        assert name not in shell.done("op", "audit", "--json")
        if location.is_sqlite:
            assert not any(name.encode() in file.read_bytes() for file in folder.iterdir())
    assert users(shell) == {}
    assert "nothing is known of 'olga'" in shell.refused("data", "forget", "olga")


def test_an_upgrade_of_what_is_new_enough_says_so(shell: Shell) -> None:
    assert "the tables are of revision 0001 already" in shell.done("data", "upgrade")


NOTHING: list[Callable[[Path], list[str]]] = [
    lambda _: ["op", "user", "list"],
    lambda _: ["op", "user", "remove", "olga"],
    lambda _: ["op", "audit"],
    lambda _: ["data", "upgrade"],
    lambda _: ["data", "forget", "Eve"],
    lambda path: ["data", "backup", str(path / "copy.zip")],
]


@pytest.mark.parametrize("words", NOTHING)
def test_where_there_is_no_store_none_is_made(
    words: Callable[[Path], list[str]],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shell = Shell(["--data", str(tmp_path / "typo")], capsys, monkeypatch)
    code, out, err = shell(*words(tmp_path))
    assert (code, out) == (exit_codes.USAGE, "")
    assert f"there is no store in {tmp_path / 'typo'}: " in err
    assert list(tmp_path.iterdir()) == []


def test_an_account_that_cannot_be_leaves_no_new_store(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    shell = Shell(["--data", str(tmp_path / "new")], capsys, monkeypatch)
    told = shell.refused("op", "user", "add", "Olga", "--role", "tuner", "--token")
    assert "'Olga' is no name" in told
    assert not (tmp_path / "new" / FILE).exists()


def test_an_address_that_is_none_is_told_without_its_password(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ESPLANADE_STORE", "mysql://ann:secret@host/world")
    code, out, err = Shell([], capsys, monkeypatch)("op", "user", "list")
    assert (code, out) == (exit_codes.USAGE, "")
    assert "is no address such as postgresql://" in err
    assert "secret" not in err


def test_a_password_is_asked_for_twice(shell: Shell, monkeypatch: pytest.MonkeyPatch) -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    typed = [PASSWORD, "something else", PASSWORD, PASSWORD]
    monkeypatch.setattr("getpass.getpass", lambda _: typed.pop(0))
    monkeypatch.setattr(io, "StringIO", Terminal)
    add = ("op", "user", "add", "olga", "--role", "tuner")
    assert "the two passwords differ; nothing was changed" in shell.refused(*add)
    shell.done(*add)
    assert users(shell) == {"olga": "tuner"}
