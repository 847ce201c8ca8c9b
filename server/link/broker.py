"""A process's connection to NATS, the broker that carries what may be lost.

Nothing is kept there: JetStream is off, and a frame that did not go out in time is worth nothing.
The library by itself waits two seconds before it comes back, gives up after a minute, and takes
four to notice a broker that is silent.
"""

import asyncio
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import AbstractAsyncContextManager, asynccontextmanager, suppress
from functools import partial
from typing import Any, Final

import structlog
from nats.aio.client import Client
from nats.errors import Error as NatsError

from esplanade.server.link.broker_login import (
    ANYBODY,
    PASSWORD_VARIABLE,
    USER_VARIABLE,
    BrokerLogin,
)

RETRY_S: Final = 0.1
"""The library tries to come back after so long."""
PING_S: Final = 1
PINGS_UNANSWERED: Final = 2
"""A broker is given up when so many pings are unanswered."""
CONNECT_S: Final = 5
CLOSE_S: Final = 1.0
"""A connection that was not made is not waited for any longer when it is given up."""
PENDING_BYTES: Final = 2 * 1024 * 1024
"""The most bytes that wait for a broker that does not read; beyond them nothing is sent."""

Connecting = AbstractAsyncContextManager[Client]
"""A connection to a broker for as long as it is held."""

log = structlog.get_logger(__name__)
_FORBIDDEN: Final = "permissions violation"
_REFUSED: Final = "authorization"
"""Words by which the library's errors of these kinds are known."""


class BrokerError(ConnectionError):
    """The broker cannot be reached; the message says where it was looked for."""


@asynccontextmanager
async def connected(
    servers: Sequence[str], name: str, login: BrokerLogin = ANYBODY
) -> AsyncIterator[Client]:
    """A connection that comes back by itself for as long as it is held.

    Raises
    ------
    BrokerError
        None of the servers answers, or none lets this process in.
    """

    latest = ""

    async def lost() -> None:
        if not ending:
            log.warning("broker lost", servers=list(servers))

    def server() -> str | None:
        return client.connected_url and client.connected_url.netloc

    async def back() -> None:
        log.info("broker back", server=server())

    async def failed(error: Exception) -> None:
        nonlocal latest
        told = str(error) or type(error).__name__
        if _REFUSED not in latest.lower():
            latest = told
        if _FORBIDDEN in told.lower():
            log.warning("the broker forbids this", error=told)
        else:
            log.debug("broker failed", error=told)

    client, ending = Client(), False
    settings: dict[str, Any] = {
        "servers": list(servers),
        "name": name,
        "reconnect_time_wait": RETRY_S,
        "max_reconnect_attempts": -1,
        "ping_interval": PING_S,
        "max_outstanding_pings": PINGS_UNANSWERED,
        "connect_timeout": CONNECT_S,
        "pending_size": PENDING_BYTES,
        "disconnected_cb": lost,
        "reconnected_cb": back,
        "error_cb": failed,
    }
    try:
        settings |= login.settings(tuple(servers))
        await _connect(client, settings)
    except (TimeoutError, OSError, NatsError) as error:
        with suppress(TimeoutError, NatsError, OSError):
            async with asyncio.timeout(CLOSE_S):
                await client.close()
        places = ", ".join(servers)
        why = _why(str(error) or latest or "too late")
        raise BrokerError(f"no NATS server answers at {places}: {why}") from None
    log.info("broker there", server=server())
    try:
        yield client
    finally:
        ending = True
        with suppress(NatsError, OSError):
            await client.close()


async def _connect(client: Client, settings: dict[str, Any]) -> None:
    """Connect, and try no longer than `CONNECT_S`: the library by itself would go on for ever."""
    connecting = asyncio.create_task(client.connect(**settings))
    try:
        await asyncio.wait({connecting}, timeout=CONNECT_S)
        while not connecting.done():
            # The library misses a cancellation that comes just as one of its tries fails.
            connecting.cancel()
            await asyncio.wait({connecting}, timeout=RETRY_S)
    finally:
        connecting.cancel()
    if connecting.cancelled():
        raise TimeoutError
    connecting.result()


def broker_for(
    servers: Sequence[str], name: str, login: BrokerLogin = ANYBODY
) -> Callable[[], Connecting]:
    """Connects under a name, as `connected`, on whichever event loop calls it."""
    return partial(connected, servers, name, login)


def _why(text: str) -> str:
    """The reason for which there is no connection, with what helps."""
    if _REFUSED in text.lower():
        return f"{text}: give --nats-login, or {USER_VARIABLE} and {PASSWORD_VARIABLE}"
    return text
