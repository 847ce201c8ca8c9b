"""The seats of a cluster as a gateway takes them, with a bound on how long anybody waits."""

import asyncio
from collections.abc import Callable, Collection, Iterable
from functools import partial
from typing import Any, Final, TypeVar

import structlog

from esplanade.protocol import CloseCode, ErrorCode, ProtocolError
from esplanade.server.cluster import copy_rows, seats
from esplanade.server.cluster.person_record import PersonRecord, encode_record
from esplanade.server.cluster.seats import ClusterSeat
from esplanade.server.copies import Copies
from esplanade.server.store.store import Store, StoreError

ANSWER_S: Final = 5.0
"""A database that has not answered by then is away, for somebody who wants to come in."""
TURN_S: Final = 7.0
"""Nobody waits longer for their turn to ask it: clients wait for 10 s until they are in."""
TOGETHER: Final = 64
"""The most questions that are put to the database at once, as many as share a commit; further
ones wait here for their turn. A herd that comes back holds up nothing else that this gateway has to
write, and nobody of it is refused because too many wait there."""

Result = TypeVar("Result")

log = structlog.get_logger(__name__)


class ClusterSeats:
    """Takes seats for the people of one gateway.

    Raises
    ------
    ProtocolError
        (in `take`, `take_in`, `resume` and `has`) The database does not answer; one may come again.
    """

    def __init__(self, store: Store, gateway: str) -> None:
        self._store = store
        self._gateway = gateway
        self._confirming: dict[int, int] = {}
        self._turns = asyncio.Semaphore(TOGETHER)
        self.failures = 0
        """Questions that the database has not answered in time."""

    async def take(
        self, zone: str, names: Iterable[tuple[str, str]], record: PersonRecord
    ) -> tuple[ClusterSeat, str]:
        """Make a seat for a newcomer; returns it with the token that takes it again."""
        return await self._certain(
            partial(_take, zone, names, self._gateway, encode_record(record))
        )

    async def take_in(
        self,
        copies: Copies,
        wished: str | None,
        names: Iterable[tuple[str, str]],
        record: PersonRecord,
    ) -> tuple[ClusterSeat, str] | None:
        """The same in the copy of a zone that the newcomer enters; None if all are full."""
        state = encode_record(record)
        return await self._certain(partial(_take_in, copies, wished, names, self._gateway, state))

    async def resume(self, token: str, keep_us: int) -> tuple[ClusterSeat, str] | None:
        """Take a seat again; returns it with its next token, or None if it is gone."""
        return await self._certain(partial(_resume, token, self._gateway, keep_us))

    async def has(self, token: str, keep_us: int) -> bool:
        """Whether a token takes a seat."""
        return await self._certain(partial(_has, token, keep_us))

    async def leave(self, person: int, generation: int) -> None:
        """Give up a seat for which there was no room after all."""
        try:
            await self._store.write(partial(_leave, person, generation))
        except StoreError as error:
            log.warning("a seat is not given up, it lapses", person=person, why=str(error))

    async def of(self, persons: Collection[int]) -> dict[int, ClusterSeat]:
        """The seats of those of some persons who have one.

        Raises
        ------
        StoreError
            The database does not answer.
        """
        found = await self._store.read(partial(_seats_of, persons))
        return {seat.person: seat for seat in found}

    def confirm(self, person: int, generation: int) -> None:
        """Note that a client has its newest token; `run` writes that."""
        self._confirming[person] = generation

    async def run(self) -> None:
        """Write what `confirm` was told, until cancelled."""
        while True:
            await asyncio.sleep(0.2)
            confirming = dict(self._confirming)
            if not confirming:
                continue
            try:
                await self._store.write(partial(_confirm, confirming))
            except StoreError as error:
                log.debug("tokens are not confirmed yet", why=str(error))
                await asyncio.sleep(1.0)
                continue
            for person, generation in confirming.items():
                if self._confirming.get(person) == generation:
                    del self._confirming[person]

    async def _certain(self, change: Callable[[Any], Result]) -> Result:
        try:
            async with asyncio.timeout(TURN_S) as patience, self._turns:
                patience.reschedule(asyncio.get_running_loop().time() + ANSWER_S)
                return await self._store.write(change)
        except (StoreError, TimeoutError) as error:
            self.failures += 1
            log.warning("nobody can come in", why=str(error) or "the database is silent")
            raise ProtocolError(
                ErrorCode.BUSY,
                "seats cannot be given just now; come again in a moment",
                CloseCode.BUSY,
            ) from None


def _take(
    zone: str, names: Iterable[tuple[str, str]], gateway: str, state: bytes, connection: Any
) -> tuple[ClusterSeat, str]:
    return seats.take_named(connection, zone, names, gateway, state)


def _take_in(
    copies: Copies,
    wished: str | None,
    names: Iterable[tuple[str, str]],
    gateway: str,
    state: bytes,
    connection: Any,
) -> tuple[ClusterSeat, str] | None:
    zone = copy_rows.entered(connection, copies, wished)
    return None if zone is None else seats.take_named(connection, zone, names, gateway, state)


def _resume(
    token: str, gateway: str, keep_us: int, connection: Any
) -> tuple[ClusterSeat, str] | None:
    return seats.resume(connection, token, gateway, keep_us)


def _has(token: str, keep_us: int, connection: Any) -> bool:
    return seats.has(connection, token, keep_us)


def _leave(person: int, generation: int, connection: Any) -> None:
    seats.leave(connection, [(person, generation)])


def _confirm(confirming: dict[int, int], connection: Any) -> None:
    seats.confirm(connection, list(confirming.items()))


def _seats_of(persons: Collection[int], connection: Any) -> list[ClusterSeat]:
    return seats.seats_of(connection, persons)
