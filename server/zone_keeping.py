"""The store and the audit as one zone of a world uses them."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import replace

from esplanade.server.audit.entries import Entry
from esplanade.server.audit.log import AuditLog
from esplanade.server.kept import Kept
from esplanade.server.store.zone_store import ZoneStore


@asynccontextmanager
async def kept_of(kept: Kept, zone: str) -> AsyncIterator[Kept]:
    """The same with the world, the seats and the commands of one zone; all else is shared.

    A zone with an empty name is the whole world. The row of the audit with which another one begins
    bounds what a later start looks for in its chain.

    Raises
    ------
    StoreError
        The audit cannot be written.
    """
    if not zone:
        yield kept
        return
    audit = AuditLog(kept.store, f"zone {zone}")
    started = await audit.record(Entry(command="zone_start"))
    try:
        yield replace(kept, store=ZoneStore(kept.store, zone), audit=audit, started=started)
    finally:
        await audit.record(Entry(command="zone_stop"))
