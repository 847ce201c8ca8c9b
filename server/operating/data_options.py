"""The options of `esplanade data`."""

from argparse import _SubParsersAction as SubParsers  # argparse names the type nowhere else
from typing import Final

from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import InputFile, OutputFile, Text
from esplanade.server.operating.place import add_place

DESCRIPTION: Final = "See to what a server keeps: back it up, restore, upgrade, forget a person."
EPILOG: Final = """\
examples:
  esplanade data backup monday.zip --data world
  esplanade data restore monday.zip --data elsewhere
  esplanade data restore monday.zip --store postgresql://esplanade@localhost/world
  esplanade data upgrade --store postgresql://esplanade@localhost/world
  esplanade data forget "Person 7" --data world

backup and forget work while a server runs. ESPLANADE_DATA or ESPLANADE_STORE stands for --data or
--store.

exit code: 0 done, 1 it cannot be done, and nothing was changed, 2 wrong usage
"""


def parser() -> Parser:
    """The four commands; the help of the whole shows how each is called."""
    made = Parser("esplanade data", description=DESCRIPTION)
    commands = made.add_subparsers(dest="command", metavar="COMMAND", required=True)
    backup = _part(
        commands, "backup", "Write a copy of everything that is kept, as one file that fits both "
        "kinds of store."
    )  # fmt: skip
    backup.add_argument(
        "file", metavar="FILE", type=OutputFile(".zip"), help="the copy, a new .zip file"
    )
    restore = _part(commands, "restore", "Fill a new folder or an empty database with a copy.")
    restore.add_argument("file", metavar="FILE", type=InputFile(), help="the copy, a .zip file")
    upgrade = _part(
        commands, "upgrade", "Bring the tables of an older program to those of this one. A server "
        "does so\nby itself in a folder; in a database it waits to be told."
    )  # fmt: skip
    forget = _part(
        commands, "forget", "Forget a person everywhere: what the audit says of this person, and "
        "the account\nof this name with what it did. The audit's chain still holds."
    )  # fmt: skip
    forget.add_argument("person", metavar="PERSON", type=Text(), help="the name")
    forget.add_argument(
        "--recordings",
        metavar="DIR",
        type=InputFile(folders=True),
        help="folder of recordings, in which the name and the chat of the person are forgotten too",
    )
    parts = [backup, restore, upgrade, forget]
    for part in parts:
        add_place(part)
    usages = "".join(part.format_usage().replace("usage: ", "  ") for part in parts)
    made.epilog = f"usage of each:\n{usages}\n{EPILOG}"
    return made


def _part(commands: "SubParsers[Parser]", name: str, text: str) -> Parser:
    return commands.add_parser(
        name,
        run=f"esplanade.server.operating.data:{name}",
        help=(text[0].lower() + text[1:]).partition(".")[0].replace("\n", " "),
        description=text,
    )
