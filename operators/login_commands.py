"""`esplanade op login` and `op logout`: a way in that the command line keeps."""

import getpass
import sys
from argparse import Namespace

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import CommandError, UsageError
from esplanade.operators.errors import OperatorError
from esplanade.operators.http import SessionToken, ask, log_in
from esplanade.operators.logins import (
    Login,
    LoginsError,
    drop_login,
    keep_login,
    kept_login,
)


def login(options: Namespace) -> int:
    """Come in by a password or a token, and keep what stands for it from now on."""
    try:
        if options.with_token:
            token = _asked("token", options)
        else:
            token = log_in(options.url, options.account, _asked("password", options))
        me = ask(options.url, token, "/me")
        file = keep_login(Login(options.url, me["account"] or "", token))
    except (OperatorError, LoginsError) as error:
        raise CommandError(str(error)) from None
    print(f"{options.url}: you are {me['account']}, {me['role']}; this is kept in {file}")
    if isinstance(token, SessionToken):
        print("It lasts for 12 hours, and ends after 30 minutes in which you ask nothing.")
    return exit_codes.OK


def logout(options: Namespace) -> int:
    """End the session, and keep the login no more."""
    try:
        found = kept_login(options.url)
        if found is None:
            raise CommandError(f"there is no login to {options.url}")
        drop_login(options.url)
    except LoginsError as error:
        raise CommandError(str(error)) from None
    try:
        if isinstance(found.token, SessionToken):
            ask(options.url, found.token, "/logout", method="POST")
    except OperatorError as error:
        raise CommandError(f"it is kept no more, but the server says: {error}") from None
    print(f"{options.url}: logged out")
    return exit_codes.OK


def _asked(what: str, options: Namespace) -> str:
    """The secret from the terminal, which does not show it, or from the input."""
    if options.stdin:
        given = sys.stdin.readline().rstrip("\r\n")
    elif not sys.stdin.isatty():
        raise UsageError(f"there is no terminal to ask for a {what}: give --stdin")
    else:
        given = getpass.getpass(f"{what}: ")
    if not given:
        raise CommandError(f"no {what} was given")
    return given
