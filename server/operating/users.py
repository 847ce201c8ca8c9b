"""`esplanade op user`: adds, lists, changes and removes accounts."""

import getpass
import json
import sys
from argparse import Namespace
from collections.abc import Awaitable, Callable
from dataclasses import asdict
from typing import TypeVar

from rich.table import Table

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import CommandError, UsageError
from esplanade.commandline.output import console
from esplanade.server.accounts.directory import Directory
from esplanade.server.accounts.identity import MACHINE, AccountError
from esplanade.server.accounts.passwords import Passwords, checked_password
from esplanade.server.accounts.tokens import Tokens
from esplanade.server.audit.export import moment
from esplanade.server.audit.log import AuditLog
from esplanade.server.operating.opening import WRITER, in_store
from esplanade.server.store.sql_store import SqlStore

Result = TypeVar("Result")

TOKEN_NAME = "command-line"  # noqa: S105 (it is the name of the token)
"""The name of the token that an account is added with."""


def add(options: Namespace) -> int:
    """Add an account with a password, or with a token, which is printed."""
    password = None if options.token else _asked_password(options)

    async def work(store: SqlStore, directory: Directory) -> str | None:
        if not options.token:
            await directory.add(MACHINE, options.name, options.role, password)
            return None
        tokens, lasts_us = Tokens(store, AuditLog(store, WRITER)), int(options.expires * 1e6)
        return await directory.add_with(
            lambda connection: tokens.add_within(
                connection, MACHINE, options.name, TOKEN_NAME, lasts_us=lasts_us
            ),
            MACHINE,
            options.name,
            options.role,
        )

    token = _in_directory(options, work, making=True)
    if token is not None:
        print(token)
    return exit_codes.OK


def list_(options: Namespace) -> int:
    """Show all accounts."""
    found = _in_directory(options, lambda _, directory: directory.list())
    if options.json:
        print(json.dumps([asdict(account) for account in found], indent=1))
        return exit_codes.OK
    table = Table("account", "role", "password", "tokens", "since", "last seen")
    for account in found:
        table.add_row(
            account.name,
            account.role,
            "yes" if account.has_password else "no",
            str(account.tokens),
            moment(account.created_us),
            "never" if account.seen_us is None else moment(account.seen_us),
        )
    console().print(table)
    return exit_codes.OK


def remove(options: Namespace) -> int:
    """Remove an account."""
    _in_directory(options, lambda _, directory: directory.remove(MACHINE, options.name))
    return exit_codes.OK


def password(options: Namespace) -> int:
    """Give an account another password."""
    new = _asked_password(options)
    _in_directory(options, lambda _, directory: directory.set_password(MACHINE, options.name, new))
    return exit_codes.OK


def role(options: Namespace) -> int:
    """Give an account another role."""
    _in_directory(
        options, lambda _, directory: directory.set_role(MACHINE, options.name, options.role)
    )
    return exit_codes.OK


def _in_directory(
    options: Namespace,
    work: Callable[[SqlStore, Directory], Awaitable[Result]],
    *,
    making: bool = False,
) -> Result:
    async def run(store: SqlStore) -> Result:
        passwords = Passwords()
        try:
            return await work(store, Directory(store, AuditLog(store, WRITER), passwords))
        finally:
            passwords.close()

    return in_store(options, run, making=making)


def _asked_password(options: Namespace) -> str:
    """The password from the input, or asked for twice on the terminal.

    Raises
    ------
    UsageError
        There is no terminal.
    CommandError
        It cannot be had, or the two differ.
    """
    if options.password_stdin:
        given = sys.stdin.readline().rstrip("\r\n")
    elif not sys.stdin.isatty():
        raise UsageError("there is no terminal to ask for a password: give --password-stdin")
    else:
        given = getpass.getpass("password: ")
        if given != getpass.getpass("once more: "):
            raise CommandError("the two passwords differ; nothing was changed")
    try:
        return checked_password(given)
    except AccountError as error:
        raise CommandError(str(error)) from None
