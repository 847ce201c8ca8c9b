"""The options of `esplanade op`."""

from argparse import Namespace
from argparse import _SubParsersAction as SubParsers  # argparse names the type nowhere else
from collections.abc import Callable
from typing import Final

from esplanade.commandline.errors import UsageError
from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import Span, Text, Whole
from esplanade.server.accounts.rights import ROLES, Right
from esplanade.server.operating.place import add_place

DESCRIPTION: Final = (
    "See to operators: their accounts, the tokens of their scripts, and the audit. Tune the actors "
    "of a world that runs."
)
EPILOG: Final = """\
examples:
  esplanade op user add olga --role tuner --data world
  TOKEN=$(esplanade op user add olga --role tuner --data world --token)
  esplanade op user list --data world
  esplanade op token add olga nightly --right watch --right parameters --expires 30d --data world
  esplanade op audit --since 1h --csv --data world > hour.csv
  esplanade op audit --verify --data world
  export ESPLANADE_URL=http://localhost:8081 ESPLANADE_TOKEN=$TOKEN
  esplanade op get actor-1
  esplanade op set risk_weight=12 foresight_s=4 --group hurried --note "queue at the door"
  esplanade op preset apply timid --guard 'contacts_per_minute>3/10s'
  esplanade op schedule add --at 18:00 --preset rush-hour --again 2h
  esplanade op diff default preset:timid actor:actor-1
  esplanade op undo

user, token and audit work on the folder or database of a server, whether it runs or not: who can
write there may do everything. A server that runs sees a change at once. ESPLANADE_DATA or
ESPLANADE_STORE stands for --data or --store.
All other commands ask a server that runs, by a token in ESPLANADE_TOKEN.

exit code: 0 done, 1 it cannot be done, or the audit is not as it was written, 2 wrong usage
"""
_PASSWORD: Final = "take the password from the first line of the standard input"  # noqa: S105
_DAY_S: Final = 24 * 3600.0


AddParts = Callable[["SubParsers[Parser]"], list[Parser]]


def parser(add_more: AddParts | None = None) -> Parser:
    """The commands; the help of the whole shows how each is called. `add_more` adds others."""
    made = Parser("esplanade op", description=DESCRIPTION)
    commands = made.add_subparsers(dest="command", metavar="COMMAND", required=True)
    parts = [*_user(commands), *_token(commands), _audit(commands)]
    parts += [] if add_more is None else add_more(commands)
    usages = "".join(part.format_usage().replace("usage: ", "  ") for part in parts)
    made.epilog = f"usage of each:\n{usages}\n{EPILOG}"
    return made


def _user(commands: "SubParsers[Parser]") -> list[Parser]:
    text = "Add, change, list and remove accounts of operators."
    group = commands.add_parser("user", help="accounts of operators", description=text)
    users = group.add_subparsers(dest="part", metavar="COMMAND", required=True)
    add = _part(users, "users:add", "add", "Add an account, which asks for a password.")
    _add_name(add)
    add.add_argument("--role", choices=tuple(ROLES), required=True, help="what it may do")
    _add_password(add)
    add.add_argument(
        "--token",
        action="store_true",
        help="give it no password but a token for scripts, with all its rights; it is printed "
        "this once",
    )
    _add_expires(add, "how long the token lasts")
    add_place(add, _token_and_password)
    listed = _part(users, "users:list_", "list", "List all accounts.")
    listed.add_argument("--json", action="store_true", help="print them as JSON")
    add_place(listed)
    remove = _part(
        users, "users:remove", "remove", "Remove an account with its sessions and tokens."
    )
    _add_name(remove)
    add_place(remove)
    password = _part(
        users, "users:password", "password", "Give an account another password; its sessions end."
    )
    _add_name(password)
    _add_password(password)
    add_place(password)
    role = _part(users, "users:role", "role", "Give an account another role, at once.")
    _add_name(role)
    role.add_argument("role", metavar="ROLE", choices=tuple(ROLES), help=", ".join(ROLES))
    add_place(role)
    return [add, listed, remove, password, role]


def _token(commands: "SubParsers[Parser]") -> list[Parser]:
    text = "Make, list and revoke tokens, by which scripts act for an account."
    group = commands.add_parser("token", help="tokens of scripts", description=text)
    tokens = group.add_subparsers(dest="part", metavar="COMMAND", required=True)
    add = _part(tokens, "tokens:add", "add", "Make a token; it is printed this once.")
    _add_name(add)
    _add_token(add)
    add.add_argument(
        "--right",
        dest="rights",
        action="append",
        choices=tuple(right.value for right in Right),
        help="a right that it has; may be given again [default: all of the account]",
    )
    _add_expires(add, "how long it lasts")
    add_place(add)
    listed = _part(tokens, "tokens:list_", "list", "List tokens; the tokens themselves are not.")
    listed.add_argument("name", metavar="ACCOUNT", nargs="?", help="those of this account only")
    listed.add_argument("--json", action="store_true", help="print them as JSON")
    add_place(listed)
    revoke = _part(tokens, "tokens:revoke", "revoke", "Make a token useless, at once.")
    _add_name(revoke)
    _add_token(revoke)
    add_place(revoke)
    return [add, listed, revoke]


def _audit(commands: "SubParsers[Parser]") -> Parser:
    made = _part(commands, "audit:run", "audit", "Show who did what and when, the newest first.")
    made.add_argument(
        "--since", metavar="SPAN", type=Span(), help="not what is older, such as 90s, 15m, 1h, 7d"
    )
    made.add_argument("--until", metavar="SPAN", type=Span(), help="not what is newer than this")
    made.add_argument("--account", metavar="NAME", help="what this account did")
    made.add_argument(
        "--command", dest="name", metavar="NAME", help="this command, such as set_parameters"
    )
    made.add_argument("--actor", metavar="ID", help="what was done with this actor, scope or door")
    made.add_argument("--person", metavar="NAME", help="what was done with this person or account")
    made.add_argument(
        "--limit", metavar="N", type=Whole(1), help="so many rows at most [default: 100 in a table]"
    )
    form = made.add_mutually_exclusive_group()
    form.add_argument("--csv", action="store_true", help="write all rows as CSV")
    form.add_argument("--json", action="store_true", help="write all rows as lines of JSON")
    form.add_argument(
        "--verify",
        action="store_true",
        help="check the chain of hashes instead, and name the first row that is not as it was "
        "written",
    )
    add_place(made)
    return made


def _part(commands: "SubParsers[Parser]", run: str, name: str, text: str) -> Parser:
    return commands.add_parser(
        name,
        run=f"esplanade.server.operating.{run}",
        help=text[0].lower() + text[1:].rstrip("."),
        description=text,
    )


def _add_name(parser: Parser) -> None:
    parser.add_argument("name", metavar="ACCOUNT", type=Text(), help="the name of the account")


def _add_token(parser: Parser) -> None:
    parser.add_argument("token", metavar="TOKEN", type=Text(), help="the name of the token")


def _add_password(parser: Parser) -> None:
    parser.add_argument("--password-stdin", action="store_true", help=_PASSWORD)


def _add_expires(parser: Parser, text: str) -> None:
    parser.add_argument(
        "--expires",
        metavar="SPAN",
        type=Span(),
        default=90 * _DAY_S,
        help=f"{text}, such as 12h or 30d [default: 90d]",
    )


def _token_and_password(found: Namespace) -> None:
    if found.token and found.password_stdin:
        raise UsageError("--token and --password-stdin: give one of them, not both")
