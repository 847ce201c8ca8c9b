"""`esplanade op token`: makes, lists and revokes tokens of scripts."""

import json
from argparse import Namespace
from dataclasses import asdict

from rich.table import Table

from esplanade.commandline import exit_codes
from esplanade.commandline.output import console
from esplanade.server.accounts.identity import MACHINE
from esplanade.server.accounts.rights import Right, as_text
from esplanade.server.accounts.tokens import Token, Tokens
from esplanade.server.audit.export import moment
from esplanade.server.audit.log import AuditLog, now_us
from esplanade.server.operating.opening import WRITER, in_store
from esplanade.server.store.sql_store import SqlStore


def add(options: Namespace) -> int:
    """Make a token, and print it."""
    rights = None if options.rights is None else frozenset(map(Right, options.rights))

    async def work(store: SqlStore) -> str:
        return await _tokens(store).add(
            MACHINE,
            options.name,
            options.token,
            rights=rights,
            lasts_us=int(options.expires * 1e6),
        )

    print(in_store(options, work))
    return exit_codes.OK


def list_(options: Namespace) -> int:
    """Show tokens."""
    found = in_store(options, lambda store: _tokens(store).list(options.name))
    if options.json:
        shown = [{**asdict(token), "rights": as_text(token.rights).split()} for token in found]
        print(json.dumps(shown, indent=1))
        return exit_codes.OK
    now = now_us()
    table = Table("account", "token", "state", "rights", "made", "until", "last used")
    for token in found:
        table.add_row(
            token.account,
            token.name,
            _state(token, now),
            as_text(token.rights),
            moment(token.created_us),
            moment(token.expires_us),
            "never" if token.used_us is None else moment(token.used_us),
        )
    console().print(table)
    return exit_codes.OK


def revoke(options: Namespace) -> int:
    """Revoke a token."""
    in_store(options, lambda store: _tokens(store).revoke(MACHINE, options.name, options.token))
    return exit_codes.OK


def _tokens(store: SqlStore) -> Tokens:
    return Tokens(store, AuditLog(store, WRITER))


def _state(token: Token, now: int) -> str:
    if token.revoked_us is not None:
        return "revoked"
    return "usable" if token.is_usable(now) else "out of date"
