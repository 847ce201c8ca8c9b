"""People in a cluster for tests, and what they see of each other."""

import asyncio
import math
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager

from websockets.exceptions import ConnectionClosed

from tests.patience import PATIENCE_S
from tests.server.client import Client, joined

EAST = 0.0
SPEED_MPS = 1.5
RESOLUTION_M = 0.011
"""Places on the wire are whole centimetres."""


async def walk(client: Client, metres: float) -> None:
    """Let somebody walk east until they are so far from where they were."""
    start = client.position
    await client.move(EAST, SPEED_MPS)
    await client.wait_for(lambda: math.dist(client.position, start) >= metres)
    await client.move(EAST, 0.0)
    seq = client.seq
    await client.wait_for(lambda: client.ack >= seq)
    await client.ticks(5)


async def sees(watcher: Client, other: Client) -> None:
    """Wait until somebody is seen where they are."""
    await watcher.wait_for(
        lambda: (
            other.id in watcher.positions
            and math.dist(watcher.positions[other.id], other.position) <= RESOLUTION_M
        )
    )


async def go_on(*clients: Client, ticks: int = 20) -> None:
    """Let everybody read on for so many ticks."""
    await asyncio.gather(*(client.ticks(ticks) for client in clients))


@asynccontextmanager
async def back(port: int, token: str) -> AsyncIterator[Client]:
    """Somebody who comes back by a token; they try again while nobody can come in."""
    async with AsyncExitStack() as stack:
        async with asyncio.timeout(PATIENCE_S):
            client = None
            while client is None:
                try:
                    coming = joined(port, "Back", resume=token)
                    client = await stack.enter_async_context(coming)
                except (OSError, ConnectionClosed):
                    await asyncio.sleep(0.2)
        yield client
