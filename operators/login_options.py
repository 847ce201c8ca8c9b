"""The options of `esplanade op login` and `op logout`."""

from argparse import Namespace
from argparse import _SubParsersAction as SubParsers  # argparse names the type nowhere else

from esplanade.commandline.errors import UsageError
from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import Text
from esplanade.operators.parts import add_part

_KEPT = """\
Neither the password nor the token is a word of the command line, where others on this machine
could read it. Kept is the session that the password has begun, or the token, in the file
esplanade/logins.json of the folder for configuration (XDG_CONFIG_HOME, or ~/.config), with rights
for you alone. ESPLANADE_TOKEN goes before it."""


def add_login_parts(commands: "SubParsers[Parser]") -> list[Parser]:
    """Add the commands, and return their parsers."""
    login = add_part(
        commands,
        "login_commands:login",
        "login",
        "Log in to a server that runs, so that further commands need neither address nor token.",
        "login olga",
        "login olga --url https://plaza.example:8081",
        "login --with-token",
        more=_KEPT,
        before_login=True,
        check=_account_or_token,
    )
    login.add_argument("account", metavar="ACCOUNT", nargs="?", type=Text(), help="your account")
    login.add_argument(
        "--with-token", action="store_true", help="ask for a token, not for a password"
    )
    login.add_argument(
        "--stdin",
        action="store_true",
        help="take password or token from the first line of the standard input",
    )
    logout = add_part(
        commands,
        "login_commands:logout",
        "logout",
        "End the session that `op login` has begun, and forget it.",
        "logout",
        before_login=True,
    )
    return [login, logout]


def _account_or_token(found: Namespace) -> None:
    if bool(found.account) == found.with_token:
        raise UsageError("give your account, or --with-token, and not both")
