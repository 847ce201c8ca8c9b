"""Takes out of the audit what it says of a person or an account; the chain still holds."""

from sqlalchemy import Connection, select, update

from esplanade.server.audit.chain import SEALED
from esplanade.server.store.tables import AUDIT

Erased = tuple[str, int, str]
"""A row by its writer and number, and what was erased in it: a key of `SEALED`."""


def erase(connection: Connection, zone: str, name: str) -> list[Erased]:
    """Erase values and salts wherever a row is of this account or about this person.

    It is done within a write of the store, which has to add a row that names what was erased:
    `verify` takes what no row names for a fault.
    """
    erased: list[Erased] = []
    for about, columns in SEALED.items():
        chosen = (AUDIT.c.zone == zone, AUDIT.c[about] == name)
        found = select(AUDIT.c.writer, AUDIT.c.seq).where(*chosen).order_by(AUDIT.c.id)
        erased.extend((row.writer, row.seq, about) for row in connection.execute(found))
        emptied = dict.fromkeys((*columns, f"{about}_salt"))
        connection.execute(update(AUDIT).where(*chosen).values(emptied))
    return erased
