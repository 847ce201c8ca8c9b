"""The chain of one writer: what a row's hash is of, and how a row is added.

A row's hash is SHA-256 of the row before and of all that is kept for ever in this one. What may be
forgotten, the account with its address and what is said of a person, goes into the hash as two
seals: each is SHA-256 of these values and a random salt. Once values and salt are gone, the seal
tells nothing of them, and the chain still holds.
"""

import hashlib
import json
import secrets
from collections.abc import Mapping, Sequence
from typing import Any, Final, NamedTuple

from sqlalchemy import Connection, insert, select, update

from esplanade.server.audit.entries import Entry
from esplanade.server.store.tables import AUDIT, AUDIT_HEADS

FIRST: Final = "0" * 64
"""Stands for the hash of the row before the first."""

SEALED: Final[Mapping[str, tuple[str, ...]]] = {
    "account": ("account", "address"),
    "person": ("person", "note", "detail"),
}
"""The columns that are forgotten together, by what they speak of."""

_HASHED: Final = (
    *("previous", "zone", "writer", "seq", "at_us", "tick", "command", "role", "target"),
    *("outcome", "refers_to", "body", "account_seal", "person_seal"),
)


class Link(NamedTuple):
    """The last row of a chain, to which the next one is linked."""

    seq: int = 0
    at_us: int = 0
    hash: str = FIRST


def append(connection: Connection, zone: str, writer: str, at_us: int, entry: Entry) -> int:
    """Add a row to a writer's chain, within a write of the store; returns its number there.

    Two processes may write one chain, since writes of a zone happen one after the other.
    """
    of_writer = (AUDIT_HEADS.c.zone == zone, AUDIT_HEADS.c.writer == writer)
    columns = (AUDIT_HEADS.c.seq, AUDIT_HEADS.c.at_us, AUDIT_HEADS.c.hash)
    head = connection.execute(select(*columns).where(*of_writer)).first()
    row = linked(Link() if head is None else Link(*head), zone, writer, at_us, entry)
    connection.execute(insert(AUDIT).values(row))
    place = {name: row[name] for name in Link._fields}
    if head is None:
        connection.execute(insert(AUDIT_HEADS).values(zone=zone, writer=writer, **place))
    else:
        connection.execute(update(AUDIT_HEADS).where(*of_writer).values(place))
    return int(row["seq"])


def linked(last: Link, zone: str, writer: str, at_us: int, entry: Entry) -> dict[str, Any]:
    """The row that follows on the last one of a chain, by columns."""
    row: dict[str, Any] = {
        "zone": zone,
        "writer": writer,
        "seq": last.seq + 1,
        "at_us": max(at_us, last.at_us),
        "previous": last.hash,
        "tick": entry.tick,
        "command": entry.command,
        "role": entry.role,
        "target": entry.target,
        "outcome": entry.outcome,
        "refers_to": entry.refers_to,
        "body": as_json(entry.body),
        "account": entry.account,
        "address": entry.address,
        "person": entry.person,
        "note": entry.note,
        "detail": None if entry.detail is None else as_json(entry.detail),
    }
    for about, columns in SEALED.items():
        salt = secrets.token_hex(16)
        row[f"{about}_salt"] = salt
        row[f"{about}_seal"] = seal(salt, [row[column] for column in columns])
    row["hash"] = row_hash(row)
    return row


def row_hash(row: Mapping[str, Any]) -> str:
    """The hash of a row, in hexadecimal."""
    return _digest([row[column] for column in _HASHED])


def seal(salt: str, values: Sequence[str | None]) -> str:
    """The seal of values that may be forgotten, in hexadecimal."""
    return _digest([salt, *values])


def as_json(value: Any) -> str:
    """A value as JSON in one form only."""
    return json.dumps(
        value, ensure_ascii=False, allow_nan=False, separators=(",", ":"), sort_keys=True
    )


def _digest(values: Sequence[Any]) -> str:
    return hashlib.sha256(as_json(values).encode("utf-8", "surrogatepass")).hexdigest()
