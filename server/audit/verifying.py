"""Checks that no row of the audit was changed, added or taken away, but for what was forgotten."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Final, NamedTuple

from sqlalchemy import Connection, select

from esplanade.server.audit.chain import FIRST, SEALED, row_hash, seal
from esplanade.server.store.store import Store
from esplanade.server.store.tables import AUDIT, AUDIT_HEADS

FORGET: Final = "forget"
"""The command whose row says what was forgotten, in `body["rows"]`."""
_AT_ONCE: Final = 2000


@dataclass(frozen=True, slots=True)
class Fault:
    """The first row of a chain that is not as it was written."""

    writer: str
    seq: int
    why: str

    def __str__(self) -> str:
        return f"row {self.seq} of writer {self.writer!r}: {self.why}"


@dataclass(frozen=True, slots=True)
class Chain:
    """The findings in one writer's chain."""

    writer: str
    rows: int
    """The rows that hold."""
    forgotten: int
    """Rows of which the account, or what was said of a person, was forgotten in good order."""
    head: str
    """The hash of the last row that holds: kept elsewhere, it shows later that all before it is
    unchanged."""
    fault: Fault | None


class Gap(NamedTuple):
    """Parts that are missing in a row, each of which a later row must name."""

    seq: int
    about: str


async def verify(store: Store) -> list[Chain]:
    """Check the chains of all writers of a zone, in reads that are short.

    Raises
    ------
    StoreError
        The store cannot be read.
    """
    heads = await store.read(lambda connection: _heads(connection, store.zone))
    gaps: dict[str, list[Gap]] = {}
    told: set[tuple[str, int, str]] = set()
    chains = [await _follow(store, writer, head, gaps, told) for writer, head in heads.items()]
    return [_with_gaps(chain, gaps.get(chain.writer, ()), told) for chain in chains]


def _heads(connection: Connection, zone: str) -> dict[str, Any]:
    """The head of every writer; None for one who has rows and no head."""
    rows = select(AUDIT.c.writer).where(AUDIT.c.zone == zone).distinct()
    found: dict[str, Any] = dict.fromkeys(connection.scalars(rows))
    heads = select(AUDIT_HEADS).where(AUDIT_HEADS.c.zone == zone)
    found.update((head.writer, head) for head in connection.execute(heads))
    return dict(sorted(found.items()))


async def _follow(
    store: Store,
    writer: str,
    head: Any,
    gaps: dict[str, list[Gap]],
    told: set[tuple[str, int, str]],
) -> Chain:
    """Follow a chain up to the head that was read, or to the first fault."""
    seq, previous, last_us = 0, FIRST, 0

    def ended(why: str) -> Chain:
        fault = Fault(writer, seq + 1, why) if why else None
        return Chain(writer, seq, 0, previous, fault)

    if head is None:
        return ended("the chain has rows, and the record of its last one is missing")
    while seq < head.seq:
        rows = await store.read(partial(_rows, zone=store.zone, writer=writer, after=seq))
        if not rows:
            return ended(f"it is missing, and so are all up to row {head.seq}")
        for row in rows:
            why = _fault(row, seq, previous, last_us)
            if why:
                return ended(why)
            seq, previous, last_us = row["seq"], row["hash"], row["at_us"]
            gaps.setdefault(writer, []).extend(
                Gap(seq, about) for about in SEALED if row[f"{about}_salt"] is None
            )
            if row["command"] == FORGET:
                told.update(map(tuple, json.loads(row["body"]).get("rows", ())))
            if seq == head.seq:
                break
    if previous != head.hash:
        seq -= 1
        return ended("it is not the one that the record of the last row names")
    return ended("")


def _rows(connection: Connection, zone: str, writer: str, after: int) -> list[dict[str, Any]]:
    query = (
        select(AUDIT)
        .where(AUDIT.c.zone == zone, AUDIT.c.writer == writer, AUDIT.c.seq > after)
        .order_by(AUDIT.c.seq)
        .limit(_AT_ONCE)
    )
    return [dict(row) for row in connection.execute(query).mappings()]


def _fault(row: dict[str, Any], seq: int, previous: str, last_us: int) -> str:
    """Why a row is not the one that belongs after another; empty if it is."""
    if row["seq"] != seq + 1:
        return "it is missing" if row["seq"] > seq + 1 else "its number is there twice"
    if row["previous"] != previous:
        return "it does not follow on the row before"
    if row["at_us"] < last_us:
        return "it is older than the row before"
    for about, columns in SEALED.items():
        values, salt = [row[column] for column in columns], row[f"{about}_salt"]
        if salt is None and any(value is not None for value in values):
            return f"what it says of the {about} has no seal"
        if salt is not None and seal(salt, values) != row[f"{about}_seal"]:
            return f"what it says of the {about} was changed"
    return "" if row_hash(row) == row["hash"] else "it was changed"


def _with_gaps(chain: Chain, gaps: Sequence[Gap], told: set[tuple[str, int, str]]) -> Chain:
    """The chain with what was forgotten; something that no row tells of is a fault."""
    untold = [gap for gap in gaps if (chain.writer, gap.seq, gap.about) not in told]
    fault = chain.fault
    if untold:
        why = f"what it said of the {untold[0].about} was taken away, and no row tells of it"
        fault = Fault(chain.writer, untold[0].seq, why)
    forgotten = len({gap.seq for gap in gaps})
    return Chain(chain.writer, chain.rows, forgotten, chain.head, fault)
