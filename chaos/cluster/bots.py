"""Bots that live in a cluster: they walk, talk, go through portals, and come back by a token."""

import asyncio
import math
import random
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Final

from tests.server.client import PLACING_KEY, Client, connected
from websockets.exceptions import ConnectionClosed

from chaos.cluster.ledger import Account, Ledger
from esplanade.protocol import VERSION
from esplanade.protocol.messages import (
    Chat,
    ChatLine,
    Enter,
    Error,
    Hello,
    Leave,
    Snapshot,
    Travel,
    WalkTo,
    Welcome,
)

SILENCE_S: Final = 8.0
"""A bot that gets no snapshot for so long comes in anew, as a client in a browser does."""
ACT_S: Final = (0.3, 1.2)
"""It does something else after a time between these."""
AWAY_S: Final = (0.1, 0.6)
"""It waits for a time between these before it comes back."""
PORTALS: Final = {"The yard": (17.0, 10.0), "The hall": (1.5, 6.0)}
"""The middle of the portal of each scene."""
ACROSS_S: Final = 9.0
"""It takes about so long to walk to a portal."""
FASTEST_MPS: Final = 2.0

Place = tuple[float, float, float]
"""Metres x, y, z."""


class Bot:
    """One bot, until it is told to end."""

    def __init__(
        self,
        name: str,
        ports: Callable[[], Sequence[int]],
        ledger: Ledger,
        seed: int,
        at: Place | None = None,
    ) -> None:
        """`ports` returns those at which it may come in now; `at` is the place where it wishes to
        come in, as an operator may."""
        self._name = name
        self._at = at
        self._ports = ports
        self._ledger = ledger
        self._chance = random.Random(f"{seed} {name}")
        self._lines = 0
        self.rests = False
        """Whether it stands and says nothing, and only looks."""
        self.client: Client | None = None
        """Its connection; None while it has none."""

    async def say(self) -> str:
        """Say a line that nobody has said; returns it."""
        account = self._ledger.account(self._name)
        self._lines += 1
        line = f"line {self._lines} of {self._name}"
        self._ledger.said[account.given_name or ""].add(line)
        self._ledger.counts["lines said"] += 1
        if self.client is not None:
            await self.client.send(ChatLine(text=line))
        return line

    def lose_connection(self) -> None:
        """End its connection as a network does that breaks."""
        if self.client is not None:
            self.client.connection.transport.abort()

    async def live(self) -> None:
        """Come in, and come back whenever the connection ends, until cancelled."""
        account = self._ledger.account(self._name)
        while True:
            try:
                await self._visit(account)
            except (OSError, ConnectionClosed, TimeoutError):
                self._ledger.counts["connections ended"] += 1
            account.zone = None
            await asyncio.sleep(self._chance.uniform(*AWAY_S))

    async def _visit(self, account: Account) -> None:
        ports = self._ports()
        async with connected(self._chance.choice(ports)) as client:
            key = None if self._at is None else PLACING_KEY
            hello = Hello(
                name=self._name, version=VERSION, resume=account.token, at=self._at, operator=key
            )
            await client.send(hello)
            self.client = client
            acting = asyncio.create_task(self._act(client, account))
            try:
                while True:
                    async with asyncio.timeout(SILENCE_S):
                        await self._next(client, account)
            except asyncio.CancelledError:
                await client.connection.close()  # whoever is told to end leaves for good
                raise
            finally:
                self.client = None
                acting.cancel()
                with suppress(asyncio.CancelledError, ConnectionClosed):
                    await acting

    async def _next(self, client: Client, account: Account) -> None:
        ledger = self._ledger
        match await client.next():
            case Welcome() as welcome:
                ledger.welcomed(account, welcome)
            case Travel():
                ledger.counts["hops"] += 1
            case Enter() as enter:
                ledger.entered(account, enter.entities)
            case Leave() as leave:
                for gone in leave.ids:
                    account.seen.pop(gone, None)
            case Chat() as chat:
                ledger.heard(account, chat.name, chat.text)
            case Snapshot():
                ledger.shown(account)
            case Error() as error:
                ledger.counts[f"error {error.error}"] += 1

    async def _act(self, client: Client, account: Account) -> None:
        while True:
            await asyncio.sleep(self._chance.uniform(*ACT_S))
            if client.welcome is None or account.zone is None:
                continue
            if self.rests:
                await client.move(0.0, 0.0)
                continue
            match self._chance.random():
                case chance if chance < 0.15:
                    await self.say()
                case chance if chance < 0.35:
                    x, y = PORTALS[account.zone]
                    client.seq += 1
                    await client.send(WalkTo(seq=client.seq, x=x, y=y))
                    await asyncio.sleep(ACROSS_S)
                case _:
                    direction = self._chance.uniform(-math.pi, math.pi)
                    await client.move(direction, self._chance.uniform(0.0, FASTEST_MPS))


async def end(tasks: Sequence["asyncio.Task[None]"]) -> None:
    """End the lives of bots.

    Raises
    ------
    Exception
        One has ended by itself, which only a fault of ours makes it do.
    """
    ended = [task for task in tasks if task.done()]
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
    for task in ended:
        task.result()
