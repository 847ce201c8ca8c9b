"""Forgets a person in every table that says something of people.

Each part of the server that keeps such a table adds a function to `FORGETTERS`. All of them work
within one write of the store, so that a person is forgotten everywhere or nowhere.
"""

from collections.abc import Callable, Mapping
from typing import Final

from sqlalchemy import Connection, delete, func, select, update

from esplanade.server.accounts.identity import Identity
from esplanade.server.audit.erasing import Erased, erase
from esplanade.server.audit.log import AuditLog
from esplanade.server.audit.verifying import FORGET
from esplanade.server.moderation import rows as moderation
from esplanade.server.operating.forgetting_operated import forget_operated
from esplanade.server.store.store import Store
from esplanade.server.store.tables import ACCOUNTS, BOTS, CLUSTER_SEATS, INVITATIONS, SEATS
from esplanade.server.store.zone_store import anywhere_in

Forgetter = Callable[[Connection, str, str], int]
"""Forgets in a world a person of this name, within a write of the store; returns how many rows were
removed or changed. It asks for no seat, connection or world: those end by themselves when they find
their rows gone."""


def _forget_account(connection: Connection, zone: str, person: str) -> int:
    chosen = (ACCOUNTS.c.zone == zone, ACCOUNTS.c.name == person)
    count = connection.execute(select(func.count()).where(*chosen)).scalar() or 0
    connection.execute(delete(ACCOUNTS).where(*chosen))
    return count


def _forget_invitations(connection: Connection, zone: str, person: str) -> int:
    of_person = update(INVITATIONS).where(INVITATIONS.c.zone == zone)
    labels = connection.execute(of_person.where(INVITATIONS.c.label == person).values(label=None))
    made = connection.execute(of_person.where(INVITATIONS.c.account == person).values(account=None))
    return labels.rowcount + made.rowcount


def _forget_bots(connection: Connection, zone: str, person: str) -> int:
    made = update(BOTS).where(BOTS.c.zone == zone, BOTS.c.account == person).values(account=None)
    return connection.execute(made).rowcount


def _forget_seats(connection: Connection, zone: str, person: str) -> int:
    """Take away seats that bear the name; a checkpoint knows people by numbers only."""
    chosen = (anywhere_in(SEATS.c.zone, zone), SEATS.c.name == person)
    count = connection.execute(select(func.count()).where(*chosen)).scalar() or 0
    connection.execute(delete(SEATS).where(*chosen))
    return count


def _forget_cluster_seats(connection: Connection, _: str, person: str) -> int:
    """Take away seats that bear the name, in whichever zone of the cluster they are."""
    chosen = CLUSTER_SEATS.c.name == person
    count = connection.execute(select(func.count()).where(chosen)).scalar() or 0
    connection.execute(delete(CLUSTER_SEATS).where(chosen))
    return count


FORGETTERS: Final[Mapping[str, Forgetter]] = {
    "accounts": _forget_account,
    "invitations": _forget_invitations,
    "bots": _forget_bots,
    "seats": _forget_seats,
    "cluster seats": _forget_cluster_seats,
    **moderation.FORGETTERS,
    "operated": forget_operated,
}
"""Forgetters by the name of what each forgets in; the audit comes last and is not among them."""


async def forget(store: Store, audit: AuditLog, by: Identity, person: str) -> dict[str, int]:
    """Forget a person everywhere; returns how many rows of what were removed or changed.

    The row of the audit that says so names rows, and not the person.

    Raises
    ------
    StoreError
        The store cannot be written; nothing was forgotten.
    """

    def change(connection: Connection) -> dict[str, int]:
        counts = {
            name: forgetter(connection, store.zone, person)
            for name, forgetter in FORGETTERS.items()
        }
        erased: list[Erased] = erase(connection, store.zone, person)
        counts["audit"] = len(erased)
        if any(counts.values()):
            audit.add(connection, by.entry(FORGET, rows=erased, counts=counts))
        return counts

    return await store.write(change)
