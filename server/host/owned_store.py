"""The store as the owner of a zone writes it: nothing of a host that owns the zone no more."""

from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import replace
from functools import partial

import structlog
from sqlalchemy import Connection

from esplanade.server.audit.entries import Entry
from esplanade.server.audit.log import AuditLog
from esplanade.server.cluster.ownership import assert_owned
from esplanade.server.cluster.tenure import Claim
from esplanade.server.kept import Kept
from esplanade.server.store.location import Location
from esplanade.server.store.store import Result, Store, StoreError
from esplanade.server.store.zone_store import ZoneStore

log = structlog.get_logger(__name__)


class OwnedStore:
    """A `Store` in which each write asks first whether the zone is still its owner's.

    A write of a host that was frozen raises `NotOwnerError`, and leaves no trace.
    """

    def __init__(self, whole: Store, claim: Claim) -> None:
        self._whole = whole
        self._claim = claim

    @property
    def location(self) -> Location:
        """The place where the tables are."""
        return self._whole.location

    @property
    def zone(self) -> str:
        """The zone that keys name."""
        return self._whole.zone

    @property
    def world(self) -> str:
        """The zone that keys name of what all zones share."""
        return self._whole.world

    async def read(self, query: Callable[[Connection], Result]) -> Result:
        """Return the result of a query; see `Store.read`."""
        return await self._whole.read(query)

    async def write(self, change: Callable[[Connection], Result]) -> Result:
        """Return the result of a change once it is committed; see `Store.write`."""
        return await self._whole.write(partial(_owned, self._claim, change))


@asynccontextmanager
async def kept_by_owner(kept: Kept, claim: Claim) -> AsyncIterator[Kept]:
    """The same with the world and the commands of a zone, as its owner writes them.

    The rows of the audit with which the ownership begins and ends are of the chain of the zone,
    which goes on from owner to owner.

    Raises
    ------
    StoreError
        The audit cannot be written, or the zone is another host's already.
    """
    owned = OwnedStore(kept.store, claim)
    audit = AuditLog(owned, f"zone {claim.zone}")
    body = {"host": claim.host, "epoch": claim.epoch}
    started = await audit.record(Entry(command="zone_start", body=body))
    try:
        yield replace(kept, store=ZoneStore(owned, claim.zone), audit=audit, started=started)
    finally:
        try:
            await audit.record(Entry(command="zone_stop", body=body))
        except StoreError as error:
            log.info("the audit does not know of the end", zone=claim.zone, why=str(error))


def _owned(claim: Claim, change: Callable[[Connection], Result], connection: Connection) -> Result:
    assert_owned(connection, claim)
    return change(connection)
