"""Logins that the command line keeps, in a file that only its user may read."""

import json
import os
import stat
from pathlib import Path
from typing import Any, Final, NamedTuple

from esplanade.operators.http import SessionToken

_OTHERS: Final = 0o077


class LoginsError(Exception):
    """The file of logins cannot be used; the message says why, and what helps."""


class Login(NamedTuple):
    """A way in to one server: the token of an account, or of a session."""

    url: str
    account: str
    token: str
    """A `SessionToken`, or the token of a script."""


def logins_file() -> Path:
    """The file, in the folder where the user's programs keep their configuration."""
    given = os.environ.get("XDG_CONFIG_HOME", "")
    # By that convention a path that begins elsewhere than at the root counts as none.
    folder = Path(given) if os.path.isabs(given) else Path.home() / ".config"  # noqa: PTH117
    return folder / "esplanade" / "logins.json"


def kept_login(url: str | None = None) -> Login | None:
    """The login to a server that is kept, or the latest of all; None if there is none.

    Raises
    ------
    LoginsError
        The file cannot be read, or others may.
    """
    logins = _read()
    if url is None:
        return logins[-1] if logins else None
    return next((each for each in logins if each.url == url.rstrip("/")), None)


def keep_login(login: Login) -> Path:
    """Keep a login in place of the one to the same server, as the latest; returns the file.

    Raises
    ------
    LoginsError
        The file cannot be written.
    """
    login = login._replace(url=login.url.rstrip("/"))
    return _write([*(each for each in _read() if each.url != login.url), login])


def drop_login(url: str) -> None:
    """Keep the login to a server no more.

    Raises
    ------
    LoginsError
        The file cannot be written.
    """
    _write([each for each in _read() if each.url != url.rstrip("/")])


def _read() -> list[Login]:
    path = logins_file()
    try:
        with path.open(encoding="utf-8") as file:
            found = os.fstat(file.fileno())
            if found.st_uid != os.getuid() or stat.S_IMODE(found.st_mode) & _OTHERS:
                raise LoginsError(f"others may read {path}: call `chmod 600 {path}`, or remove it")
            return [_login(each) for each in json.load(file)["logins"]]
    except FileNotFoundError:
        return []
    except OSError as error:
        raise LoginsError(f"{path}: {error.strerror}") from None
    except (ValueError, KeyError, TypeError):
        raise LoginsError(f"{path} is not as it was written: remove it, and log in again") from None


def _login(kept: dict[str, Any]) -> Login:
    secret = str(kept["token"])
    token = SessionToken(secret) if kept["session"] else secret
    return Login(str(kept["url"]), str(kept["account"]), token)


def _write(logins: list[Login]) -> Path:
    path = logins_file()
    kept = [{**each._asdict(), "session": isinstance(each.token, SessionToken)} for each in logins]
    new = path.with_name(f"{path.name}.{os.getpid()}")
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        new.unlink(missing_ok=True)
        # The rights are given when it is made: at no moment can others open it.
        with open(os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as file:  # noqa: PTH123
            json.dump({"logins": kept}, file, indent=1)
        new.replace(path)
    except OSError as error:
        raise LoginsError(f"{path}: {error.strerror}") from None
    return path
