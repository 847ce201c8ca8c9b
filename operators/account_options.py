"""The options of `esplanade op account`, `op invite` and `op bot`, which ask a server that runs."""

from argparse import _SubParsersAction as SubParsers  # argparse names the type nowhere else

from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import Text, Whole
from esplanade.operators.parts import add_family, add_part

ROLES = ("viewer", "moderator", "tuner", "director", "admin", "auditor")


def add_account_parts(commands: "SubParsers[Parser]") -> list[Parser]:
    """Add the commands, and return their parsers."""
    text = "See to accounts over the network, as `esplanade op user` does on the machine."
    accounts = add_family(commands, "account", text)
    listed = _part(accounts, "list", "list_", "List all accounts.")
    add = _part(accounts, "add", "add", "Add an account; without a password it has tokens only.")
    _add_name(add)
    add.add_argument("--role", choices=ROLES, required=True, help="what it may do")
    add.add_argument(
        "--password-stdin",
        action="store_true",
        help="take the password from the first line of the standard input",
    )
    role = _part(accounts, "role", "role", "Give an account another role, at once.")
    _add_name(role)
    role.add_argument("role", metavar="ROLE", choices=ROLES, help=", ".join(ROLES))
    remove = _part(accounts, "remove", "remove", "Remove an account with its sessions and tokens.")
    _add_name(remove)
    token = _part(accounts, "token", "token", "Make a token of an account; it is printed once.")
    _add_name(token)
    token.add_argument("token_name", metavar="TOKEN", type=Text(), help="the name of the token")
    token.add_argument(
        "--right", dest="rights", action="append", help="a right that it has [default: all]"
    )
    token.add_argument("--days", metavar="N", type=Whole(1, 366), default=90, help="it lasts")
    invite = _part(commands, "invite", "invite", "Make an invitation to a closed world.")
    invite.add_argument("--uses", metavar="N", type=Whole(1, 10_000), default=1, help="for so many")
    invite.add_argument("--hours", metavar="N", type=Whole(1, 8784), default=24, help="it lasts")
    invite.add_argument("--label", metavar="TEXT", help="whom it is for")
    bot = _part(commands, "bot", "bot", "Make a token by which a bot comes in.")
    bot.add_argument("name", metavar="BOT", type=Text(), help="the name of the bot")
    bot.add_argument(
        "--rate", metavar="N", type=Whole(1, 10_000), default=60, help="messages a second"
    )
    bot.add_argument(
        "--connections", metavar="N", type=Whole(1, 4000), default=1, help="so many at once"
    )
    bot.add_argument("--days", metavar="N", type=Whole(1, 366), default=90, help="it lasts")
    return [listed, add, role, remove, token, invite, bot]


def _part(commands: "SubParsers[Parser]", name: str, run: str, text: str) -> Parser:
    return add_part(commands, f"account_commands:{run}", name, text)


def _add_name(parser: Parser) -> None:
    parser.add_argument("name", metavar="ACCOUNT", type=Text(), help="the name of the account")
