"""The options of `esplanade cluster`."""

import os
from argparse import Namespace
from argparse import _SubParsersAction as SubParsers  # argparse names the type nowhere else
from typing import Final

from esplanade.commandline.errors import UsageError
from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import InputFile, Text

VARIABLE: Final = "ESPLANADE_STORE"
DESCRIPTION: Final = "See to a world on several machines: make it, look at it, move its zones."
EPILOG: Final = """\
examples:
  esplanade cluster init scenes/town.json --store postgresql://esplanade@localhost/world
  esplanade cluster status
  esplanade cluster move plaza birch
  esplanade cluster drain ash

ESPLANADE_STORE stands for --store. These commands talk to the database and to nothing else; hosts
and gateways do what is wanted of them within a second or two.

exit code: 0 done, 1 it cannot be done, and nothing was changed, 2 wrong usage
"""


def parser() -> Parser:
    """The five commands; the help of the whole shows how each is called."""
    made = Parser("esplanade cluster", description=DESCRIPTION)
    commands = made.add_subparsers(dest="command", metavar="COMMAND", required=True)
    init = _part(
        commands, "init", "Put a world and its scenes into the database, and make the tables where "
        "there are\nnone. Done again, it changes the world: each host takes it up when it is "
        "started next."
    )  # fmt: skip
    init.add_argument(
        "world", metavar="WORLD", type=InputFile(), help="the world's file (docs/worlds.md)"
    )
    status = _part(
        commands, "status", "Say which zones there are, who owns each, who is there, and what does "
        "not fit\ntogether."
    )  # fmt: skip
    status.add_argument("--json", action="store_true", help="as JSON, for programs")
    drain = _part(
        commands, "drain", "Let a process end in order: a host gives its zone to one that stands "
        "by, people of\na gateway come back at another one."
    )  # fmt: skip
    drain.add_argument("name", metavar="NAME", type=Text(), help="the host or gateway")
    move = _part(
        commands, "move", "Let a zone be run by another host, which stands by. People stay "
        "connected and stand\nfor a moment."
    )  # fmt: skip
    move.add_argument("zone", metavar="ZONE", type=Text(), help="the zone")
    move.add_argument("host", metavar="HOST", type=Text(), help="the host that is to have it")
    fence = _part(
        commands, "fence", "Take a zone away from its owner at once, whatever that does: nothing "
        "that it says\ncounts any more. For a host that does not answer."
    )  # fmt: skip
    fence.add_argument("zone", metavar="ZONE", type=Text(), help="the zone")
    parts = [init, status, drain, move, fence]
    usages = "".join(part.format_usage().replace("usage: ", "  ") for part in parts)
    made.epilog = f"usage of each:\n{usages}\n{EPILOG}"
    return made


def _part(commands: "SubParsers[Parser]", name: str, text: str) -> Parser:
    made = commands.add_parser(
        name,
        run=f"esplanade.server.clustering.cluster:{name}",
        help=(text[0].lower() + text[1:]).partition(".")[0].partition(":")[0].replace("\n", " "),
        description=text,
    )
    made.add_argument(
        "--store",
        metavar="URL",
        type=Text(),
        help="the database of the cluster, postgresql://… [or ESPLANADE_STORE]",
    )
    made.check = _check
    return made


def _check(found: Namespace) -> None:
    found.store = found.store or os.environ.get(VARIABLE)
    if not found.store:
        raise UsageError("say where the database of the cluster is: --store URL")
