"""Building blocks of the parts of `esplanade op` that ask a server that runs."""

import os
from argparse import ArgumentTypeError, Namespace
from argparse import _SubParsersAction as SubParsers  # argparse names the type nowhere else
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

from esplanade.commandline.errors import UsageError
from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import Text

if TYPE_CHECKING:
    from esplanade.operators.logins import Login

URL: Final = "http://localhost:8081"


def add_part(
    commands: "SubParsers[Parser]",
    run: str,
    name: str,
    text: str,
    *examples: str,
    more: str = "",
    before_login: bool = False,
    check: Callable[[Namespace], None] | None = None,
) -> Parser:
    """Add a command that asks a server; `run` is "module:function" of this package.

    `before_login` says that it needs no token yet; `check` sees whether options fit together.
    """
    lines = [more] if more else []
    if examples:
        lines += ["examples:", *(f"  esplanade op {example}" for example in examples)]
    first = text.split(". ", maxsplit=1)[0]
    made = commands.add_parser(
        name,
        run=f"esplanade.operators.{run}",
        help=first[0].lower() + first[1:].rstrip("."),
        description=text,
        epilog="\n".join(lines),
    )
    _add_server(made, check, before_login=before_login)
    return made


def add_family(commands: "SubParsers[Parser]", name: str, text: str) -> "SubParsers[Parser]":
    """Add a word that other commands follow."""
    group = commands.add_parser(name, help=text[0].lower() + text[1:].rstrip("."), description=text)
    found: SubParsers[Parser] = group.add_subparsers(dest="part", metavar="COMMAND", required=True)
    return found


def add_scope(parser: Parser) -> None:
    """Let a command name a scope."""
    scope = parser.add_mutually_exclusive_group()
    scope.add_argument(
        "--group", metavar="NAME", type=Text(), help="of the actors with this tag, or PURPOSE:NAME"
    )
    scope.add_argument("--actor", metavar="ID", type=Text(), help="of this actor alone")


def add_note(parser: Parser) -> None:
    """Let a command have a note, and be tried only."""
    parser.add_argument("--note", metavar="TEXT", help="why; it is kept in the audit")
    parser.add_argument(
        "--dry-run", action="store_true", help="check it and tell its price, change nothing"
    )


def add_json(parser: Parser, text: str = "print all that is known, as JSON") -> None:
    """Let a command print JSON."""
    parser.add_argument("--json", action="store_true", help=text)


def assignment(text: str) -> tuple[str, float]:
    """A parameter's name and its value.

    Raises
    ------
    ArgumentTypeError
        It is not of the form NAME=NUMBER.
    """
    name, sign, number = text.partition("=")
    try:
        if name and sign:
            return name, float(number)
    except ValueError:
        pass
    raise ArgumentTypeError(f"{text!r} is not of the form NAME=NUMBER")


def _add_server(
    parser: Parser, also: Callable[[Namespace], None] | None, *, before_login: bool
) -> None:
    group: Any = parser.add_argument_group("the server")
    group.add_argument(
        "--url",
        metavar="URL",
        type=Text(),
        help=f"its private port [or ESPLANADE_URL; default: that of the latest `op login`; "
        f"with ESPLANADE_TOKEN, or without a login, {URL}]",
    )

    def check(found: Namespace) -> None:
        if also is not None:
            also(found)
        found.url = found.url or os.environ.get("ESPLANADE_URL") or None
        found.token = os.environ.get("ESPLANADE_TOKEN", "")
        if before_login:
            found.url = (found.url or _latest_url()).rstrip("/")
        elif found.token:
            # A token is for one server, which need not be that of the login that is kept.
            found.url = found.url or URL
        else:
            _take_login(found)

    parser.check = check


def _latest_url() -> str:
    """The address of the latest login, or the one that a server has by default."""
    login = _kept_login(None)
    return URL if login is None else login.url


def _take_login(found: Namespace) -> None:
    """Let a command act by the login that is kept."""
    login = _kept_login(found.url)
    if login is None:
        where = "" if found.url is None else f" to {found.url}"
        raise UsageError(
            f"there is no login{where}: call `esplanade op login`, or give a token in "
            "ESPLANADE_TOKEN, which `esplanade op token add` makes"
        )
    found.url, found.token = login.url, login.token


def _kept_login(url: str | None) -> "Login | None":
    """The login to a server that is kept, or the latest of all."""
    from esplanade.operators.logins import LoginsError, kept_login  # noqa: PLC0415 (only if needed)

    try:
        return kept_login(url)
    except LoginsError as error:
        raise UsageError(str(error)) from None
