"""`esplanade op account`, `op invite` and `op bot`: accounts over the network."""

import asyncio
import sys
from argparse import Namespace
from collections.abc import Awaitable, Callable
from typing import TypeVar

from rich.table import Table

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import CommandError
from esplanade.commandline.output import console
from esplanade.operators.accounts import Accounts
from esplanade.operators.client import Operator
from esplanade.operators.errors import OperatorError

Result = TypeVar("Result")


def list_(options: Namespace) -> int:
    """Show all accounts."""
    table = Table("account", "role", "password", "tokens")
    for account in _asked(options, lambda accounts: accounts.list()):
        tokens = ", ".join(token["name"] for token in account["tokens"])
        table.add_row(
            account["name"], account["role"], "yes" if account["has_password"] else "no", tokens
        )
    console().print(table)
    return exit_codes.OK


def add(options: Namespace) -> int:
    """Add an account."""
    password = sys.stdin.readline().rstrip("\r\n") if options.password_stdin else None
    _asked(options, lambda accounts: accounts.add(options.name, options.role, password))
    return exit_codes.OK


def role(options: Namespace) -> int:
    """Give an account another role."""
    _asked(options, lambda accounts: accounts.set_role(options.name, options.role))
    return exit_codes.OK


def remove(options: Namespace) -> int:
    """Remove an account."""
    _asked(options, lambda accounts: accounts.remove(options.name))
    return exit_codes.OK


def token(options: Namespace) -> int:
    """Make a token, and print it."""
    made = _asked(
        options,
        lambda accounts: accounts.add_token(
            options.name, options.token_name, rights=options.rights, days=options.days
        ),
    )
    print(made)
    return exit_codes.OK


def invite(options: Namespace) -> int:
    """Make an invitation, and print its link."""
    made = _asked(
        options,
        lambda accounts: accounts.invite(
            uses=options.uses, hours=options.hours, label=options.label
        ),
    )
    print(made)
    return exit_codes.OK


def bot(options: Namespace) -> int:
    """Make a token of a bot, and print it."""
    made = _asked(
        options,
        lambda accounts: accounts.add_bot(
            options.name,
            message_rate=options.rate,
            connections=options.connections,
            days=options.days,
        ),
    )
    print(made)
    return exit_codes.OK


def _asked(options: Namespace, work: Callable[[Accounts], Awaitable[Result]]) -> Result:
    async def run() -> Result:
        return await work(Operator(options.url, options.token).accounts)

    try:
        return asyncio.run(run())
    except OperatorError as error:
        raise CommandError(str(error)) from None
