"""The options of the parts of `esplanade op` that ask a server that runs."""

import os
from argparse import ArgumentTypeError, Namespace
from argparse import _SubParsersAction as SubParsers  # argparse names the type nowhere else
from typing import Final

from esplanade.commandline.errors import UsageError
from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import Text, Whole
from esplanade.operators.account_options import add_account_parts

URL: Final = "http://localhost:8081"


def add_parts(commands: "SubParsers[Parser]") -> list[Parser]:
    """Add the commands, and return their parsers."""
    get = _part(commands, "get", "Show an actor's parameters and where each comes from.")
    get.add_argument("actor", metavar="ACTOR", nargs="?", help="such as actor-1 [default: all]")
    get.add_argument("--json", action="store_true", help="print all that is known, as JSON")
    made = _part(commands, "set", "Set parameters of all actors, of a group, or of one.")
    made.add_argument(
        "values", metavar="NAME=VALUE", nargs="+", type=assignment, help="such as risk_weight=12"
    )
    _add_scope(made)
    _add_note(made)
    made.add_argument(
        "--if-revision", metavar="N", type=Whole(0), help="only if none was changed after that"
    )
    clear = _part(commands, "clear", "Take values of a scope away: wider scopes show again.")
    clear.add_argument("names", metavar="NAME", nargs="*", help="parameters [default: all of them]")
    _add_scope(clear)
    _add_note(clear)
    undo = _part(commands, "undo", "Take a change back, if nobody has changed the same since.")
    undo.add_argument(
        "change", metavar="CHANGE", nargs="?", type=Whole(1), help="[default: your own latest]"
    )
    _add_note(undo)
    redo = _part(commands, "redo", "Make anew what you took back last.")
    _add_note(redo)
    diff = _part(commands, "diff", "Show all values that are set, and the usual ones beside them.")
    diff.add_argument("--json", action="store_true", help="print them as JSON")
    parts = [get, made, clear, undo, redo, diff, *add_account_parts(commands)]
    for part in parts:
        _add_server(part)
    return parts


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


def _part(commands: "SubParsers[Parser]", name: str, text: str) -> Parser:
    return commands.add_parser(
        name,
        run=f"esplanade.operators.commands:{name}_",
        help=text[0].lower() + text[1:].rstrip("."),
        description=text,
    )


def _add_scope(parser: Parser) -> None:
    scope = parser.add_mutually_exclusive_group()
    scope.add_argument("--group", metavar="TAG", type=Text(), help="of the actors with this tag")
    scope.add_argument("--actor", metavar="ID", type=Text(), help="of this actor alone")


def _add_note(parser: Parser) -> None:
    parser.add_argument("--note", metavar="TEXT", help="why; it is kept in the audit")
    parser.add_argument(
        "--dry-run", action="store_true", help="check it and tell its price, change nothing"
    )


def _add_server(parser: Parser) -> None:
    group = parser.add_argument_group("the server")
    group.add_argument(
        "--url",
        metavar="URL",
        type=Text(),
        help=f"its private port [or ESPLANADE_URL; default: {URL}]",
    )

    def check(found: Namespace) -> None:
        found.url = found.url or os.environ.get("ESPLANADE_URL") or URL
        found.token = os.environ.get("ESPLANADE_TOKEN", "")
        if not found.token:
            raise UsageError(
                "give your token in ESPLANADE_TOKEN; `esplanade op token add` makes one"
            )

    parser.check = check
