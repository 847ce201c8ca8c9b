"""Rows of what operators have made and the store keeps: presets, schedules, guards."""

import json
from collections.abc import Mapping
from typing import Any, Final, NamedTuple

from sqlalchemy import Connection, delete, insert, select

from esplanade.protocol.commands import Facts
from esplanade.server.console.state import OperatedState
from esplanade.server.store.store import Store
from esplanade.server.store.tables import OPERATED

PRESETS: Final = "presets"
SCHEDULES: Final = "schedules"
GUARDS: Final = "guards"


class OperatedRow(NamedTuple):
    """A row: the part that it belongs to, its name there, and what is kept; None takes it away."""

    part: str
    name: str
    body: Mapping[str, Any] | None


def rows_of(facts: Facts, state: OperatedState) -> list[OperatedRow]:
    """The rows that are others since facts were taken into the state."""
    rows = []
    for subject in facts:
        kind, _, name = subject.partition(":")
        if kind == "preset":
            rows.append(OperatedRow(PRESETS, name, state.presets.save(name)))
        elif kind == "schedule":
            schedule = state.schedules.get(name)
            rows.append(
                OperatedRow(SCHEDULES, name, None if schedule is None else schedule.plain())
            )
    return rows


def write_rows(connection: Connection, zone: str, rows: list[OperatedRow]) -> None:
    """Write rows within a write of the store, in place of those of the same names."""
    for part, name, body in rows:
        key = {"zone": zone, "part": part, "name": name}
        connection.execute(delete(OPERATED).filter_by(**key))
        if body is not None:
            connection.execute(insert(OPERATED).values(**key, body=json.dumps(body)))


async def read_rows(store: Store) -> list[OperatedRow]:
    """All rows.

    Raises
    ------
    StoreError
        They cannot be read.
    """
    query = (
        select(OPERATED.c.part, OPERATED.c.name, OPERATED.c.body)
        .where(OPERATED.c.zone == store.zone)
        .order_by(OPERATED.c.part, OPERATED.c.name)
    )
    found = await store.read(lambda connection: connection.execute(query).all())
    return [OperatedRow(part, name, json.loads(body)) for part, name, body in found]
