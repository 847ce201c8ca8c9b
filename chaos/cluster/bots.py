"""Bots that live in a cluster: they walk, talk, go through portals, and come back by a token."""

import asyncio
import math
import random
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Final

from tests.server.client import Client, connected
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


class Bot:
    """One bot, until it is told to end."""

    def __init__(
        self, name: str, ports: Callable[[], Sequence[int]], ledger: Ledger, seed: int
    ) -> None:
        self._name = name
        self._ports = ports
        self._ledger = ledger
        self._chance = random.Random(f"{seed} {name}")
        self._lines = 0
        self.rests = False
        """Whether it stands and says nothing, and only looks."""

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
            hello = Hello(name=self._name, version=VERSION, resume=account.token)
            await client.send(hello)
            acting = asyncio.create_task(self._act(client, account))
            try:
                while True:
                    async with asyncio.timeout(SILENCE_S):
                        await self._next(client, account)
            finally:
                acting.cancel()
                with suppress(asyncio.CancelledError, ConnectionClosed):
                    await acting

    async def _next(self, client: Client, account: Account) -> None:
        ledger = self._ledger
        match await client.next():
            case Welcome() as welcome:
                client.entities, client.positions = {}, {}
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
                    self._lines += 1
                    line = f"line {self._lines} of {self._name}"
                    self._ledger.said[account.given_name or ""].add(line)
                    self._ledger.counts["lines said"] += 1
                    await client.send(ChatLine(text=line))
                case chance if chance < 0.35:
                    x, y = PORTALS[account.zone]
                    client.seq += 1
                    await client.send(WalkTo(seq=client.seq, x=x, y=y))
                    await asyncio.sleep(ACROSS_S)
                case _:
                    direction = self._chance.uniform(-math.pi, math.pi)
                    await client.move(direction, self._chance.uniform(0.0, FASTEST_MPS))
