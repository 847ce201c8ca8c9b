"""The seats of a zone as its host reads and writes them, one transaction after the other.

Nothing waits for it: what is to be written is kept until the database has taken it, the newest of
each person, and what it tells comes back by a call. While the database is away the zone goes on.
"""

import asyncio
from collections import defaultdict
from collections.abc import Callable
from functools import partial
from typing import Final

import structlog
from sqlalchemy import Connection

from esplanade.server.cluster import seats
from esplanade.server.cluster.ownership import NotOwnerError
from esplanade.server.cluster.seats import ClusterSeat
from esplanade.server.cluster.tenure import Claim
from esplanade.server.store.store import Store, StoreError

LOOK_S: Final = 1.0
"""All seats of the zone are read after so long: a gateway may have died after it wrote one."""
PAUSE_S: Final = 0.03
"""They are read no more often: those who come in at once are found together."""
RETRY_S: Final = 0.3

Change = tuple[str, int, str]
"""The next step with a seat, the generation that it is of, and a gateway."""

VACATE: Final = "vacate"
REOCCUPY: Final = "reoccupy"
LEAVE: Final = "leave"
EXPEL: Final = "expel"

log = structlog.get_logger(__name__)


class SeatDesk:
    """Writes of the seats of a zone what its host decides, and reads who belongs there."""

    def __init__(self, store: Store, claim: Claim, keep_us: int) -> None:
        self._store = store
        self._claim = claim
        self._keep_us = keep_us
        self._changes: dict[int, Change] = {}
        self._states: dict[int, bytes] = {}
        self._asked = asyncio.Event()
        self.keeps_all = False
        """Whether nobody's seat lapses, since the world stands."""
        self.failures = 0
        """Transactions that the database did not take."""

    @property
    def waiting(self) -> int:
        """Changes that wait for the database, at most one of a seat and one of its record."""
        return len(self._changes) + len(self._states)

    def vacate(self, person: int, generation: int) -> None:
        """Note that nobody steers any more."""
        self._change(person, (VACATE, generation, ""))

    def reoccupy(self, person: int, generation: int, gateway: str) -> None:
        """Note that the client that was thought lost is there after all."""
        self._change(person, (REOCCUPY, generation, gateway))

    def leave(self, person: int, generation: int) -> None:
        """Remove the seat of somebody who goes for good."""
        self._change(person, (LEAVE, generation, ""))

    def expel(self, person: int) -> None:
        """Remove the seat of somebody whom operators send out, whoever has taken it last."""
        self._change(person, (EXPEL, 0, ""))

    def keep(self, person: int, state: bytes) -> None:
        """Write another record of somebody into the seat, if it is in this zone yet."""
        self._states[person] = state
        self._asked.set()

    def look(self) -> None:
        """Read the seats soon: a gateway says that somebody belongs here who is not known."""
        self._asked.set()

    async def run(self, read: Callable[[list[ClusterSeat]], None]) -> None:
        """Write and read until the zone is another host's; `read` gets all seats of the zone.

        Raises
        ------
        NotOwnerError
            The zone is another host's.
        """
        while True:
            self._asked.clear()
            changes, states = dict(self._changes), dict(self._states)
            try:
                found = await self._store.write(partial(self._settle, changes, states))
            except NotOwnerError:
                raise
            except StoreError as error:
                self.failures += 1
                log.warning("the seats cannot be looked after", why=str(error))
                await asyncio.sleep(RETRY_S)
                continue
            for person, change in changes.items():
                if self._changes.get(person) == change:
                    del self._changes[person]
            for person, state in states.items():
                if self._states.get(person) == state:
                    del self._states[person]
            read(found)
            await asyncio.sleep(PAUSE_S)
            try:
                async with asyncio.timeout(LOOK_S):
                    await self._asked.wait()
            except TimeoutError:
                pass

    async def flush(self) -> None:
        """Write what waits once more, before the zone is given up.

        Raises
        ------
        StoreError
            It could not be written.
        """
        changes, states = dict(self._changes), dict(self._states)
        await self._store.write(partial(self._settle, changes, states))
        self._changes.clear()
        self._states.clear()

    def _change(self, person: int, change: Change) -> None:
        before = self._changes.get(person)
        if before is None or before[0] != EXPEL:
            self._changes[person] = change
        self._asked.set()

    def _settle(
        self, changes: dict[int, Change], states: dict[int, bytes], connection: Connection
    ) -> list[ClusterSeat]:
        if not self.keeps_all:
            seats.remove_vacant(connection, self._claim, self._keep_us)
        # A statement for each person of a crowd would hold up the renewal of the lease.
        alike: defaultdict[tuple[str, str], list[seats.Held]] = defaultdict(list)
        for person, (kind, generation, gateway) in changes.items():
            alike[kind, gateway].append((person, generation))
        for (kind, gateway), held in alike.items():
            if kind == VACATE:
                seats.vacate(connection, held)
            elif kind == REOCCUPY:
                seats.reoccupy(connection, held, gateway)
            elif kind == EXPEL:
                for person, _ in held:
                    seats.expel(connection, self._claim, person)
            else:
                seats.leave(connection, held)
        if states:
            seats.keep_states(connection, self._claim, list(states.items()))
        return seats.seats_in(connection, self._claim.zone)
