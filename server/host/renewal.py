"""Renews the lease of a zone for as long as its host has it."""

import asyncio
from typing import Final

import structlog

from esplanade.server.cluster.ownership import renew
from esplanade.server.cluster.tenure import LEASE_S, RENEWAL_S, Tenure
from esplanade.server.store.store import Store, StoreError

TIMEOUT_S: Final = 2.0
"""A database that has not answered by then is away."""

log = structlog.get_logger(__name__)


class Renewal:
    """Renews a lease once a second, and ends when the zone is another host's.

    While the database is away the zone goes on: nobody else can take it either.
    """

    def __init__(self, store: Store, tenure: Tenure) -> None:
        self.tenure = tenure
        self._store = store
        self._asked_s = asyncio.get_running_loop().time()
        self.failures = 0
        """Renewals that the database has not answered."""

    async def run(self) -> None:
        """Renew until the zone is another host's."""
        while self.tenure.holds:
            await self._renew()
            await asyncio.sleep(RENEWAL_S)

    async def certain(self) -> None:
        """Ask before anything else is done, where this process has stood still for so long that
        another host may have the zone."""
        if asyncio.get_running_loop().time() - self._asked_s > LEASE_S:
            log.warning("this process stood still; asking whose the zone is")
            await self._renew()

    async def _renew(self) -> None:
        self._asked_s = asyncio.get_running_loop().time()
        try:
            async with asyncio.timeout(TIMEOUT_S):
                kept = await self._store.write(lambda to: renew(to, self.tenure.claim))
        except (StoreError, TimeoutError) as error:
            self.failures += 1
            log.warning("the lease is not renewed", why=str(error) or "no answer in time")
            return
        self.tenure.renewed(kept)
        if not self.tenure.holds:
            log.warning("the zone is another host's", zone=self.tenure.claim.zone)
