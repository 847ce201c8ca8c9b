"""Actors on their way from zone to zone, as the database has them.

An actor has gone when its row is written, whoever dies then. The row stays until the checkpoints of
both zones know of it: a successor of the zone left takes the actor out that an older checkpoint
still has, and one of the zone reached lets it in once more. Actors, parameters and what else goes
along are text that is not read here.
"""

from collections.abc import Collection
from dataclasses import dataclass

from sqlalchemy import Connection, delete, insert, or_, select, update

from esplanade.server.cluster.ownership import assert_owned
from esplanade.server.cluster.tenure import Claim
from esplanade.server.store.tables import CLUSTER_TRAVELLERS


@dataclass(frozen=True)
class TravellerRow:
    """An actor on its way."""

    actor: str
    origin: str
    zone: str
    """The zone that it goes to."""
    spec: str
    parameters: str
    has_left: bool
    """Whether the newest checkpoint of the zone left is without it."""
    has_come: bool
    """Whether the newest checkpoint of the zone reached has it."""


def send(
    connection: Connection, owner: Claim, zone: str, actor: str, spec: str, parameters: str
) -> bool:
    """Let an actor of the owner's zone go to another one; False while it is on an earlier way.

    Raises
    ------
    NotOwnerError
        The zone left is another host's.
    """
    assert_owned(connection, owner)
    if traveller(connection, actor) is not None:
        return False
    values = {
        "zone": zone,
        "actor": actor,
        "origin": owner.zone,
        "spec": spec,
        "parameters": parameters,
        "has_left": False,
        "has_come": False,
    }
    connection.execute(insert(CLUSTER_TRAVELLERS).values(values))
    return True


def traveller(connection: Connection, actor: str) -> TravellerRow | None:
    """The way that an actor is on; None if it is on none."""
    found = select(CLUSTER_TRAVELLERS).where(CLUSTER_TRAVELLERS.c.actor == actor)
    row = connection.execute(found).one_or_none()
    return None if row is None else TravellerRow(**row._mapping)  # noqa: SLF001 (a public name)


def travellers_of(connection: Connection, zone: str) -> list[TravellerRow]:
    """The actors who are on their way to a zone or from it, by name."""
    table = CLUSTER_TRAVELLERS
    chosen = select(table).where(or_(table.c.zone == zone, table.c.origin == zone))
    rows = connection.execute(chosen.order_by(table.c.actor)).all()
    return [TravellerRow(**row._mapping) for row in rows]  # noqa: SLF001 (a public name)


def settle(connection: Connection, zone: str, left: Collection[str], came: Collection[str]) -> None:
    """Note what a checkpoint of a zone knows, in the transaction that writes it.

    `left` are the actors who had gone from the zone and were out of it when the checkpoint was
    taken. `came` had come by then: they are in it, unless somebody has removed them since. Whoever
    is merely absent from a checkpoint may have come into being after it.
    """
    table = CLUSTER_TRAVELLERS
    for row in travellers_of(connection, zone):
        known = update(table).where(table.c.actor == row.actor)
        if row.zone == zone and row.actor in came:
            connection.execute(known.values(has_come=True))
        elif row.origin == zone and row.actor in left:
            connection.execute(known.values(has_left=True))
    ended = table.c.has_left & table.c.has_come
    connection.execute(
        delete(table).where(ended, or_(table.c.zone == zone, table.c.origin == zone))
    )
