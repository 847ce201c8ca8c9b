"""Keeps the seats of people in the store: what changed meanwhile shares one write."""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import structlog
from sqlalchemy import Connection

from esplanade.server.checkpoint.rows import KeptSeat, add_seat, change_seat, remove_seat
from esplanade.server.store.store import Store, StoreError

PAUSE_S: Final = 0.5
"""After a write that failed, the next one is tried this much later."""

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True)
class _Change:
    make: Callable[[Connection], Any]
    done: "asyncio.Future[bool] | None"
    """None for a change that nobody waits for: it is tried until it is made."""
    removes: int | None = None
    """The avatar whose seat it takes away."""


class SeatKeeper:
    """Writes changes of seats in their order, one write at a time, on the hub's event loop.

    The number of seats bounds what waits: whoever comes in waits for the one change.
    """

    def __init__(self, store: Store) -> None:
        self._store = store
        self._waiting: list[_Change] = []
        self._given_up: set[int] = set()
        self._writing: asyncio.Task[None] | None = None
        self._stopped = False

    @property
    def waiting(self) -> int:
        """Changes of seats that wait for the store."""
        return len(self._waiting)

    @property
    def zone(self) -> str:
        """The zone that the keys of the seats name."""
        return self._store.zone

    @property
    def given_up(self) -> list[int]:
        """The avatars whose seats are to be taken away, and are not yet."""
        return sorted(self._given_up)

    def add(self, seat: KeptSeat) -> "asyncio.Future[bool]":
        """Write a new seat; done once it is committed, with False if that cannot be."""
        zone = self._store.zone

        def make(connection: Connection) -> bool:
            add_seat(connection, zone, seat)
            return True

        return self._promised(make)

    def change(
        self, avatar: int, address: str, digests: tuple[bytes, ...]
    ) -> "asyncio.Future[bool]":
        """Write other tokens; done once that is committed, with False if the seat is gone."""
        zone = self._store.zone
        return self._promised(
            lambda connection: change_seat(connection, zone, avatar, address, digests)
        )

    def confirm(self, avatar: int, address: str, digests: tuple[bytes, ...]) -> None:
        """Write that older tokens are void, soon."""
        zone = self._store.zone
        self._put(_Change(lambda made: change_seat(made, zone, avatar, address, digests), None))

    def remove(self, avatar: int) -> None:
        """Take a seat away, soon."""
        zone = self._store.zone
        self._given_up.add(avatar)
        self._put(_Change(lambda connection: remove_seat(connection, zone, avatar), None, avatar))

    def bring(self, seat: KeptSeat, before: str) -> None:
        """Write, soon, that a seat is in this zone now, and no more in the one of before."""
        zone = self._store.zone

        def make(connection: Connection) -> None:
            remove_seat(connection, before, seat.avatar)
            add_seat(connection, zone, seat)

        self._put(_Change(make, None))

    async def stop(self) -> None:
        """Write what waits, and nothing of what comes later: seats outlive the server."""
        self._stopped = True
        if self._writing is not None:
            await self._writing

    def _promised(self, make: Callable[[Connection], bool]) -> "asyncio.Future[bool]":
        done: asyncio.Future[bool] = asyncio.get_running_loop().create_future()
        self._put(_Change(make, done))
        return done

    def _put(self, change: _Change) -> None:
        if self._stopped:
            if change.done is not None:
                change.done.set_result(False)
            return
        self._waiting.append(change)
        if self._writing is None or self._writing.done():
            self._writing = asyncio.create_task(self._write())

    async def _write(self) -> None:
        while self._waiting:
            changes, self._waiting = self._waiting, []

            def make(connection: Connection, changes: list[_Change] = changes) -> list[bool]:
                return [bool(change.make(connection)) for change in changes]

            try:
                made = await self._store.write(make)
            except StoreError:
                log.exception("seats cannot be written", changes=len(changes))
                made = [False] * len(changes)
                if not self._stopped:
                    self._waiting = [
                        *(change for change in changes if change.done is None),
                        *self._waiting,
                    ]
                    _answer(changes, made)
                    await asyncio.sleep(PAUSE_S)
                    continue
            self._given_up.difference_update(change.removes or 0 for change in changes)
            _answer(changes, made)


def _answer(changes: list[_Change], made: list[bool]) -> None:
    for change, is_made in zip(changes, made, strict=True):
        if change.done is not None and not change.done.done():
            change.done.set_result(is_made)
