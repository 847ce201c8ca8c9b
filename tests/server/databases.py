"""A real PostgreSQL for tests: made in a temporary folder, as a user who is not root."""

import os
import pwd
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

import pytest
from sqlalchemy import create_engine, text

from tests.patience import PATIENCE_S

REQUIRE_VARIABLE: Final = "ESPLANADE_REQUIRE_POSTGRESQL"
"""With 1, a test that finds no PostgreSQL fails instead of skipping."""


class PostgresqlServer:
    """A database server that a test stops and starts again at the same address.

    It listens at a socket in its folder only, so that it meets no other and needs no password.
    """

    def __init__(self, folder: Path) -> None:
        self.address = f"postgresql://esplanade@/postgres?host={folder}"
        self._binaries = _binaries()
        self._owner = _owner()
        self._folder = folder
        self._data = folder / "data"
        if self._owner is not None:
            os.chown(folder, self._owner.pw_uid, self._owner.pw_gid)
        _call(
            self._owner, self._binaries / "initdb", "-D", self._data, "-A", "trust", "-U",
            "esplanade", "-N", "-E", "UTF8",
        )  # fmt: skip

    def start(self) -> None:
        """Begin, and wait until it answers."""
        options = f"-k {self._folder} -c listen_addresses='' -c fsync=off -c max_connections=60"
        self._control(
            "start", "-l", self._folder / "log", "-t", str(int(PATIENCE_S)), "-o", options
        )

    def stop(self) -> None:
        """End at once, as if it had crashed."""
        self._control("stop", "-m", "immediate")

    def _control(self, *words: object) -> None:
        _call(self._owner, self._binaries / "pg_ctl", words[0], "-D", self._data, "-w", *words[1:])


@contextmanager
def postgresql_server() -> Iterator[PostgresqlServer]:
    """Run a database server of its own."""
    with tempfile.TemporaryDirectory(prefix="esplanade-pg-", dir="/tmp") as name:
        server = PostgresqlServer(Path(name))
        server.start()
        try:
            yield server
        finally:
            server.stop()


@contextmanager
def postgresql() -> Iterator[str]:
    """Run a server of its own; yields the address of its first database."""
    with postgresql_server() as server:
        yield server.address


def new_database(address: str) -> str:
    """The address of a new, empty database of the same server."""
    name = f"t{time.monotonic_ns()}"
    url = address.replace("postgresql:", "postgresql+psycopg:")
    engine = create_engine(url, isolation_level="AUTOCOMMIT")
    with engine.connect() as connection:
        connection.execute(text(f"CREATE DATABASE {name}"))
    engine.dispose()
    return address.replace("/postgres?", f"/{name}?")


def _binaries() -> Path:
    """The folder of `initdb` and `pg_ctl`: Debian does not put it on the path."""
    places = [Path(found).resolve().parent for found in [shutil.which("initdb")] if found]
    places += sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True)
    for place in places:
        if (place / "initdb").exists() and (place / "pg_ctl").exists():
            return place
    why = "PostgreSQL is not installed here: apt-get install postgresql"
    if os.environ.get(REQUIRE_VARIABLE) == "1":
        pytest.fail(f"{REQUIRE_VARIABLE}=1, but {why}")
    pytest.skip(why)


def _owner() -> pwd.struct_passwd | None:
    """Return the user who runs the server in root's place: it refuses to be root."""
    if os.getuid() != 0:
        return None
    for name in ("postgres", "nobody"):
        try:
            return pwd.getpwnam(name)
        except KeyError:
            continue
    pytest.skip("PostgreSQL refuses to run as root, and there is no user postgres or nobody")


def _call(owner: pwd.struct_passwd | None, *words: object) -> None:
    environment = {**os.environ, "LC_ALL": "C", "HOME": "/tmp"}
    done = subprocess.run(
        [str(word) for word in words],
        check=False,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,  # the server inherits it: a pipe would never end
        stderr=subprocess.DEVNULL,
        env=environment,
        cwd="/tmp",
        user=None if owner is None else owner.pw_uid,
        group=None if owner is None else owner.pw_gid,
        extra_groups=None if owner is None else [],
    )
    assert done.returncode == 0, f"{words[0]} ended with status {done.returncode}"
