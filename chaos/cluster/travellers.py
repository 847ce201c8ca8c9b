"""Bots that walk east while they are told to, and stand otherwise."""

import asyncio
from typing import Final

from tests.server.client import Client

from chaos.cluster.bots import Bot
from chaos.cluster.ledger import Account
from esplanade.protocol.messages import Welcome

EAST: Final = 0.0
SPEED_MPS: Final = 1.5
WISH_S: Final = 0.1
"""The wish to walk, or to stand, is sent again after so long."""


class Traveller(Bot):
    """A bot that is steered from outside, by `walks`."""

    walks = False

    async def walked(self, metres: float) -> None:
        """Let it walk, and wait until it has come so far east, wherever it is by then."""
        self.walks = True
        welcome: Welcome | None = None
        west = 0.0
        while True:
            await asyncio.sleep(WISH_S / 2)
            client = self.client
            if client is None or client.welcome is None or client.id not in client.positions:
                continue
            x, _ = client.position
            if client.welcome is not welcome:
                welcome, west = client.welcome, x
            # After the death of a host people may be put back to where they were before.
            west = min(west, x)
            if x - west >= metres:
                self.walks = False
                return

    async def _act(self, client: Client, account: Account) -> None:
        while True:
            if client.welcome is not None and account.zone is not None:
                await client.move(EAST, SPEED_MPS if self.walks else 0.0)
            await asyncio.sleep(WISH_S)
